"""Quadratic B-splines: Steffen, Kirby and Berzins (2008), https://doi.org/10.1002/nme.2360."""

import numpy as np


class QuadraticBSpline:
    """w = 3/4 - r^2 for |r| < 1/2, (3/2 - |r|)^2 / 2 up to 3/2, r = a - k."""

    name = "quadratic"
    support = 3
    extended = False
    modified = False
    inverse_moment = 4.0
    moment_vanishes = False
    bulk_limit = 1.03

    @staticmethod
    def steepness(half) -> float | None:
        return 6.0

    @staticmethod
    def first(xi):
        return np.floor(xi - 0.5).astype(int)

    @staticmethod
    def weights(a, half):
        r = a - np.arange(3)[:, None]
        return np.where(abs(r) < 0.5, 0.75 - r**2, 0.5 * (1.5 - abs(r)) ** 2)

    @staticmethod
    def slopes(a, half):
        r = a - np.arange(3)[:, None]
        return np.where(abs(r) < 0.5, -2 * r, (abs(r) - 1.5) * np.sign(r))
