"""Strain measures of H = F - I that lose no digits when H is small."""

import taichi as ti


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
def log_volume_ratio(strain):
    """ln(1 + strain), to round-off of the result also where strain is small.

    ln((1 + z) / (1 - z)) = 2 (z + z^3/3 + z^5/5 + ...) with z = strain / (2 + strain); below
    |strain| = 0.1 seven terms leave less than 1e-17 of the result."""
    result = 0.0
    if ti.abs(strain) < 0.1:
        z = strain / (2.0 + strain)
        y = z * z
        series = 1.0 + y * (
            1.0 / 3
            + y * (1.0 / 5 + y * (1.0 / 7 + y * (1.0 / 9 + y * (1.0 / 11 + y * (1.0 / 13)))))
        )
        result = 2.0 * z * series
    else:
        result = ti.log(1.0 + strain)
    return result
