"""The energies of the moments that were shown."""

import numpy as np

MOST = 1000
"""Moments that are kept; then every second is forgotten."""

SERIES = ("kinetic", "elastic", "gravitational", "dissipated", "total")


class Energies:
    """`times` [s], and a row of SERIES [J] for each."""

    def __init__(self):
        self.times: list[float] = []
        self.rows: list[list[float]] = []

    def note(self, simulation) -> None:
        """Now; a moment seen before is not noted again."""
        if self.times and self.times[-1] == simulation.time:
            return
        sums = simulation.sums
        parts = [float(sums[f"{name}_energy"].sum()) for name in ("kinetic", "elastic")]
        weight = sums["mass_moment"].sum(axis=0) @ np.asarray(simulation.scene.gravity_vector)
        parts += [-float(weight), float(sums["dissipated_energy"].sum())]
        if len(self.times) == MOST:
            self.times, self.rows = self.times[::2], self.rows[::2]
        self.times.append(simulation.time)
        self.rows.append([*parts, sum(parts)])

    def curves(self) -> dict[str, np.ndarray]:
        """Those that are more than rounding errors."""
        table = np.array(self.rows)
        largest = np.abs(table).max(axis=0)
        return {
            name: table[:, k] for k, name in enumerate(SERIES) if largest[k] > 1e-9 * largest.max()
        }
