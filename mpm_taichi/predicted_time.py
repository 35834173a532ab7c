"""How long a run will take, from its first steps on this computer as it is now."""

import time
from contextlib import suppress
from dataclasses import dataclass
from math import ceil
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from rich.console import Console

from .attempts import Attempts

PATIENCE = 1.5
"""Seconds of timed steps."""

SPREAD = (10, 90)
"""Percentiles of the paces seen."""


@dataclass(frozen=True)
class Prediction:
    """Seconds: of a step with its part of the history, at the median and at both ends of what was
    seen; of an output; of the whole run, compilation aside, in the same three ways."""

    step: tuple[float, float, float]
    output: float
    run: tuple[float, float, float]

    def describe(self) -> str:
        """One line."""
        whole, low, high = self.run
        return (
            f"time: about {duration(whole)} on this computer now, {duration(low)} to "
            f"{duration(high)} by the spread of the steps ({short(self.step[0])} a step, "
            f"{short(self.output)} an output), if steps stay as they are"
        )


class Enough(Exception):  # noqa: N818 - the end of a measurement, no error
    """The patience is used up."""


class Stopwatch:
    """A recorder that notes the seconds per step between its calls, the first step aside, which
    compiles; after `patience` seconds it ends the run."""

    def __init__(self, patience: float):
        self.patience, self.every_steps = patience, 1
        self.paces: list[float] = []
        self.outputs: list[bool] = []
        self.before: tuple[float, int] | None = None

    def record(self, simulation, is_output):
        now, step = time.perf_counter(), simulation.step_count
        if step == 1:
            self.begin = now
        if self.before is not None:
            self.paces.append((now - self.before[0]) / (step - self.before[1]))
            self.outputs.append(is_output)
            quick = self.paces[-1] < 0.01 * self.patience
            self.every_steps = None if quick else 1  # whole blocks, as a run takes them
            if now - self.begin > self.patience:
                raise Enough
        if step >= 1:
            self.before = time.perf_counter(), step


def predict(simulation, patience: float = PATIENCE) -> Prediction | None:
    """Runs the simulation for `patience` seconds with all that its run would record, in a folder
    that is gone afterwards.  The steps to come are taken to be as long and as costly as these.

    None where the run is over with its first step.  MotionError where it fails so soon."""
    with TemporaryDirectory() as folder:
        attempts = Attempts(simulation, Path(folder), Console(quiet=True))
        watch = Stopwatch(patience)
        simulation.lookout.at_particles()  # compiles what a run will need later
        with attempts.recording():
            with suppress(Enough):
                simulation.run([*attempts.recorders, watch])
            if not simulation.is_done:
                simulation.advance(1)  # a moment that nobody has looked at
            began = time.perf_counter()
            for recorder in attempts.recorders:
                recorder.record(simulation, is_output=True)
            output = time.perf_counter() - began
    between = [pace for pace, landed in zip(watch.paces, watch.outputs, strict=True) if not landed]
    paces = between or watch.paces
    if not paces:
        return None
    middle, low, high = map(float, np.percentile(paces, (50, *SPREAD)))
    steps = simulation.end / simulation.first_dt
    outputs = (simulation.outputs.count + 1) * output
    return Prediction(
        step=(middle, low, high),
        output=output,
        run=(steps * middle + outputs, steps * low + outputs, steps * high + outputs),
    )


def duration(seconds: float) -> str:
    """For people, to about two digits: 0.4 s, 25 s, 3.5 min, 2.1 h, 12 days."""
    for unit, length, most in (("s", 1, 100), ("min", 60, 100), ("h", 3600, 48)):
        if seconds < most * length:
            return f"{float(f'{seconds / length:.2g}'):g} {unit}"
    return f"{ceil(seconds / 86400)} days"


def short(seconds: float) -> str:
    """0.13 ms, 2.4 s."""
    return f"{1e3 * seconds:.2g} ms" if seconds < 0.0995 else f"{seconds:.2g} s"
