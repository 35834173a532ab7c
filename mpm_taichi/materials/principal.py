"""Principal axes of symmetric matrices, and strains along them: own decompositions, since Taichi's
take 1e-5 for zero."""

import numpy as np
import taichi as ti

from ..runtime import Template, real_type
from .invariants import exp_less_one, left_strain, log_volume_ratio


@ti.func
def eigen(A):
    """Values l [dim] and vectors, columns of V, of a symmetric matrix: A = V diag(l) V^T, to some
    rounding errors of |A|, also where values are equal, zero or negative.  In no order.

    Jacobi (1846): plane rotations, each of which takes an element off the diagonal to zero.  In 2D
    one does; in 3D the sum of squares off the diagonal falls quadratically, four or five sweeps."""
    V = ti.Matrix.identity(float, A.n)
    if ti.static(A.n == 2):
        A, V = turned(A, V, 0, 1)
    else:
        small = ti.static(float(np.finfo(real_type()).eps) ** 2 / 16)
        sweeps = 0
        while off_diagonal(A) > small * A.norm_sqr() and sweeps < 8:
            A, V = turned(A, V, 0, 1)
            A, V = turned(A, V, 0, 2)
            A, V = turned(A, V, 1, 2)
            sweeps += 1
    return ti.Vector([A[d, d] for d in range(A.n)]), V


@ti.func
def off_diagonal(A):
    return A[0, 1] ** 2 + A[0, 2] ** 2 + A[1, 2] ** 2


@ti.func
def turned(A, V, p: Template, q: Template):
    """Q^T A Q and V Q with the rotation Q in the plane p, q that makes A_pq zero."""
    half = 0.5 * (A[q, q] - A[p, p])
    apart = half + ti.select(half < 0.0, -1.0, 1.0) * ti.sqrt(half * half + A[p, q] * A[p, q])
    t = 0.0
    if apart != 0.0:
        t = A[p, q] / apart
    c = 1.0 / ti.sqrt(1.0 + t * t)
    s = t * c
    A[p, p] -= t * A[p, q]
    A[q, q] += t * A[p, q]
    A[p, q], A[q, p] = 0.0, 0.0
    for k in ti.static(range(A.n)):
        if ti.static(k not in (p, q)):
            along, across = A[k, p], A[k, q]
            A[k, p] = c * along - s * across
            A[k, q] = s * along + c * across
            A[p, k], A[q, k] = A[k, p], A[k, q]
        along, across = V[k, p], V[k, q]
        V[k, p] = c * along - s * across
        V[k, q] = s * along + c * across
    return A, V


@ti.func
def assembled(values, V):
    """V diag(values) V^T, of the first dim values."""
    A = ti.Matrix.zero(float, V.n, V.n)
    for d in ti.static(range(V.n)):
        for e in ti.static(range(d + 1)):
            for k in ti.static(range(V.n)):
                A[d, e] += values[k] * V[d, k] * V[e, k]
            A[e, d] = A[d, e]
    return A


@ti.func
def logarithmic_strains(H, out_of_plane):
    """Principal strains ln s_i [3] of F = I + H, in 2D the last of them ln(1 + out_of_plane), and
    their axes V in space, in the plane in 2D."""
    stretches, V = eigen(left_strain(H))  # s_i^2 - 1
    e = ti.Vector([0.0, 0.0, log_volume_ratio(out_of_plane)])
    for d in ti.static(range(H.n)):
        e[d] = 0.5 * log_volume_ratio(stretches[d])
    return e, V


@ti.func
def strained(H, V, e):
    """H of V diag(exp e_i) V^T (I + H): stretched by e [3] (logarithmic) along the axes V."""
    growth = ti.Vector([exp_less_one(e[d]) for d in range(H.n)])
    G = assembled(growth, V)
    return H + G + G @ H


@ti.func
def compound(a, b):
    """(1 + a) (1 + b) - 1."""
    return a + b + a * b
