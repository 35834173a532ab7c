"""Own eigen-decompositions of symmetric matrices, where Taichi's lose digits."""

import numpy as np
import pytest
import taichi as ti

from mpm_taichi import runtime
from mpm_taichi.materials.symmetric import eigen
from mpm_taichi.runtime import Array, Template

from ..laws import rotations


@ti.kernel
def decompose(dim: Template, A: Array, values: Array, vectors: Array):
    for p in range(A.shape[0]):
        M = ti.Matrix.zero(float, dim, dim)
        for d, e in ti.static(ti.ndrange(dim, dim)):
            M[d, e] = A[p, d, e]
        lam, V = eigen(M)
        for d in ti.static(range(dim)):
            values[p, d] = lam[d]
            for e in ti.static(range(dim)):
                vectors[p, d, e] = V[d, e]


def cases(rng, dim):
    """Random; almost a multiple of I; equal values, two or all; zero; negative; diagonal; of very
    unlike size; tiny."""
    lam = np.concatenate([
        rng.normal(size=(100, dim)),
        1 + 10 ** rng.uniform(-16, -1, (100, 1)) * rng.normal(size=(100, dim)),
        np.where(np.arange(dim) == 0, 2.0, 1.0)[None],
        np.ones((1, dim)), np.zeros((1, dim)), -rng.random((20, dim)),
        10 ** rng.uniform(-12, 3, (100, dim)),
        1e-9 * rng.normal(size=(50, dim)),
    ])  # fmt: skip
    Q = rotations(rng, len(lam), dim)
    A = Q @ (lam[:, :, None] * Q.swapaxes(1, 2))
    diagonal = np.zeros((20, dim, dim))
    diagonal[:, range(dim), range(dim)] = rng.normal(size=(20, dim))
    A = np.concatenate([A, diagonal])
    return 0.5 * (A + A.swapaxes(1, 2))


@pytest.mark.parametrize(("precision", "bound"), [("f64", 1e-14), ("f32", 4e-6)])
@pytest.mark.parametrize("dim", [2, 3])
def test_eigen(rng, dim, precision, bound):
    """A = V diag(l) V^T, V orthogonal, l as by LAPACK, to some 20 rounding errors of |A|; with
    fast-math."""
    runtime.start("cpu", precision)
    A = cases(rng, dim).astype({"f32": np.float32, "f64": np.float64}[precision])
    values, vectors = np.zeros(A.shape[:2], A.dtype), np.zeros_like(A)
    decompose(dim, A, values, vectors)
    A, lam, V = A.astype(float), values.astype(float), vectors.astype(float)
    size = np.abs(A).max(axis=(1, 2))
    again = V @ (lam[:, :, None] * V.swapaxes(1, 2))
    assert np.abs(V @ V.swapaxes(1, 2) - np.eye(dim)).max() < bound
    assert (np.abs(again - A).max(axis=(1, 2)) <= bound * size).all()
    off = np.abs(np.sort(lam, axis=1) - np.linalg.eigvalsh(A)).max(axis=1)
    assert (off <= bound * size).all()
