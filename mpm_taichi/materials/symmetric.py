"""Functions of symmetric matrices: own decompositions, since Taichi's take 1e-5 for zero."""

from math import factorial
from typing import Any

import numpy as np
import taichi as ti

from ..runtime import Template, real_type
from .invariants import log_volume_ratio
from .polar import cofactors


@ti.func
def eigen(A) -> Any:
    """Values l [dim] and vectors, columns of V, of a symmetric matrix: A = V diag(l) V^T, to some
    rounding errors of |A|, also where values are equal, zero or negative.  In no order."""
    if ti.static(A.n == 2):
        t, c = rotation_to_diagonal(A[0, 0], A[0, 1], A[1, 1])
        s = t * c
        values = ti.Vector([A[0, 0] - t * A[0, 1], A[1, 1] + t * A[0, 1]])
        return values, ti.Matrix([[c, s], [-s, c]])
    else:
        u = lone_vector(A)
        v = ti.Vector([0.0, u[2], -u[1]])
        if ti.abs(u[0]) > ti.abs(u[1]):
            v = ti.Vector([-u[2], 0.0, u[0]])
        v /= v.norm()
        w = u.cross(v)
        Av, Aw = A @ v, A @ w
        first, off, last = v.dot(Av), v.dot(Aw), w.dot(Aw)
        t, c = rotation_to_diagonal(first, off, last)
        s = t * c
        values = ti.Vector([u.dot(A @ u), first - t * off, last + t * off])
        return values, ti.Matrix.cols([u, c * v - s * w, s * v + c * w])


@ti.func
def rotation_to_diagonal(first, off, last):
    """tan and cos of the angle that makes [[first, off], [off, last]] diagonal: Jacobi (1846)."""
    half = 0.5 * (last - first)
    apart = half + ti.select(half < 0.0, -1.0, 1.0) * ti.sqrt(half * half + off * off)
    t = 0.0
    if apart != 0.0:
        t = off / apart
    return t, 1.0 / ti.sqrt(1.0 + t * t)


@ti.func
def lone_vector(A) -> Any:
    """The eigenvector whose value is farthest from the other two: Eberly (2014), A robust
    eigensolver for 3 x 3 symmetric matrices.

    B = +- (A - mean) / size, with sum B_ij^2 = 6 and det B = d in [0, 2], has it at the largest
    root b of b^3 - 3 b = d, which lies in [sqrt 3, 2] and has a slope of 6 or more there.  The
    cofactors of B - b I are (3 b^2 - 3) u u^T."""
    B = A
    mean = A.trace() / 3.0
    for d in ti.static(range(3)):
        B[d, d] -= mean
    size = ti.sqrt(B.norm_sqr() / 6.0)
    u = ti.Vector([1.0, 0.0, 0.0])
    if size > 0.0:
        B /= size
        det = B.determinant()
        if det < 0.0:
            B, det = -B, -det
        b = 1.7331 + det * (0.1596 - 0.0133 * det)  # to 1e-3
        for _ in ti.static(range(3)):  # Newton: 1e-6, 1e-12, round-off
            b -= (b * (b * b - 3.0) - det) / (3.0 * b * b - 3.0)
        for d in ti.static(range(3)):
            B[d, d] -= b
        C = cofactors(B)
        best = C[0, 0]
        u = ti.Vector([C[0, 0], C[1, 0], C[2, 0]])
        for k in ti.static((1, 2)):
            if C[k, k] > best:
                best = C[k, k]
                u = ti.Vector([C[0, k], C[1, k], C[2, k]])
        u /= u.norm()
    return u


@ti.func
def assembled(values, V):
    """V diag(values) V^T."""
    A = ti.Matrix.zero(float, V.n, V.n)
    for d in ti.static(range(V.n)):
        for e in ti.static(range(d + 1)):
            for k in ti.static(range(V.n)):
                A[d, e] += values[k] * V[d, k] * V[e, k]
            A[e, d] = A[d, e]
    return A


@ti.func
def logarithm(A) -> Any:
    """ln(I + A), to some rounding errors of |A|; by powers where |A| is small, else by values."""
    result = A
    if A.norm_sqr() < SMALL**2:
        result = powers(A, ti.static(of_logarithm()))
    else:
        values, V = eigen(A)
        for d in ti.static(range(A.n)):
            values[d] = log_volume_ratio(values[d])
        result = assembled(values, V)
    return result


@ti.func
def exponential(A) -> Any:
    """exp(A) - I, to some rounding errors of |A|: by powers where |A| is small, else from the half,
    exp(2 A) - I = E (2 I + E) with E = exp(A) - I."""
    size, halvings = A.norm(), 0
    while size > SMALL and halvings < 10:
        size *= 0.5
        halvings += 1
    E = powers(A / 2.0**halvings, ti.static(of_exponential()))
    for _ in range(halvings):
        E = 2.0 * E + E @ E
    return E


SMALL = 0.1
"""Of |A|: 16 powers are enough in f64, 8 in f32."""


def exponents():
    return range(1, 1 + (8 if real_type() == np.float32 else 16))


def of_logarithm():
    """c_n of ln(I + A) = sum c_n A^n."""
    return [(-1) ** (n + 1) / n for n in exponents()]


def of_exponential():
    """c_n of exp(A) - I = sum c_n A^n."""
    return [1 / factorial(n) for n in exponents()]


def of_square_root():
    """c_n of sqrt(I + A) - I = sum c_n A^n."""
    found = [0.5]
    for n in exponents()[1:]:
        found.append(found[-1] * (1.5 - n) / n)
    return found


@ti.func
def is_above(A, x) -> Any:
    """Whether all values of a symmetric matrix are above x: the corners of A - x I are positive."""
    B = A
    for d in ti.static(range(A.n)):
        B[d, d] -= x
    above = B[0, 0] > 0.0 and B[0, 0] * B[1, 1] > B[0, 1] * B[0, 1]
    if ti.static(A.n == 3):
        above = above and B.determinant() > 0.0
    return above


@ti.func
def powers(A, c: Template) -> Any:
    """sum c_n A^n from n = 1 on, by Horner's rule: since A^3 = i A^2 - j A + k I (Cayley and
    Hamilton) each power takes three products of numbers."""
    i, square = A.trace(), A @ A
    j, k = 0.5 * (i * i - square.trace()), A.determinant()
    x, y, z = 0.0, 0.0, 0.0
    for n in ti.static(range(len(c), -1, -1)):  # A (x I + y A + z A^2) + c_n I
        highest, last = z, ti.static(c[n - 1] if n > 0 else 0.0)
        if ti.static(A.n == 3):
            z = y + i * highest
            y = x - j * highest
            x = k * highest + last
        else:
            highest = y
            y = x + i * highest
            x = last - k * highest
    result = y * A + z * square
    for d in ti.static(range(A.n)):
        result[d, d] += x
    return result
