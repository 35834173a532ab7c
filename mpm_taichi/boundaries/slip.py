"""A frictionless wall that material can neither enter nor leave."""

import taichi as ti


class Slip:
    """v <- v - (v . n) n."""

    name = "slip"
    holds = False
    lets_go = False

    @staticmethod
    @ti.func
    def velocity(v, n):
        return v - v.dot(n) * n
