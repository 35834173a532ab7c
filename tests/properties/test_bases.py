"""Identities that every basis keeps in the interior, on the fast form and on the twin.

Bounds of numerics.md, chapter 6: a stencil of s nodes sums s terms of at most 1, so a few s
rounding errors u = 1.1e-16 (times the position in cells for sums of positions)."""

import numpy as np
import pytest
import taichi as ti

from mpm_taichi.bases import BASES
from mpm_taichi.reference import bases as twin_bases
from mpm_taichi.runtime import Array, Template

U = np.finfo(float).eps


@ti.kernel
def tabulate(basis: Template, xi: Array, first: Array,
             w: Array, dw: Array):  # fmt: skip
    for p in range(xi.shape[0]):
        place = ti.Vector([xi[p, 0], xi[p, 1]])
        base = basis.first(place)
        weights, slopes = basis.weights(place - base), basis.slopes(place - base)
        for d in ti.static(range(2)):
            first[p, d] = base[d]
            for k in ti.static(range(weights.n)):
                w[p, k, d] = weights[k, d]
                dw[p, k, d] = slopes[k, d]


def table(basis, xi):
    n = len(xi)
    first = np.zeros((n, 2), np.int32)
    w, dw = np.zeros((2, n, basis.support, 2))
    tabulate(basis, xi, first, w, dw)
    return first, w, dw


def coordinates(rng):
    """Random places, and the places where pieces of splines meet."""
    special = np.array([[3.0, 3.5], [4.5, 5.0], [np.nextafter(4, 0), np.nextafter(4.5, 0)]])
    return np.concatenate([3 + 5 * rng.random((200, 2)), special])


@pytest.mark.parametrize("basis", BASES)
def test_partition_of_unity_and_linear_reproduction(exact, rng, basis):
    """sum w = 1, sum dw = 0, sum w i = xi, sum dw i = 1, w >= 0 along each axis."""
    xi = coordinates(rng)
    first, w, dw = table(basis, xi)
    nodes = first[:, None, :] + np.arange(basis.support)[None, :, None]
    assert (w >= -U).all()
    assert np.abs(w.sum(axis=1) - 1).max() <= 4 * basis.support * U
    assert np.abs(dw.sum(axis=1)).max() <= 8 * basis.support * U
    assert np.abs((w * nodes).sum(axis=1) - xi).max() <= 8 * basis.support * U * nodes.max()
    assert np.abs((dw * nodes).sum(axis=1) - 1).max() <= 16 * basis.support * U * nodes.max()


@pytest.mark.parametrize("basis", BASES)
def test_slopes_are_derivatives(exact, rng, basis):
    """dw by central differences, h = 1e-6: error h^2 and U / h, so 1e-9; away from the knots."""
    xi = coordinates(rng)[:200]
    h = 1e-6
    away = (np.abs(2 * xi - np.round(2 * xi)) > 4 * h).all(axis=1)
    xi = xi[away]
    (_, _, dw), (_, up, _), (_, down, _) = (table(basis, x) for x in (xi, xi + h, xi - h))
    assert np.abs((up - down) / (2 * h) - dw).max() < 1e-9


@pytest.mark.parametrize("basis", BASES)
def test_moment_is_what_the_basis_says(exact, rng, basis):
    """D = sum w (i - xi)^2 [dx^2]: constant 1 / inverse_moment, or a function of the position."""
    xi = coordinates(rng)
    first, w, _ = table(basis, xi)
    r = first[:, None, :] + np.arange(basis.support)[None, :, None] - xi[:, None, :]
    D = (w * r**2).sum(axis=1)
    if basis.inverse_moment is None:
        assert np.ptp(D) > 0.1
    else:
        assert np.abs(D - 1 / basis.inverse_moment).max() < 1e-13


@pytest.mark.parametrize("basis", BASES)
def test_steepness_bounds_the_gradients(exact, basis):
    """sup of sum dw^2 / w over the positions: reached to 1 % on a fine scan, or growing without
    bound as a weight goes to 0."""
    xi = np.repeat(4 + (np.arange(20000) + 0.5)[:, None] / 20000, 2, axis=1)
    _, w, dw = table(basis, xi)
    largest = (dw**2 / w).sum(axis=1).max()
    if basis.steepness is None:
        assert largest > 1e4
    else:
        assert 0.99 * basis.steepness < largest <= basis.steepness * (1 + 1e-3)


@pytest.mark.parametrize("basis", BASES)
def test_twin_has_the_same_values(exact, rng, basis):
    """The twin has the usual piecewise definition: equal to 1e-14."""
    twin = getattr(twin_bases, basis.__name__)
    xi = coordinates(rng)
    first, w, dw = table(basis, xi)
    for p in range(len(xi)):
        assert (twin.first(xi[p]) == first[p]).all()
        assert np.abs(twin.weights(xi[p] - first[p]) - w[p]).max() < 1e-14
        assert np.abs(twin.slopes(xi[p] - first[p]) - dw[p]).max() < 1e-14
