"""A wall that holds whatever touches it."""

import taichi as ti


class Sticky:
    """v = 0."""

    name = "sticky"

    @staticmethod
    @ti.func
    def velocity(v, n):
        return 0.0 * v
