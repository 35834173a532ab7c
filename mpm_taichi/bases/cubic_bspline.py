"""Cubic B-splines: Steffen, Kirby and Berzins (2008), https://doi.org/10.1002/nme.2360."""

import taichi as ti


class CubicBSpline:
    """w = 2/3 - r^2 + |r|^3 / 2 for |r| < 1, (2 - |r|)^3 / 6 up to 2; C2, with D = dx^2 / 3
    everywhere.  Particles keep a in [1, 2)."""

    name = "cubic"
    support = 4
    extended = False
    modified = False
    inverse_moment = 3.0
    moment_vanishes = False
    bulk_limit = 1.37

    @staticmethod
    def steepness(half) -> float | None:
        return 3.14

    @staticmethod
    @ti.func
    def first(xi):
        return ti.floor(xi, int) - 1

    @staticmethod
    @ti.func
    def weights(a, half):
        """The inner two follow from the outer two, since 1 and x are reproduced.  By their own
        formula weights would add up to 1 + 4e-8 in f32, as 1/6 and 2/3 are rounded up: in 5,000
        steps a disk would turn 5e-4 faster."""
        u, v = a - 1.0, 2.0 - a
        low, high = v / 6.0 * v**2, u / 6.0 * u**2
        return ti.Matrix.rows([low, v - 2.0 * low + high, u - 2.0 * high + low, high])

    @staticmethod
    @ti.func
    def slopes(a, half):
        u, v = a - 1.0, 2.0 - a
        return ti.Matrix.rows([-0.5 * v**2, u * (1.5 * u - 2.0), v * (2.0 - 1.5 * v), 0.5 * u**2])
