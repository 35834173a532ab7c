"""Hat functions: the basis of Sulsky, Chen and Schreyer (1994)."""

import taichi as ti

TOUCH = 2.0**-52
"""The least weight: a particle on a node touches the next one, too, for which it has a slope, so
that this node moves with it.  (In f32 what flies by at 0.017 c is there once in 2000 crossings.)"""


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
        return ti.Matrix.rows([1.0 - a, ti.max(a, TOUCH)])

    @staticmethod
    @ti.func
    def slopes(a, half):
        return ti.Matrix.rows([0.0 * a - 1.0, 0.0 * a + 1.0])
