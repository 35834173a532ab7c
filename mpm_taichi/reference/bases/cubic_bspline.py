"""Cubic B-splines: Steffen, Kirby and Berzins (2008), https://doi.org/10.1002/nme.2360."""

import numpy as np


class CubicBSpline:
    """w = 2/3 - r^2 + |r|^3 / 2 for |r| < 1, (2 - |r|)^3 / 6 up to 2, r = a - k."""

    name = "cubic"
    support = 4
    extended = False
    modified = False
    inverse_moment = 3.0
    moment_vanishes = False
    bulk_limit = 1.37

    @staticmethod
    def steepness(half) -> float | None:
        return 3.14

    @staticmethod
    def first(xi):
        return np.floor(xi).astype(int) - 1

    @staticmethod
    def weights(a, half):
        r = abs(a - np.arange(4)[:, None])
        return np.where(r < 1, 2 / 3 - r**2 + r**3 / 2, (2 - r) ** 3 / 6)

    @staticmethod
    def slopes(a, half):
        r = a - np.arange(4)[:, None]
        inner = -2 * r + 1.5 * r * abs(r)
        return np.where(abs(r) < 1, inner, -0.5 * (2 - abs(r)) ** 2 * np.sign(r))
