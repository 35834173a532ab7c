"""A wall that holds whatever touches it."""

import taichi as ti


class Sticky:
    """v = 0."""

    name = "sticky"
    holds = True
    lets_go = False

    @staticmethod
    @ti.func
    def velocity(v, n):
        return 0.0 * v
