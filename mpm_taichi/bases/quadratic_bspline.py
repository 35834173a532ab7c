"""Quadratic B-splines: Steffen, Kirby and Berzins (2008), https://doi.org/10.1002/nme.2360."""

import taichi as ti


class QuadraticBSpline:
    """w = 3/4 - r^2 for |r| < 1/2, (3/2 - |r|)^2 / 2 up to 3/2; C1, with D = dx^2 / 4 everywhere.
    Particles keep a in [1/2, 3/2)."""

    name = "quadratic"
    support = 3
    extended = False
    modified = False
    inverse_moment = 4.0
    moment_vanishes = False
    bulk_limit = 1.03

    @staticmethod
    def steepness(half) -> float | None:
        return 6.0

    @staticmethod
    @ti.func
    def first(xi):
        return ti.floor(xi - 0.5, int)

    @staticmethod
    @ti.func
    def weights(a, half):
        return ti.Matrix.rows([0.5 * (1.5 - a) ** 2, 0.75 - (a - 1.0) ** 2, 0.5 * (a - 0.5) ** 2])

    @staticmethod
    @ti.func
    def slopes(a, half):
        return ti.Matrix.rows([a - 1.5, 2.0 - 2.0 * a, a - 0.5])
