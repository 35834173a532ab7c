"""A recording, ready for the page: the particles as packed blocks, the rest as plain values."""

import zlib
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..recording import RecordedFrame, Recording
from ..renderers.quantities import QUANTITIES, shown_range
from .packing import Packer

FINEST = 65535
"""Quanta along an axis of the domain."""

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
        self.low, self.high = (
            min(self.low, float(values.min())),
            max(self.high, float(values.max())),
        )

    @property
    def span(self) -> float:
        """Above 0 also where all values are the same."""
        return self.high - self.low or 1.0


class Film:
    """Every `every`-th frame of a recording.

    `checksum` is the CRC-32 of the whole numbers of all frames, the low byte first: of each frame
    the coordinates by axis, the velocity components by axis, the scalars by name; known once
    `blocks` is through."""

    def __init__(self, recording: Recording, every: int = 1):
        self.recording = recording
        self.numbers = range(0, len(recording), every)
        self.dim, self.particles = recording.scene.dimension, len(recording.body)
        self.checksum = 0
        self._measure()

    def _measure(self):
        size = self.recording.scene.domain.size
        self.along = [Range(0.0, length) for length in size]
        self.fastest, self.speed, self.scalars = 0.0, Range(0.0, 0.0), {}
        times, steps = [], []
        for frame in map(self.recording.__getitem__, self.numbers):
            times.append(frame.time)
            steps.append(frame.step)
            for axis, along in enumerate(self.along):
                along.note(frame.position[:, axis])
            self.fastest = max(self.fastest, float(np.abs(frame.velocity).max()))
            self.speed.note(frame.scalars["speed"])
            for name in frame.scalars.keys() - {"speed"}:
                self.scalars.setdefault(name, Range()).note(frame.scalars[name])
        self.times, self.steps = np.array(times), steps
        self.scalars = {name: self.scalars[name] for name in QUANTITIES if name in self.scalars}

    def quantized(self, frame: RecordedFrame) -> list[np.ndarray]:
        """The channels of a frame, each uint16 or uint8 [n]."""
        channels = [
            np.rint((x - along.low) * (FINEST / along.span)).astype(np.uint16)
            for x, along in zip(frame.position.T.astype(float), self.along, strict=True)
        ]
        per_quantum = FASTEST / (self.fastest or 1.0)
        for v in frame.velocity.T.astype(float):
            channels.append((np.rint(v * per_quantum) + FASTEST).astype(np.uint8))
        for name, its in self.scalars.items():
            values = frame.scalars[name].astype(float)
            channels.append(np.rint((values - its.low) * (LEVELS / its.span)).astype(np.uint8))
        return channels

    def blocks(self) -> Iterator[str]:
        """The frames, packed; the first alone, so that it is seen at once."""
        channels = 2 * self.dim + len(self.scalars)
        several = max(1, BLOCK // (channels * self.particles))
        starts = [0, *range(1, len(self.numbers), several)]
        packer, self.checksum = Packer(), 0
        for start, end in zip(starts, [*starts[1:], len(self.numbers)], strict=True):
            frames = [self.quantized(self.recording[k]) for k in self.numbers[start:end]]
            for frame in frames:
                for q in frame:
                    little = q.astype(q.dtype.newbyteorder("<"))
                    self.checksum = zlib.crc32(little.tobytes(), self.checksum)
            yield packer.pack([np.stack(q) for q in zip(*frames, strict=True)])

    def particle_bytes(self) -> bytes:
        """What stays: mass [kg] and radius [m], half the edge of the particle's cube, as float32,
        and body as uint16, [n] each."""
        radius = 0.5 * self.recording.initial_volume.astype(float) ** (1 / self.dim)
        columns = ((self.recording.mass, "<f4"), (radius, "<f4"), (self.recording.body, "<u2"))
        return b"".join(np.asarray(values).astype(kind).tobytes() for values, kind in columns)

    def header(self) -> dict:
        """The rest, JSON-able.  Quantum q of a scalar is low + q step."""
        scene = self.recording.scene
        quantities = [{"name": "body", "label": "body"}, self._quantity("speed", self.speed)]
        for name, its in self.scalars.items():
            packed = {"low": its.low, "step": its.span / LEVELS}
            quantities.append(self._quantity(name, its) | packed)
        images = scene.output.images
        return {
            "title": scene.title or self.recording.folder.name,
            "source": scene.source,
            "dimension": self.dim,
            "particles": self.particles,
            "bodies": self.recording.body_names,
            "domain": {
                "size": scene.domain.size,
                "cells": scene.domain.cells,
                "walls": self._walls(),
            },
            "low": [along.low for along in self.along],
            "step": [along.span / FINEST for along in self.along],
            "velocityStep": (self.fastest or 1.0) / FASTEST,
            "quantities": quantities,
            "colorBy": "speed" if images == "none" else images.color_by,
            "gridOpacity": 0.25 if images == "none" else images.grid,
            "times": [float(f"{time:.9g}") for time in self.times],
            "steps": self.steps,
            "history": self._history(),
        }

    def _quantity(self, name: str, its: Range) -> dict:
        """The legend begins or ends at 0 but for a density, as that of the pictures does."""
        quantity, images = QUANTITIES[name], self.recording.scene.output.images
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


def short(values: np.ndarray) -> list[float]:
    """To six digits."""
    return [float(f"{value:.6g}") for value in values]
