"""A convergence study: the levels, what they say together, and how that is written."""

import csv
import io
from dataclasses import dataclass, field

from .grid_convergence import Trend
from .yardsticks import ErrorsToExact, ResultsAtEnd, Value


@dataclass
class Level:
    """One grid, and what was measured on it; `failure` is the sentence of a run that failed.

    `seconds` are those of the solver alone: no compiling, no output."""

    number: int
    cells: list[int]
    dx: float
    particles: int | None = None
    steps: int | None = None
    seconds: float | None = None
    wall_seconds: float | None = None
    warnings: dict[str, int] = field(default_factory=dict)
    values: dict[str, Value] = field(default_factory=dict)
    failure: str | None = None

    def size(self) -> str:
        """`16 x 1`."""
        return " x ".join(map(str, self.cells))

    def outcome(self) -> str:
        if self.failure is not None:
            return f"failed: {self.failure}"
        return f"done, {self.steps} steps in {self.wall_seconds:.1f} s"


@dataclass
class Study:
    """The levels of a scene, coarse to fine, measured by one yardstick; relative changes below
    `rounding` have no order."""

    yardstick: type[ErrorsToExact] | type[ResultsAtEnd]
    rounding: float
    levels: list[Level] = field(default_factory=list)

    @property
    def by_quantity(self) -> dict[str, list[Value | None]]:
        """Values of each level, None where there is none, of what any level has."""
        names = dict.fromkeys(name for level in self.levels for name in level.values)
        return {name: [level.values.get(name) for level in self.levels] for name in names}

    @property
    def trends(self) -> dict[str, Trend]:
        return {
            name: self.yardstick.trend(values, self.rounding)
            for name, values in self.by_quantity.items()
        }

    def curves(self) -> dict[str, tuple[list[float], list[float]]]:
        """dx [m] and error of each quantity, at the levels that have one."""
        curves = {}
        for name, values in self.by_quantity.items():
            errors = self.yardstick.errors(values)
            known = [(lv.dx, e) for lv, e in zip(self.levels, errors, strict=True) if e is not None]
            curves[name] = ([dx for dx, _ in known], [error for _, error in known])
        return curves

    def table(self) -> str:
        """For people: a line for each level, then one for each quantity."""
        trends = self.trends
        head = ["level", "cells", "dx [m]", "particles", "steps", "seconds"]
        rows = [[*head, *(word for name in trends for word in (name, "order"))]]
        rows += self._rows(trends)
        widths = [max(len(row[k]) for row in rows if k < len(row)) for k in range(len(rows[0]))]
        lines = [
            "  ".join(cell.rjust(width) for cell, width in zip(row, widths, strict=False))
            for row in rows
        ]
        for number, level in enumerate(self.levels, start=1):
            if level.failure is not None:
                lines[number] += f"  {level.outcome()}"
        return "\n".join([self.yardstick.title, *lines, *self.verdicts()])

    def _rows(self, trends):
        for number, level in enumerate(self.levels):
            row = [str(level.number), level.size(), f"{level.dx:.4g}"]
            for count in (level.particles, level.steps):
                row.append("-" if count is None else str(count))
            row.append("-" if level.seconds is None else f"{level.seconds:.1f}")
            if level.failure is None:
                for name, trend in trends.items():
                    value, order = level.values.get(name), trend.orders[number]
                    row.append("-" if value is None else self.yardstick.show(value.value))
                    row.append("-" if order is None else f"{order:.2f}")
            yield row

    def verdicts(self) -> list[str]:
        """A sentence for each quantity."""
        found = []
        for name, trend in self.trends.items():
            parts = [] if trend.orders[-1] is None else [f"order {trend.orders[-1]:.2f}"]
            if trend.uncertainty is not None:
                parts.append(f"{self.yardstick.bound} {100 * trend.uncertainty:.2g} %")
            if trend.fault is not None:
                parts.append(f"{self.yardstick.flag}: {trend.fault}")
            found.append(f"{name}: {', '.join(parts)}")
        return found or ["nothing to compare: all quantities are 0, or every level failed"]

    def csv(self) -> str:
        """A row for each level; values and scales in SI units, errors as parts of 1."""
        text, trends = io.StringIO(), self.trends
        writer = csv.writer(text, lineterminator="\n")
        columns = [name for quantity in trends for name in (quantity, f"{quantity}_order")]
        writer.writerow(
            ["level", "cells", "dx", "particles", "steps", "seconds", *columns, "failure"]
        )
        for number, lv in enumerate(self.levels):
            cells = []
            for name, trend in trends.items():
                value = lv.values.get(name)
                cells += [None if value is None else value.value, trend.orders[number]]
            row = [
                lv.number,
                lv.size(),
                lv.dx,
                lv.particles,
                lv.steps,
                lv.seconds,
                *cells,
                lv.failure,
            ]
            writer.writerow(row)
        return text.getvalue()

    def content(self) -> dict:
        """For JSON."""
        levels = []
        for level in self.levels:
            values = {name: value.value for name, value in level.values.items()}
            levels.append(vars(level) | {"values": values})
        return {
            "measured": self.yardstick.title,
            "levels": levels,
            "trends": {name: trend._asdict() for name, trend in self.trends.items()},
            "flags": [
                f"{name}: {self.yardstick.flag}" for name, t in self.trends.items() if t.fault
            ],
        }
