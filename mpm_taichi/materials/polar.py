"""Rotation of F = R S by closed forms, without a singular value decomposition."""

import numpy as np
import taichi as ti

from ..runtime import real_type


@ti.func
def rotation(H):
    """R - I of F = I + H = R S, where det R = 1 and S is symmetric with tr S greatest: if det F < 0
    one of its eigenvalues is negative, the one of least magnitude.

    To rounding errors of |H| where H is small, else of max(1, s1) / (s2 + s3), in 2D over s1 + s2,
    s1 being the greatest of the eigenvalues and s2 and s3 the least: that is how well H determines
    R.  Where s2 + s3 = 0 many rotations are right, and this is about one of them: to 1e-2 in f32.
    For 1e-6 < |F| < 1e6, or F = 0."""
    if ti.static(H.n == 2):
        return plane_rotation(H)
    else:
        return space_rotation(H)


@ti.func
def plane_rotation(H):
    """R is parallel to F + cof F: cos : sin = F11 + F22 : F21 - F12."""
    c, s = 2.0 + H.trace(), H[1, 0] - H[0, 1]
    n = ti.sqrt(c * c + s * s)
    sin, cos_less_one = 0.0, 0.0
    if n > 0.0:
        sin = s / n
        cos_less_one = c / n - 1.0
        if c > 0.0:
            cos_less_one = -sin * s / (n + c)
    return ti.Matrix([[cos_less_one, -sin], [sin, cos_less_one]])


@ti.func
def space_rotation(H):
    """From the quaternion of R, the eigenvector of the greatest eigenvalue s = tr S of
    [[tr F, a^T], [a, F + F^T - tr F I]], a_i = e_ijk F_kj: Horn (1987), J. Opt. Soc. Am. A 4;
    Higham and Noferini (2016), Numer. Algorithms 73.

    One column of the adjugate is enough unless the angle is near 180 degrees or R is hardly
    determined, where digits are lost: then the best column, and inverse iteration."""
    F = H
    for d in ti.static(range(3)):
        F[d, d] += 1.0
    s = trace_of_stretch(F)
    q = column(F, s)
    if q[0] < 0.2 * s * s * s:
        q = refined(best_column(F, s, q), F, s)
    return rotation_of(q)


@ti.func
def column(F, s):
    """Eigenvector (w, v) from the first column of the adjugate: w = det A, v = adj(A) a with
    A = (s + tr F) I - F - F^T.  It is w = s^3 64 / 27 at F = I, in general cos^2(angle / 2)
    8 (s1 + s2) (s2 + s3) (s3 + s1)."""
    A = -(F + F.transpose())
    for d in ti.static(range(3)):
        A[d, d] += s + F.trace()
    B = cofactors(A)
    a = ti.Vector([F[2, 1] - F[1, 2], F[0, 2] - F[2, 0], F[1, 0] - F[0, 1]])
    v = B @ a
    return ti.Vector([A[0, 0] * B[0, 0] + A[0, 1] * B[0, 1] + A[0, 2] * B[0, 2], v[0], v[1], v[2]])


@ti.func
def rotation_of(q):
    """R - I of a quaternion of any length; 0 for q = 0."""
    w, x, y, z = q[0], q[1], q[2], q[3]
    length = q.norm_sqr()
    f = 0.0
    if length > 0.0:
        f = 2.0 / length
    return ti.Matrix([
        [-f * (y * y + z * z), f * (x * y - w * z), f * (x * z + w * y)],
        [f * (x * y + w * z), -f * (x * x + z * z), f * (y * z - w * x)],
        [f * (x * z - w * y), f * (y * z + w * x), -f * (x * x + y * y)],
    ])  # fmt: skip


@ti.func
def best_column(F, s, first):
    """Of all four columns the one of the greatest component, at least half of the quaternion: the
    others are the first column of F turned by 180 degrees about an axis."""
    best, q = first[0], first
    for k in range(3):
        axis = ti.Vector([0.0, 0.0, 0.0, 0.0])
        for d in ti.static(range(3)):
            if d == k:
                axis[1 + d] = 1.0
        M = F
        for d, e in ti.static(ti.ndrange(3, 3)):
            M[d, e] *= 2.0 * axis[1 + e] - 1.0
        turn = column(M, s)
        if turn[0] > best:
            best = turn[0]
            q = product(turn, axis)
    return q


@ti.func
def refined(q_first, F, s_found):
    """Inverse iteration, in the frame that is known so far, with s a little above the eigenvalue:
    A is positive definite then, and its inverse more than rounding errors, also in a tie."""
    q, s = q_first, 1.003 * s_found
    known, passes = 0.0, 0
    while known < 0.2 * s * s * s and passes < 12:
        turn = column(F + rotation_of(q).transpose() @ F, s)
        length = turn.norm()
        if length > 0.0:
            q = product(q, turn / length)
        known = turn[0]
        passes += 1
    return q


@ti.func
def product(p, q):
    """Quaternion of the rotation q and then p."""
    return ti.Vector([
        p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3],
        p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
        p[0] * q[2] + p[2] * q[0] + p[3] * q[1] - p[1] * q[3],
        p[0] * q[3] + p[3] * q[0] + p[1] * q[2] - p[2] * q[1],
    ])  # fmt: skip


@ti.func
def trace_of_stretch(F):
    """s = s1 + s2 + s3, the greatest root of (s^2 - I)^2 - 4 II - 8 J s, where I = |F|^2,
    II = |cof F|^2, J = det F.  Newton's method from above, from sqrt(3 I); steps that grow are
    rounding errors."""
    C = cofactors(F)
    first, second = F.norm_sqr(), C.norm_sqr()
    J = F[0, 0] * C[0, 0] + F[0, 1] * C[0, 1] + F[0, 2] * C[0, 2]
    s = ti.sqrt(3.0 * first)
    small = ti.static(float(np.finfo(real_type()).eps) ** 0.5)
    last, step = s, 0.5 * s
    while step < last and step > small * s:
        last = step
        e = s * s - first
        step = (e * e - 4.0 * second - 8.0 * J * s) / (4.0 * s * e - 8.0 * J)
        if ti.abs(step) < last:
            s -= step
    return s


@ti.func
def cofactors(A):
    """cof A = d det A / dA."""
    C = ti.Matrix.zero(float, 3, 3)
    for d, e in ti.static(ti.ndrange(3, 3)):
        a, b, i, j = ti.static((d + 1) % 3, (d + 2) % 3, (e + 1) % 3, (e + 2) % 3)
        C[d, e] = A[a, i] * A[b, j] - A[a, j] * A[b, i]
    return C
