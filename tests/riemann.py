"""The exact solution of a shock tube of ideal gas: Toro (2009), Riemann Solvers, chapter 4."""

from typing import NamedTuple

import numpy as np

GAMMA = 1.4


class Side(NamedTuple):
    """Gas at rest on one side of the diaphragm."""

    density: float
    pressure: float

    @property
    def sound(self) -> float:
        return np.sqrt(GAMMA * self.pressure / self.density)


class ShockTube:
    """A rarefaction runs into the left gas, a shock into the right one; between them the gas has
    one pressure p_star and one speed u_star, and at the contact the density jumps."""

    def __init__(self, left: Side, right: Side):
        self.left, self.right = left, right
        low, high = right.pressure, left.pressure
        for _ in range(200):  # both speeds are monotone in p
            self.p_star = 0.5 * (low + high)
            too_high = self._behind_rarefaction(self.p_star) < self._behind_shock(self.p_star)
            low, high = (low, self.p_star) if too_high else (self.p_star, high)
        self.u_star = self._behind_shock(self.p_star)
        q, r = (GAMMA - 1) / (GAMMA + 1), self.p_star / right.pressure
        self.left_star = left.density * (self.p_star / left.pressure) ** (1 / GAMMA)
        self.right_star = right.density * (r + q) / (q * r + 1)
        self.head = -left.sound
        self.tail = self.u_star - np.sqrt(GAMMA * self.p_star / self.left_star)
        self.shock = self.u_star / (1 - right.density / self.right_star)

    def _behind_rarefaction(self, p):
        ratio = (p / self.left.pressure) ** ((GAMMA - 1) / (2 * GAMMA))
        return 2 * self.left.sound / (GAMMA - 1) * (1 - ratio)

    def _behind_shock(self, p):
        a = 2 / ((GAMMA + 1) * self.right.density)
        b = (GAMMA - 1) / (GAMMA + 1) * self.right.pressure
        return (p - self.right.pressure) * np.sqrt(a / (p + b))

    def at(self, s: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Density, speed and pressure along the rays s = x / t."""
        fan = 2 / (GAMMA + 1) * (self.left.sound + s)  # the speed in the rarefaction
        squeeze = np.maximum(1 - (GAMMA - 1) / 2 * fan / self.left.sound, 0)
        regions = [s < self.head, s < self.tail, s < self.u_star, s < self.shock]
        left, right = self.left, self.right

        def by_region(*values):
            return np.select(regions, values[:4], values[4])

        return (
            by_region(left.density, left.density * squeeze ** (2 / (GAMMA - 1)),
                      self.left_star, self.right_star, right.density),
            by_region(0.0, fan, self.u_star, self.u_star, 0.0),
            by_region(left.pressure, left.pressure * squeeze ** (2 * GAMMA / (GAMMA - 1)),
                      self.p_star, self.p_star, right.pressure),
        )  # fmt: skip
