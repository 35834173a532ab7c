"""history.csv: what is conserved, where the energy is, and how each body moves."""

import csv
from pathlib import Path

from .. import diagnostics


class History:
    """A row every `every_steps` steps and at each output, in SI units."""

    def __init__(self, path: Path, simulation, every_steps: int):
        self.every_steps = every_steps
        self.gravity = simulation.scene.gravity_vector
        self.first: dict[str, float] | None = None
        self.last: dict[str, float] | None = None
        self._file = path.open("w", newline="", encoding="utf-8")
        self._writer = csv.writer(self._file, lineterminator="\n")

    def record(self, simulation, is_output):
        if not (is_output or simulation.step_count % self.every_steps == 0):
            return
        row = self._row(simulation)
        if self.first is None:
            self.first = row
            self._writer.writerow(row)
        self.last = row
        self._writer.writerow(row.values())
        if is_output:
            self._file.flush()

    def close(self):
        self._file.close()

    def _row(self, simulation) -> dict[str, float]:
        snapshot, axes = simulation.snapshot, "xyz"[: simulation.scene.dimension]
        turning = ("",) if len(axes) == 2 else ("_x", "_y", "_z")
        momentum = diagnostics.momentum(snapshot)
        angular = diagnostics.angular_momentum(snapshot)
        row = {
            "time": snapshot.time,
            "step": snapshot.step,
            "time_step": simulation.last_dt,
            "mass": snapshot.mass.sum(),
            **{f"momentum_{axis}": p for axis, p in zip(axes, momentum, strict=True)},
            **{f"angular_momentum{axis}": L for axis, L in zip(turning, angular, strict=True)},
            "kinetic_energy": diagnostics.kinetic_energy(snapshot),
            "elastic_energy": diagnostics.elastic_energy(snapshot),
            "gravitational_energy": diagnostics.gravitational_energy(snapshot, self.gravity),
        }
        centers, velocities = diagnostics.body_motion(snapshot, simulation.ranges)
        for body, center, velocity in zip(
            simulation.scene.bodies, centers, velocities, strict=True
        ):
            row |= {f"{body.name}_center_{a}": x for a, x in zip(axes, center, strict=True)}
            row |= {f"{body.name}_velocity_{a}": v for a, v in zip(axes, velocity, strict=True)}
        return {name: value if name == "step" else float(value) for name, value in row.items()}
