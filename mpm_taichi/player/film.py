"""A recording, ready for the page: the particles as packed blocks, the rest as plain values."""

import zlib
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..recording import RecordedFrame, Recording
from ..renderers.quantities import QUANTITIES, shown_range
from .packing import Packer
from .stage_film import HalfChannel, StageFilm, packed

FINEST = 65534
"""Quanta along an axis of the domain."""

GONE = 65535
"""All coordinates of a particle that was deleted."""

LEVELS = 255
"""Quanta from the least to the largest value of a scalar."""

FASTEST = 127
"""Quanta from 0, which is kept, to the largest velocity component."""

BLOCK = 2**21
"""Numbers in a block: some 50 ms of the browser's time."""

CURVE = 1000
"""Rows of the history in the chart, at most."""

ENERGIES = ("kinetic", "elastic", "gravitational", "dissipated")


@dataclass
class Range:
    """The least and the largest of all values seen."""

    low: float = np.inf
    high: float = -np.inf

    def note(self, values: np.ndarray) -> None:
        self.low = float(values.min(initial=self.low))
        self.high = float(values.max(initial=self.high))

    def channel(self, quanta: int, kind: type) -> "Channel":
        """In so many steps from end to end."""
        return Channel(self.low, (self.high - self.low or 1.0) / quanta, kind)


@dataclass(frozen=True)
class Channel:
    """Quantum q stands for low + q step."""

    low: float
    step: float
    kind: type

    def quantized(self, values: np.ndarray) -> np.ndarray:
        return np.rint((values.astype(float) - self.low) / self.step).astype(self.kind)


class Film:
    """Every `every`-th frame of a recording.

    `channels` are the coordinates by axis, the velocity components by axis, the scalars by name,
    and where the run has `stages` theirs.  `checksum` is the CRC-32 of their quanta in this order,
    the low byte first, frame by frame, then of the nodes; it is known once `blocks` and
    `node_blocks` are through."""

    def __init__(self, recording: Recording, every: int = 1):
        self.recording = recording
        self.numbers = range(0, len(recording), every)
        self.dim, self.particles = recording.scene.dimension, len(recording.body)
        self.checksum = 0
        self.stages = StageFilm(recording, self.numbers) if recording.has_stages else None
        self._measure()

    def _measure(self):
        along = [Range(0.0, length) for length in self.recording.scene.domain.size]
        fastest, seen = Range(0.0, 0.0), {}
        times, self.steps = [], []
        for frame in map(self.recording.__getitem__, self.numbers):
            times.append(frame.time)
            self.steps.append(frame.step)
            there = ~deleted(frame)
            for axis, its in enumerate(along):
                its.note(frame.position[there, axis])
            fastest.note(np.abs(frame.velocity[there]))
            for name, values in frame.scalars.items():
                seen.setdefault(name, Range()).note(values[there])
        self.times, self.ranges = np.array(times), seen
        self.scalars = [name for name in QUANTITIES if name in seen and name != "speed"]
        step = (fastest.high or 1.0) / FASTEST
        self.ranged = [
            *(its.channel(FINEST, np.uint16) for its in along),
            *[Channel(-FASTEST * step, step, np.uint8)] * self.dim,
            *(seen[name].channel(LEVELS, np.uint8) for name in self.scalars),
        ]
        halves = self.stages.channels if self.stages else []
        self.channels: list[Channel | HalfChannel] = [*self.ranged, *halves]

    def quantized(self, number: int) -> list[np.ndarray]:
        """[n] of each channel in a frame of the recording."""
        frame = self.recording[number]
        gone = deleted(frame)
        columns = [*frame.position.T, *frame.velocity.T, *map(frame.scalars.get, self.scalars)]
        if self.stages:
            columns += self.stages.columns(frame, number)
        quanta = [
            channel.quantized(np.where(gone, channel.low, values))
            for channel, values in zip(self.channels, columns, strict=True)
        ]
        for coordinate in quanta[: self.dim]:
            coordinate[gone] = GONE
        return quanta

    def blocks(self) -> Iterator[str]:
        """The frames, packed; the first alone, so that it is seen at once."""
        several = max(1, BLOCK // (len(self.channels) * self.particles))
        starts = [0, *range(1, len(self.numbers), several)]
        packer, self.checksum = Packer(), 0
        for start, end in zip(starts, [*starts[1:], len(self.numbers)], strict=True):
            frames = list(map(self.quantized, self.numbers[start:end]))
            for frame in frames:
                for q in frame:
                    little = q.astype(q.dtype.newbyteorder("<"))
                    self.checksum = zlib.crc32(little.tobytes(), self.checksum)
            yield packer.pack([np.stack(q) for q in zip(*frames, strict=True)])

    def node_blocks(self) -> Iterator[str]:
        """The nodes of the stages, after the frames; none where the run has none."""
        for block in self.stages.blocks() if self.stages else ():
            self.checksum = zlib.crc32(block, self.checksum)
            yield packed(block)

    def particle_bytes(self) -> bytes:
        """What stays: mass [kg] and radius [m], half the edge of the particle's cube, as float32,
        and body as uint16, [n] each."""
        radius = 0.5 * self.recording.initial_volume.astype(float) ** (1 / self.dim)
        columns = ((self.recording.mass, "<f4"), (radius, "<f4"), (self.recording.body, "<u2"))
        return b"".join(np.asarray(values).astype(kind).tobytes() for values, kind in columns)

    def header(self) -> dict:
        """The rest, JSON-able."""
        scene, dim = self.recording.scene, self.dim
        quantities = [{"name": "body", "label": "body"}, self._quantity("speed")]
        for name, channel in zip(self.scalars, self.ranged[2 * dim :], strict=True):
            quantities.append(self._quantity(name) | {"low": channel.low, "step": channel.step})
        images = scene.output.images
        return {
            "title": scene.title or self.recording.folder.name,
            "source": scene.source,
            "dimension": dim,
            "particles": self.particles,
            "bodies": self.recording.body_names,
            "domain": {
                "size": scene.domain.size,
                "cells": scene.domain.cells,
                "walls": self._walls(),
            },
            "low": [channel.low for channel in self.ranged[:dim]],
            "step": [channel.step for channel in self.ranged[:dim]],
            "velocityStep": self.ranged[dim].step,
            "quantities": quantities,
            "colorBy": "speed" if images == "none" else images.color_by,
            "gridOpacity": 0.25 if images == "none" else images.grid,
            "times": [float(f"{time:.9g}") for time in self.times],
            "steps": self.steps,
            "history": self._history(),
            "walk": self.stages and self.stages.header(),
        }

    def _quantity(self, name: str) -> dict:
        """The legend begins or ends at 0 but for a density, as that of the pictures does."""
        quantity, images = QUANTITIES[name], self.recording.scene.output.images
        its = self.ranges[name]
        low, high = (
            (its.low, its.high) if name == "density" else (min(its.low, 0), max(its.high, 0))
        )
        if images != "none" and images.color_by == name and images.range is not None:
            low, high = images.range
        return {
            "name": name,
            "label": "von Mises stress" if name == "stress" else name.replace("_", " "),
            "unit": quantity.unit.replace("-", "").replace("^3", "\u00b3"),
            "prefixed": quantity.prefixed,
            "map": "diverging" if quantity.signed else "sequential",
            "shown": shown_range(quantity, low, high),
        }

    def _walls(self) -> list[list[str]]:
        """The rule at the lower and the upper side of each axis; "none" and "periodic" too."""
        domain = self.recording.scene.domain
        walls = [
            ["periodic"] * 2 if axis in domain.periodic else ["none"] * 2
            for axis in range(self.dim)
        ]
        for wall in domain.rules:
            walls[wall.axis][wall.upper] = wall.rule.name
        return walls

    def _history(self) -> dict | None:
        """Energies [J] over time [s], a row of each few, and those at the frames."""
        table = self.recording.history
        columns = {name: table.get(f"{name}_energy", np.zeros(0)) for name in ENERGIES}
        columns = {"time": table.get("time", np.zeros(0)), **columns}
        if any(values.dtype.kind != "f" or len(values) == 0 for values in columns.values()):
            return None
        rows = np.unique(np.linspace(0, len(columns["time"]) - 1, CURVE).round().astype(int))
        at_frames = {
            name: np.interp(self.times, columns["time"], columns[name]) for name in ENERGIES
        }
        return {
            "curves": {name: short(values[rows]) for name, values in columns.items()},
            "frames": {name: short(values) for name, values in at_frames.items()},
        }


def deleted(frame: RecordedFrame) -> np.ndarray:
    """[n], whether the particle had left the domain and was taken out."""
    return np.isnan(frame.position[:, 0])


def short(values: np.ndarray) -> list[float]:
    """To six digits."""
    return [float(f"{value:.6g}") for value in values]
