"""Strain measures of H = F - I that lose no digits when H is small."""

import taichi as ti

from ..runtime import real_type


@ti.func
def left_strain(H):
    """b - I = H + H^T + H H^T."""
    return H + H.transpose() + H @ H.transpose()


@ti.func
def volume_strain(H):
    """J - 1 = tr H + (second invariant) + det H; in 2D the second invariant is det H."""
    strain = H.trace() + H.determinant()
    if ti.static(H.n == 3):
        for d in ti.static(range(3)):
            e = ti.static((d + 1) % 3)
            strain += H[d, d] * H[e, e] - H[d, e] * H[e, d]
    return strain


@ti.func
def squared_stretches(H):
    """A lower and an upper bound of the principal values of b = F F^T, exact in 2D and where they
    are equal: mean -+ sqrt((n - 1) / n) |dev b| (Samuelson 1968), and (J / other values)^2."""
    n = ti.static(H.n)
    A = left_strain(H)
    mean = A.trace() / n
    for d in ti.static(range(n)):
        A[d, d] -= mean
    spread = ti.sqrt(ti.static((n - 1) / n) * A.norm_sqr())
    J, most = 1.0 + volume_strain(H), 1.0 + mean + spread
    least = J * J / most
    if ti.static(n == 3):
        others = 1.5 * (1.0 + mean)  # of two values the product is at most the mean squared
        least = ti.max(1.0 + mean - spread, (J / others) ** 2)
    return least, most


@ti.func
def log_volume_ratio(strain):
    """ln(1 + strain), to round-off of the result also where strain is small; NaN from -1
    down.

    ln((1 + z) / (1 - z)) = 2 (z + z^3/3 + z^5/5 + ...) with z = strain / (2 + strain); below
    |strain| = 0.1 six terms leave less than 4e-17 of the result, and three, all that f32 needs,
    3e-9.  Larger strains are brought there by ln(1 + strain) = 2 ln(1 + s),
    s = sqrt(1 + strain) - 1.  No library logarithm: Vulkan has none in f64, and the call would
    cost a neo-Hookean update 5 ns of 45.  Few terms in a row, since each waits for the one before:
    that saves 2 to 5."""
    s, factor = strain, 2.0
    if strain <= -1.0:
        s = ti.math.nan
    while ti.abs(s) > 0.1 and factor < 2.0**14:  # 13 halvings do for every finite f64
        s = s / (1.0 + ti.sqrt(1.0 + s))
        factor *= 2.0
    z = s / (2.0 + s)
    y = z * z
    leading, rest = factor * z, 1.0 / 3 + y * (1.0 / 5)
    if ti.static(real_type().itemsize == 8):
        rest += (y * y) * (1.0 / 7 + y * (1.0 / 9) + (y * y) * (1.0 / 11))
    return leading + (leading * y) * rest


@ti.func
def exp_less_one(y):
    """exp(y) - 1, to a few rounding errors of the result also where y is small; for |y| < 80.

    Below |y| = 0.1 nine terms of the series; larger ones are brought there by halving,
    exp(2 y) - 1 = e (2 + e) with e = exp(y) - 1.  No library exponential: Vulkan has none in
    f64."""
    halvings = 0
    while ti.abs(y) > 0.1 and halvings < 10:
        y *= 0.5
        halvings += 1
    e = 1.0 / 9
    for k in ti.static(range(8, 0, -1)):
        e = (1.0 + y * e) * (1.0 / k)
    e *= y
    while halvings > 0:
        e *= 2.0 + e
        halvings -= 1
    return e


@ti.func
def isotropic(H, strain):
    """H of F = (1 + strain)^(1/dim) I."""
    stretch = exp_less_one(log_volume_ratio(strain) / H.n)
    return stretch * ti.Matrix.identity(float, H.n)
