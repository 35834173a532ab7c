"""A frictionless wall that material can leave but not enter."""

import taichi as ti


class Separate:
    """v <- v - min(v . n, 0) n."""

    name = "separate"
    holds = False
    lets_go = True

    @staticmethod
    @ti.func
    def velocity(v, n):
        return v - ti.min(v.dot(n), 0.0) * n
