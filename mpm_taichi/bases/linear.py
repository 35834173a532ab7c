"""Hat functions: the basis of Sulsky, Chen and Schreyer (1994)."""

import taichi as ti


class Linear:
    """w = 1 - |r| for |r| < 1, continuous; its gradient jumps at the nodes, so a body under stress
    that crosses cells makes noise.  D = f (1 - f) dx^2, f being the place in the cell, vanishes at
    nodes.  Particles keep a in [0, 1)."""

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
    @ti.func
    def first(xi):
        return ti.floor(xi, int)

    @staticmethod
    @ti.func
    def weights(a, half):
        return ti.Matrix.rows([1.0 - a, a])

    @staticmethod
    @ti.func
    def slopes(a, half):
        return ti.Matrix.rows([0.0 * a - 1.0, 0.0 * a + 1.0])
