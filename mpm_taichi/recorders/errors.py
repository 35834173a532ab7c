"""errors.csv: how far the run is from the exact solution of its scene."""

from pathlib import Path
from typing import Any

from ..exact import Error, ExactSolution
from .table import Table

UNITS = {"displacement": "m", "velocity": "m/s", "stress": "Pa", "energy": "J"}


class Errors:
    """A row every `every_steps` steps and at each output, in SI units: the norms of
    `ExactSolution`, with the largest error of a particle and the norm of the exact field.  Samples
    at outputs alone could all fall on extremes, where an error of the phase does not show.

    Without a path nothing is written, and `summary` is what is left."""

    def __init__(self, path: Path | None, simulation, every_steps: int, state=None):
        self.every_steps, self.exact = every_steps, ExactSolution(simulation)
        before = state or {"size": None, "worst": {}}
        self._worst: dict[str, dict[str, float]] = before["worst"]
        self._table = None if path is None else Table(path, before["size"])

    def record(self, simulation, is_output):
        if not (is_output or simulation.step_count % self.every_steps == 0):
            return
        errors = self.exact.errors()
        if self._table is not None:
            self._table.write({"time": simulation.time} | _columns(errors))
            if is_output:
                self._table.flush()
        for name, new in errors.items():
            self._note(name, new, simulation.time)

    def state(self) -> dict[str, Any]:
        return {"size": self._table and self._table.kept_size(), "worst": self._worst}

    def close(self):
        if self._table is not None:
            self._table.close()

    def summary(self) -> dict[str, dict[str, Any]]:
        """By quantity, over the times recorded: the largest `error` and the time `at` which it was,
        the `largest` of a particle, `scale`, the largest norm of the exact field, `relative`, error
        over scale (None for a field that is 0), and the error `at_end`."""
        return {
            name: found | {"relative": found["error"] / found["scale"] if found["scale"] else None}
            for name, found in self._worst.items()
        }

    def describe(self) -> str:
        """The summary as one line."""
        parts = []
        for name, found in self.summary().items():
            amount = f"{found['error']:.2g} {UNITS[name]} at t = {found['at']:.4g} s"
            relative = found["relative"]
            parts.append(
                f"{name} {amount}, the exact one is 0"
                if relative is None
                else f"{name} {100 * relative:.2g} % ({amount})"
            )
        return f"error against the exact solution: {', '.join(parts)}"

    def _note(self, name, new: Error, time):
        start = {"error": -1.0, "at": time, "scale": 0.0}
        worst = self._worst.setdefault(name, start)
        if new.error > worst["error"]:
            worst |= {"error": new.error, "at": time}
        worst["scale"] = max(worst["scale"], new.scale)
        if new.largest is not None:
            worst["largest"] = max(worst.get("largest", 0.0), new.largest)
        worst["at_end"] = new.error


def _columns(errors: dict[str, Error]) -> dict[str, float]:
    columns = {}
    for name, found in errors.items():
        columns[f"{name}_error"] = found.error
        if found.largest is not None:
            columns[f"{name}_largest_error"] = found.largest
        columns[f"{name}_scale"] = found.scale
    return columns
