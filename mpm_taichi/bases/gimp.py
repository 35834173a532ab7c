"""Generalized interpolation (uGIMP): Bardenhagen and Kober (2004), CMES 5:477."""

import taichi as ti


class GIMP:
    """The hat function averaged over a particle of fixed half width l [cells], 0 < l <= 1/2:

        w = 1 - (r^2 + l^2) / (2 l)      |r| < l
            1 - |r|                      |r| < 1 - l
            (1 + l - |r|)^2 / (4 l)      |r| < 1 + l

    l = 1/2 is the quadratic B-spline.  D varies with the place in the cell, but is at least of the
    order l dx^2.  Particles keep a in [1/2, 3/2)."""

    name = "gimp"
    support = 3
    extended = True
    modified = False
    inverse_moment = None
    moment_vanishes = False
    bulk_limit = 0.76

    @staticmethod
    def steepness(half) -> float | None:
        return 1 / (1 - half) + 2 / half

    @staticmethod
    @ti.func
    def first(xi):
        return ti.floor(xi - 0.5, int)

    @staticmethod
    @ti.func
    def weights(a, half):
        b = 2.0 - a
        w = ti.Matrix.rows([1.0 - a, 0.0 * a, 1.0 - b])
        for d in ti.static(range(a.n)):
            if a[d] > 1.0 - half:
                w[0, d] = ti.max(1.0 + half - a[d], 0.0) ** 2 / (4.0 * half)
            if b[d] > 1.0 - half:
                w[2, d] = ti.max(1.0 + half - b[d], 0.0) ** 2 / (4.0 * half)
            w[1, d] = 1.0 - w[0, d] - w[2, d]
        return w

    @staticmethod
    @ti.func
    def slopes(a, half):
        b = 2.0 - a
        dw = ti.Matrix.rows([0.0 * a - 1.0, 0.0 * a, 0.0 * a + 1.0])
        for d in ti.static(range(a.n)):
            if a[d] > 1.0 - half:
                dw[0, d] = -ti.max(1.0 + half - a[d], 0.0) / (2.0 * half)
            if b[d] > 1.0 - half:
                dw[2, d] = ti.max(1.0 + half - b[d], 0.0) / (2.0 * half)
            dw[1, d] = -dw[0, d] - dw[2, d]
        return dw
