"""checkpoints/: the state of the run, now and then."""

import time
from pathlib import Path
from typing import Any

from .. import checkpoints

INTERVAL = 60.0
"""Seconds of computing between two checkpoints, where the scene does not say."""

LEAST_PART = 50.0
"""Then they take at most a fiftieth of the run."""


class Keeper:
    """Saves the run with the states of its other recorders, which have to stand before this one:
    every `interval` seconds, or never where it is "none" and nobody calls `save`."""

    every_steps = None

    def __init__(self, folder: Path, recorders, identity: dict[str, Any], interval=None):
        self.folder, self.recorders, self.identity = folder, recorders, identity
        self.interval = interval
        self.last, self.cost = time.perf_counter(), 0.0
        self.path: Path | None = None

    def record(self, simulation, is_output):
        if self.interval == "none":
            return
        due = self.interval or max(INTERVAL, LEAST_PART * self.cost)
        if time.perf_counter() - self.last >= due:
            simulation.lookout.at_particles()  # what an attempt goes back to has to be good
            self.save(simulation)

    def save(self, simulation) -> Path:
        began = time.perf_counter()
        meta = {
            "identity": self.identity,
            "simulation": simulation.state(),
            "recorders": {type(one).__name__: one.state() for one in self.recorders},
        }
        self.path = checkpoints.save(
            self.folder, simulation.step_count, meta, simulation.solver.stored
        )
        self.last = time.perf_counter()
        self.cost = self.last - began
        return self.path

    def close(self):
        """Checkpoints are whole as soon as they are there."""
