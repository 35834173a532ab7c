"""What a convergence study measures on each grid, and how it judges the sequence.

A yardstick has

- `least_levels`            how many grids it needs
- `title`, `bound`, `flag`  what its values are, what bounds them, and what those at fault are
- `axis`                    what a picture of it shows
- `recorders`               what has to run along
- `measure()`               -> values by quantity, of a run that is done
- `trend(values, rounding)` -> Trend of one quantity, values coarse to fine
- `errors(values)`          what a picture shows at each level, None where there is nothing
- `show(value)`             a value as text
"""

from itertools import pairwise
from typing import NamedTuple

import numpy as np

from . import diagnostics
from .grid_convergence import ROUNDING, Trend, trend_of_errors, trend_of_results
from .recorders import Errors
from .refinement import strips


class Value(NamedTuple):
    """A value and the size that it is compared with, in the same unit."""

    value: float
    scale: float = 1.0


class ErrorsToExact:
    """Largest error over time, relative to the largest exact field; a field that is 0 has none."""

    least_levels = 2
    title = axis = "relative error, largest over time"
    bound, flag = "error", "does not converge"

    def __init__(self, simulation, level: int):
        every = simulation.scene.output.history.every_steps
        self.recorders = [Errors(None, simulation, every)]

    def measure(self) -> dict[str, Value]:
        return {
            name: Value(found["relative"])
            for name, found in self.recorders[0].summary().items()
            if found["relative"] is not None
        }

    @staticmethod
    def trend(values: list[Value | None], rounding: float) -> Trend:
        return trend_of_errors([value and value.value for value in values], rounding)

    @staticmethod
    def errors(values: list[Value | None]) -> list[float | None]:
        return [value and value.value for value in values]

    @staticmethod
    def show(value: float) -> str:
        return f"{100 * value:.3g} %"


class KineticEnergyAtEnd:
    """A recorder of the last two steps.  Velocities live half a step before the positions: the
    energy at the end is a line through those two times, and so of second order in dt."""

    def __init__(self):
        self.samples: list[tuple[float, float]] = []

    def record(self, simulation, is_output):
        if simulation.end - simulation.time < 1.5 * simulation.dt:
            t = simulation.time - 0.5 * simulation.last_dt
            E = float(diagnostics.kinetic_energy(simulation.snapshot))
            self.samples = [*self.samples[-1:], (t, E)]

    def value(self, time: float) -> float:
        """[J]"""
        (t, E), (t_last, E_last) = self.samples[0], self.samples[-1]
        if t == t_last:
            return E_last
        return E_last + (E_last - E) * (time - t_last) / (t_last - t)


class ResultsAtEnd:
    """Energies [J], and how far the center of each body has moved [m], at the end.

    Energies are those of the width that the scene gives to a periodic strip of one cell, whatever
    the level has made of it.  Centers along periodic axes are left out, and so is what is 0 but for
    rounding: energies beside their sum, motion beside the domain."""

    least_levels = 3
    title, axis = "result at the end", "relative change from the level before"
    bound, flag = "GCI", "not grid-independent"

    def __init__(self, simulation, level: int):
        self.simulation, self.kinetic = simulation, KineticEnergyAtEnd()
        self.recorders = [self.kinetic]
        self.widths = 2.0 ** (level * len(strips(simulation.scene.domain)))
        self.start, _ = diagnostics.body_motion(simulation.snapshot, simulation.ranges)

    def measure(self) -> dict[str, Value]:
        simulation, domain = self.simulation, self.simulation.scene.domain
        kept = ROUNDING[simulation.precision]
        now = simulation.snapshot
        energies = {
            "kinetic_energy": self.widths * self.kinetic.value(simulation.time),
            "elastic_energy": self.widths * float(diagnostics.elastic_energy(now)),
        }
        least = kept * sum(map(abs, energies.values()))
        values = {name: Value(E, abs(E)) for name, E in energies.items() if abs(E) > least}
        motion = diagnostics.body_motion(now, simulation.ranges)[0] - self.start
        for body, moved in zip(simulation.scene.bodies, motion, strict=True):
            for axis in set(range(len(moved))) - set(domain.periodic):
                if abs(moved[axis]) > kept * max(domain.size):
                    name = f"{body.name}_center_{'xyz'[axis]}"
                    values[name] = Value(float(moved[axis]), float(np.linalg.norm(moved)))
        return values

    @staticmethod
    def trend(values: list[Value | None], rounding: float) -> Trend:
        scale = values[-1].scale if values[-1] is not None else 1.0
        return trend_of_results([value and value.value for value in values], scale, rounding)

    @staticmethod
    def errors(values: list[Value | None]) -> list[float | None]:
        changes = (a and b and abs(b.value - a.value) / b.scale for a, b in pairwise(values))
        return [None, *changes]

    @staticmethod
    def show(value: float) -> str:
        return f"{value:.6g}"
