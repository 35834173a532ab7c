"""A frictionless wall that material can leave but not enter."""

import numpy as np


class Separate:
    """v <- v - min(v . n, 0) n."""

    name = "separate"
    holds = False
    lets_go = True

    @staticmethod
    def velocity(v, n):
        return v - min(np.dot(v, n), 0.0) * n
