"""The stages of the step that follows each frame, for the page.

Particles get channels of half-precision numbers, in units of a scale, for they have to be told to
three digits, large and small: velocity [m/s] and its gain in the step [m/s] (x, y each), Cauchy
stress [Pa] (xx, yy, xy) and H = F - I (xx, xy, yx, yy).  Nodes lie in blocks of their own, some
frames each, deflated, in base64.  Of a frame, little-endian: their number N (uint32); places x / dx
[N, 2] (int16); mass [N] (kg) and velocity after each moving stage [stages, N, 2] (m/s) (float32).
"""

import base64
import zlib
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..recorders.stages import moving_stages
from ..recording import RecordedFrame, Recording
from ..stage_formulas import formulas, stage_names

BLOCK = 2**20
"""Bytes of a block before it is packed, or of a frame where that is longer."""

HALF = 2.0**15
"""The largest number of a channel, in units of its scale: the least of full precision is 1e-9 of
it."""

KINDS = {"velocity": 2, "gain": 2, "stress": 3, "gradient": 4}
"""Columns of each."""


@dataclass(frozen=True)
class HalfChannel:
    """Half-precision numbers, as their bits, in units of a scale."""

    scale: float
    kind = np.uint16
    low = 0.0

    def quantized(self, values: np.ndarray) -> np.ndarray:
        return (values / self.scale).astype(np.float16).view(np.uint16)


class StageFilm:
    """Of the frames `numbers` of a recording that has stages."""

    def __init__(self, recording: Recording, numbers: range):
        self.recording, self.numbers = recording, numbers
        largest, self.lengths = dict.fromkeys(KINDS, 0.0), []
        for number in numbers:
            self.lengths.append(recording.stages(number).dt)
            for name, values in self._kinds(recording[number], number).items():
                largest[name] = max(largest[name], float(np.abs(values).max(initial=0)))
        self.scales = {name: (most or 1.0) / HALF for name, most in largest.items()}
        self.channels = [
            HalfChannel(self.scales[name]) for name, count in KINDS.items() for _ in range(count)
        ]

    def columns(self, frame: RecordedFrame, number: int) -> list[np.ndarray]:
        """[n] of each channel."""
        return [column for values in self._kinds(frame, number).values() for column in values.T]

    def _kinds(self, frame, number) -> dict[str, np.ndarray]:
        stages = self.recording.stages(number)
        kinds = {
            "velocity": frame.velocity,
            "gain": stages.velocity_gain,
            "stress": stages.cauchy_stress,
            "gradient": stages.displacement_gradient.reshape(-1, 4),
        }
        return {name: np.nan_to_num(values.astype(float)) for name, values in kinds.items()}

    def blocks(self) -> Iterator[bytes]:
        """Of the nodes, before they are packed."""
        block = b""
        for number in self.numbers:
            block += self._nodes(number)
            if len(block) >= BLOCK or number == self.numbers[-1]:
                yield block
                block = b""

    def _nodes(self, number) -> bytes:
        stages = self.recording.stages(number)
        columns = (
            (len(stages.place), "<u4"), (stages.place, "<i2"),
            (stages.node_mass, "<f4"), (stages.node_velocity, "<f4"),
        )  # fmt: skip
        return b"".join(np.asarray(values).astype(kind).tobytes() for values, kind in columns)

    def header(self) -> dict:
        """How to read all that, and the words of the method."""
        scene = self.recording.scene
        method = scene.method
        by_moment = not method.transfer_class.gradient
        return {
            "lengths": [float(f"{dt:.9g}") for dt in self.lengths],
            "scales": self.scales,
            "moving": moving_stages(scene),
            "stages": [
                {"name": name, "formulas": formulas(scene, name)} for name in stage_names(scene)
            ],
            "basis": method.basis_class.name,
            "inverseMoment": method.basis_class.inverse_moment if by_moment else None,
        }


def packed(block: bytes) -> str:
    return base64.b64encode(zlib.compress(block, 9)).decode("ascii")
