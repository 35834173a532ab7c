"""The rotation of F = R S, against matrices made from a known R and S.

The eigenvalues of S in falling order of magnitude are s1, s2, s3, all positive but the last one,
which is negative where det F is.  R is known as well as H = F - I is: to rounding errors of
max(1, s1) / (s2 + s3), in 2D over s1 + s2."""

import numpy as np
import pytest
import taichi as ti

from mpm_taichi import runtime
from mpm_taichi.materials.polar import rotation
from mpm_taichi.reference.materials import polar as twin
from mpm_taichi.runtime import Array, Template
from tests.properties.test_materials import rotations

PRECISIONS = {"f64": 1e-12, "f32": 1e-5}
"""Absolute, of the entries of R: a hundred rounding errors in f32, thousands in f64."""


@ti.kernel
def rotate(dim: Template, F_minus_one: Array, R_minus_one: Array):
    for p in range(F_minus_one.shape[0]):
        H = ti.Matrix.zero(float, dim, dim)
        for d, e in ti.static(ti.ndrange(dim, dim)):
            H[d, e] = F_minus_one[p, d, e]
        Q = rotation(H)
        for d, e in ti.static(ti.ndrange(dim, dim)):
            R_minus_one[p, d, e] = Q[d, e]


def found(H):
    """R - I of H [n, dim, dim], in the precision of the run; H as that precision has it."""
    H = H.astype(runtime.real_type())
    Q = np.zeros_like(H)
    rotate(H.shape[1], H, Q)
    return Q.astype(float), H.astype(float)


def transposed(A):
    return A.swapaxes(-1, -2)


def symmetric(rng, values):
    """Matrices [n, dim, dim] with these eigenvalues [n, dim] along random axes."""
    Q = rotations(rng, *values.shape)
    return Q @ (values[:, :, None] * transposed(Q))


def turns(rng, angles, dim):
    """Rotations by the angles [n], in 3D about random axes."""
    c, s = np.cos(angles), np.sin(angles)
    plane = np.stack([np.stack([c, -s], -1), np.stack([s, c], -1)], -2)
    if dim == 2:
        return plane
    R = np.tile(np.eye(3), (len(angles), 1, 1))
    R[:, :2, :2] = plane
    Q = rotations(rng, len(angles), 3)
    return Q @ R @ transposed(Q)


def spread(values):
    """max(1, s1) / (s2 + s3), in 2D over s1 + s2, of signed eigenvalues."""
    ordered = np.take_along_axis(values, np.argsort(-np.abs(values), axis=1), axis=1)
    return np.maximum(1.0, ordered[:, 0]) / (ordered[:, -2] + ordered[:, -1])


def draw(rng, kind, n, dim):
    """Eigenvalues of S [n, dim], the last one that of least magnitude."""
    s = np.sort(rng.uniform(0.1, 5, (n, dim)))[:, ::-1].copy()
    if kind == "repeated":
        s[:, -1] = s[:, -2]
    elif kind == "all equal":
        s[:] = s[:, :1]
    elif kind == "one zero":
        s[:, -1] = 0
    elif kind == "one tiny":
        s[:, -1] *= 10 ** rng.uniform(-12, -3, n)
    elif kind == "two small":
        s[:, -2:] = s[:, -2:] * 10 ** rng.uniform(-2, -1, (n, 1))
    elif kind == "one negative":
        s[:, -1] = -s[:, -2] * rng.uniform(0.0, 0.9, n)
    elif kind == "extremes":
        s[:] = rng.permuted(np.tile([5.0, 0.1, 0.1 + rng.random()][:dim], (n, 1)), axis=1)
    return s


KINDS = ["different", "repeated", "all equal", "one zero", "one tiny", "two small", "one negative",
         "extremes"]  # fmt: skip


@pytest.mark.parametrize("precision", PRECISIONS)
@pytest.mark.parametrize("dim", [2, 3])
def test_rotation_is_the_one_that_was_put_in(rng, dim, precision):
    """Random rotations, and those by 0, 90, 120, 179.9 and 180 degrees and next to these, times
    stretches of every kind: R to 1e-5 in f32 and 1e-12 in f64, times the spread over 3
    where that is more than 3.  R is a rotation to the same bound in any case."""
    runtime.start("cpu", precision, fast_math=False)
    bound, n = PRECISIONS[precision], 400
    special = np.deg2rad([0, 90, 120, 179.9, 180])[rng.integers(0, 5, n)]
    angles = np.where(rng.random(n) < 0.3, rng.uniform(-np.pi, np.pi, n), special)
    angles = np.where(rng.random(n) < 0.3, angles + 10 ** rng.uniform(-12, -1, n), angles)
    for kind in KINDS:
        s, R = draw(rng, kind, n, dim), turns(rng, angles, dim)
        Q, _H = found(R @ symmetric(rng, s) - np.eye(dim))
        error = np.abs(np.eye(dim) + Q - R).max(axis=(1, 2))
        allowed = bound * np.maximum(1.0, spread(s) / 3)
        found_R = np.eye(dim) + Q
        drift = np.abs(found_R @ transposed(found_R) - np.eye(dim)).max()
        print(f"{kind}: {(error / allowed).max():.2g} of the bound, orthogonal to {drift:.1e}")
        assert (error < allowed).all(), kind
        assert drift < bound, kind
        assert (np.linalg.det(found_R) > 0).all(), kind


@pytest.mark.parametrize("precision", PRECISIONS)
@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("fast_math", [True, False])
def test_small_strains_and_turns_keep_their_digits(rng, dim, precision, fast_math):
    """|H| from 1e-10 to 1e-3: R - I to a few rounding errors of |H|, so that F - R = H - (R - I)
    loses nothing.  The truth by construction: R - I = 2 (2 - W)^-1 W of a small skew W (Cayley),
    S = I + E, H = (R - I) + E + (R - I) E, none of which cancels."""
    runtime.start("cpu", precision, fast_math=fast_math)
    rounding = 8 * np.finfo(runtime.real_type()).eps
    n = 400
    size = 10 ** rng.uniform(-10, -3, n)[:, None, None]
    A, B = rng.uniform(-1, 1, (2, n, dim, dim))
    W, E = 0.5 * size * (A - transposed(A)), 0.5 * size * (B + transposed(B))
    R_less_one = 2 * np.linalg.solve(2 * np.eye(dim) - W, W)
    Q, _H = found(R_less_one + E + R_less_one @ E)
    assert (np.abs(Q - R_less_one) < rounding * size).all()


@pytest.mark.parametrize("precision", PRECISIONS)
def test_no_rotation_where_there_is_none(precision):
    """R - I = 0 exactly for F = I, 2 I and 0; in 2D also for mirrors, of which I is one of many
    right rotations."""
    runtime.start("cpu", precision)
    for dim in (2, 3):
        Q, _H = found(np.stack([f * np.eye(dim) for f in (0.0, 1.0, -1.0)]))
        assert not Q.any()
    assert not found(np.array([[[0.0, 0.0], [0.0, -2.0]], [[-1.0, 1.0], [1.0, -1.0]]]))[0].any()


@pytest.mark.parametrize("precision", PRECISIONS)
@pytest.mark.parametrize("dim", [2, 3])
def test_a_tie_gives_one_of_the_right_rotations(rng, dim, precision):
    """s2 + s3 = 0, or nearly: a mirror has many rotations.  S = R^T F is symmetric with trace s1 to
    1e-2 of s1: what is found is a rotation that is right, or nearly so, and never NaN."""
    runtime.start("cpu", precision, fast_math=False)
    n = 300
    s = np.sort(rng.uniform(0.1, 5, (n, dim)))[:, ::-1].copy()
    s[: n // 3] = s[: n // 3, :1]
    s[:, -1] = -s[:, -2] * (1 - rng.choice([0, 1e-7, 1e-5, 1e-3], n))
    Q, H = found(rotations(rng, n, dim) @ symmetric(rng, s) - np.eye(dim))
    R = np.eye(dim) + Q
    S = transposed(R) @ (np.eye(dim) + H)
    skew = np.abs(S - transposed(S)).max(axis=(1, 2)) / s[:, 0]
    trace = np.abs(np.trace(S, axis1=1, axis2=2) - s.sum(axis=1)) / s[:, 0]
    print(f"skew {skew.max():.1e}, trace off by {trace.max():.1e}")
    assert np.abs(R @ transposed(R) - np.eye(dim)).max() < PRECISIONS[precision]
    assert skew.max() < 1e-2 and trace.max() < 1e-2


@pytest.mark.parametrize("dim", [2, 3])
def test_twin_gives_the_same(exact, rng, dim):
    """NumPy's singular value decomposition, another way altogether, to 1e-12."""
    H = rng.uniform(-0.8, 0.8, (300, dim, dim))
    s = np.linalg.svd(H + np.eye(dim), compute_uv=False)
    s[:, -1] *= np.sign(np.linalg.det(H + np.eye(dim)))
    known = spread(s) < 100
    Q = found(H)[0]
    truth = np.stack([twin.rotation(h) for h in H])
    assert known.sum() > 250
    assert np.abs(Q - truth)[known].max() < 1e-12
