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
        u, v = a - 1.0, 2.0 - a
        first, last = (1.0 / 6) * v**3, (1.0 / 6) * u**3
        # The inner two are what is left of 1: with a rounded third in each, all four are 1 - 0.7 u
        # in the mean of f64, which brakes what moves; a rest in one of them would turn it.
        mean, off = 0.5 * (1.0 - (first + last)), 0.5 * (a - 1.5) * (1.0 + u * v)
        return ti.Matrix.rows([first, mean - off, mean + off, last])

    @staticmethod
    @ti.func
    def slopes(a, half):
        u, v = a - 1.0, 2.0 - a
        return ti.Matrix.rows([-0.5 * v**2, u * (1.5 * u - 2.0), v * (2.0 - 1.5 * v), 0.5 * u**2])
