"""Hat functions: the basis of Sulsky, Chen and Schreyer (1994)."""

import numpy as np

TOUCH = 2.0**-52
"""The least weight: a particle on a node touches the next one, too."""


class Linear:
    """w = 1 - |r| for |r| < 1."""

    name = "linear"
    support = 2
    extended = False
    modified = False
    inverse_moment = None
    moment_vanishes = True
    bulk_limit = 0.76

    @staticmethod
    def steepness(half) -> float | None:
        return None

    @staticmethod
    def first(xi):
        return np.floor(xi).astype(int)

    @staticmethod
    def weights(a, half):
        return np.array([1 - a, np.maximum(a, TOUCH)])

    @staticmethod
    def slopes(a, half):
        return np.array([-np.ones_like(a), np.ones_like(a)])
