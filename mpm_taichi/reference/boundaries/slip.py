"""A frictionless wall that material can neither enter nor leave."""

import numpy as np


class Slip:
    """v <- v - (v . n) n."""

    name = "slip"
    holds = False
    lets_go = False

    @staticmethod
    def velocity(v, n):
        return v - np.dot(v, n) * n
