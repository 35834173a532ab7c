"""Generalized interpolation (uGIMP): Bardenhagen and Kober (2004), CMES 5:477."""

import numpy as np


class GIMP:
    """w = 1 - (r^2 + l^2) / (2 l) for |r| < l, 1 - |r| up to 1 - l, (1 + l - |r|)^2 / (4 l) up to
    1 + l, r = a - k."""

    name = "gimp"
    support = 3
    extended = True
    modified = False
    inverse_moment = None
    moment_vanishes = False
    bulk_limit = 0.76

    @staticmethod
    def steepness(half) -> float | None:
        return 1 / (1 - half) + 2 / half

    @staticmethod
    def first(xi):
        return np.floor(xi - 0.5).astype(int)

    @staticmethod
    def weights(a, half):
        r = abs(a - np.arange(3)[:, None])
        pieces = [1 - (r**2 + half**2) / (2 * half), 1 - r, (1 + half - r) ** 2 / (4 * half)]
        return np.select([r < half, r <= 1 - half, r < 1 + half], pieces, 0.0)

    @staticmethod
    def slopes(a, half):
        r = a - np.arange(3)[:, None]
        pieces = [r / half, np.sign(r), np.sign(r) * (1 + half - abs(r)) / (2 * half)]
        return -np.select([abs(r) < half, abs(r) <= 1 - half, abs(r) < 1 + half], pieces, 0.0)
