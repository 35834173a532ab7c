"""history.csv: what is conserved, where the energy is, and how each body moves."""

from pathlib import Path
from typing import Any

import numpy as np

from .table import Table


class History:
    """A row every `every_steps` steps and at each output, in SI units."""

    def __init__(self, path: Path, simulation, every_steps: int, state=None):
        self.every_steps = every_steps
        self.gravity = simulation.scene.gravity_vector
        before = state or {"size": None, "first": None, "last": None}
        self.first: dict[str, float] | None = before["first"]
        self.last: dict[str, float] | None = before["last"]
        self._table = Table(path, before["size"])

    def record(self, simulation, is_output):
        if not (is_output or simulation.step_count % self.every_steps == 0):
            return
        self.last = self._row(simulation)
        self.first = self.first or self.last
        self._table.write(self.last)
        if is_output:
            self._table.flush()

    def state(self) -> dict[str, Any]:
        return {"size": self._table.kept_size(), "first": self.first, "last": self.last}

    def close(self):
        self._table.close()

    def _row(self, simulation) -> dict[str, float]:
        sums, axes = simulation.sums, "xyz"[: simulation.scene.dimension]
        turning = ("",) if len(axes) == 2 else ("_x", "_y", "_z")
        mass = simulation.body_mass
        momentum, angular = sums["momentum"].sum(axis=0), sums["angular_momentum"].sum(axis=0)
        row = {
            "time": simulation.time,
            "step": simulation.step_count,
            "time_step": simulation.last_dt,
            "mass": mass.sum(),
            **{f"momentum_{axis}": p for axis, p in zip(axes, momentum, strict=True)},
            **{f"angular_momentum{axis}": L for axis, L in zip(turning, angular, strict=True)},
            "kinetic_energy": sums["kinetic_energy"].sum(),
            "elastic_energy": sums["elastic_energy"].sum(),
            "dissipated_energy": sums["dissipated_energy"].sum(),
            # - sum m g . x, zero at the origin
            "gravitational_energy": -(sums["mass_moment"].sum(axis=0) @ self.gravity),
        }
        row |= simulation.ledger
        with np.errstate(invalid="ignore", divide="ignore"):  # a body may be deleted: NaN
            centers = sums["mass_moment"] / mass[:, None]
            velocities = sums["momentum"] / mass[:, None]
        for body, center, velocity in zip(
            simulation.scene.bodies, centers, velocities, strict=True
        ):
            row |= {f"{body.name}_center_{a}": x for a, x in zip(axes, center, strict=True)}
            row |= {f"{body.name}_velocity_{a}": v for a, v in zip(axes, velocity, strict=True)}
        return {name: value if name == "step" else float(value) for name, value in row.items()}
