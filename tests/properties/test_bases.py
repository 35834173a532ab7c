"""Identities that every basis keeps in the interior, on the fast form and on the twin.

Bounds of numerics.md, chapter 6: a stencil of s nodes sums s terms of at most 1, so a few s
rounding errors u = 1.1e-16 (times the position in cells for sums of positions)."""

from types import SimpleNamespace

import numpy as np
import pytest
import taichi as ti

from mpm_taichi.bases import BASES
from mpm_taichi.reference import bases as twin_bases
from mpm_taichi.reference.kernels.stencil import weigh
from mpm_taichi.runtime import Array, Template

U = np.finfo(float).eps


@ti.kernel
def tabulate(basis: Template, xi: Array, first: Array, w: Array, dw: Array, half: float):
    for p in range(xi.shape[0]):
        place = ti.Vector([xi[p, 0], xi[p, 1]])
        base = basis.first(place)
        weights, slopes = basis.weights(place - base, half), basis.slopes(place - base, half)
        for d in ti.static(range(2)):
            first[p, d] = base[d]
            for k in ti.static(range(weights.n)):
                w[p, k, d] = weights[k, d]
                dw[p, k, d] = slopes[k, d]


def table(basis, xi, half=0.2):
    """First nodes, weights and slopes at xi [n, 2] of particles of a half width [cells]."""
    n = len(xi)
    first = np.zeros((n, 2), np.int32)
    w, dw = np.zeros((2, n, basis.support, 2))
    tabulate(basis, xi, first, w, dw, half)
    return first, w, dw


def coordinates(rng):
    """Random places, and the places where pieces of splines meet."""
    special = np.array(
        [[3.0, 3.5], [4.5, 5.0], [np.nextafter(4, 0), np.nextafter(4.5, 0)], [3.2, 4.8], [3.3, 4.7]]
    )
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
def test_rounding_neither_brakes_nor_turns(exact, rng, basis):
    """What sum w - 1 is in the mean of a cell takes speed away in every step, sum w (i - xi) turns:
    both 0 to a tenth of u = U / 2.  (At a place they are half of u: the mean of 40,000 has 0.003.
    Cubic splines with a rounded third in two weights have 0.7.)"""
    xi = 4 + rng.random((20000, 2))
    first, w, _ = table(basis, xi)
    w = w.astype(np.longdouble)
    r = first[:, None, :] + np.arange(basis.support)[None, :, None] - xi[:, None, :]
    assert abs((w.sum(axis=1) - 1).mean()) < 0.05 * U
    assert abs((w * r).sum(axis=1).mean()) < 0.05 * U


@pytest.mark.parametrize("basis", BASES)
def test_slopes_are_derivatives(exact, rng, basis):
    """dw by central differences, h = 1e-6: error h^2 and U / h, so 1e-9; away from the knots."""
    xi, half = coordinates(rng)[:200], 0.05 + 0.45 * rng.random()
    h = 1e-6
    knots = np.concatenate([2 * xi, 2 * (xi + half), 2 * (xi - half)], axis=1)
    away = (np.abs(knots - np.round(knots)) > 4 * h).all(axis=1)
    xi = xi[away]
    (_, _, dw), (_, up, _), (_, down, _) = (table(basis, x, half) for x in (xi, xi + h, xi - h))
    assert np.abs((up - down) / (2 * h) - dw).max() < 1e-9


@pytest.mark.parametrize("basis", BASES)
def test_moment_is_what_the_basis_says(exact, rng, basis):
    """D = sum w (i - xi)^2 [dx^2]: constant 1 / inverse_moment, or a function of place, which may
    have zeros."""
    xi = coordinates(rng)
    first, w, _ = table(basis, xi)
    r = first[:, None, :] + np.arange(basis.support)[None, :, None] - xi[:, None, :]
    D = (w * r**2).sum(axis=1)
    if basis.modified:  # away from walls
        assert np.ptp(D) < 1e-13
    elif basis.inverse_moment is None:
        assert np.ptp(D) > 0.1
        assert basis.moment_vanishes == (D.min() < 1e-3)
    else:
        assert np.abs(D - 1 / basis.inverse_moment).max() < 1e-13


@pytest.mark.parametrize("basis", BASES)
def test_steepness_bounds_the_gradients(exact, basis):
    """sup of sum dw^2 / w over the positions: reached to 1 % on a fine scan, or growing without
    bound as a weight goes to 0 (beside a wall, for modified splines)."""
    xi = np.repeat(4 + (np.arange(20000) + 0.5)[:, None] / 20000, 2, axis=1)
    half = 0.2
    if basis.modified:
        w, dw = bent(basis, (xi - 4)[:, 0])
    else:
        _, w, dw = table(basis, xi, half)
    slopes = np.where(w > 1e-12, dw, 0.0) ** 2 / np.maximum(w, 1e-12)
    largest, bound = slopes.sum(axis=1).max(), basis.steepness(half)
    if bound is None:
        assert largest > 1e4
    else:
        assert 0.99 * bound < largest <= bound * (1 + 1e-3)


@pytest.mark.parametrize("basis", BASES)
def test_twin_has_the_same_values(exact, rng, basis):
    """The twin has the usual piecewise definition: equal to 1e-14 (slopes of uGIMP: 1e-14 / l)."""
    twin = getattr(twin_bases, basis.__name__)
    xi, half = coordinates(rng), 0.05 + 0.45 * rng.random()
    first, w, dw = table(basis, xi, half)
    for p in range(len(xi)):
        assert (twin.first(xi[p]) == first[p]).all()
        assert np.abs(twin.weights(xi[p] - first[p], half) - w[p]).max() < 1e-14
        assert np.abs(twin.slopes(xi[p] - first[p], half) - dw[p]).max() < 1e-14 / half


def bent(basis, x):
    """Weights and slopes [n, nodes] at places x >= 0 [cells] from a wall at the first node."""
    particles = SimpleNamespace(x=np.stack([x, x + 5], axis=1), half_width=np.full(len(x), 0.2))
    grid = SimpleNamespace(dx=1.0, dim=2, cells=(9, 20), ghost=4, walled=((0, False), (0, True)))
    twin = getattr(twin_bases, basis.__name__)
    w, dw = np.zeros((2, len(x), grid.cells[0] + 1 + 2 * grid.ghost))
    for p in range(len(x)):
        base, _, weights, slopes = weigh(p, particles, grid, twin)
        w[p, base[0] : base[0] + twin.support] = weights[:, 0]
        dw[p, base[0] : base[0] + twin.support] = slopes[:, 0]
    return w, dw


MODIFIED = [basis for basis in BASES if basis.modified]
GHOSTS = [basis for basis in BASES if not basis.modified and basis.support > 2]


@pytest.mark.parametrize("basis", MODIFIED)
def test_modified_splines_at_walls(basis, rng):
    """Between two walls 9 cells apart: no weight behind a wall, sum w = 1, sum dw = 0,
    sum w i = x, sum dw i = 1 and w >= 0, on the walls too; the moment D vanishes there."""
    x = np.concatenate([9 * rng.random(200), [0.0, 9.0, np.nextafter(9.0, 0.0)]])
    w, dw = bent(basis, x)
    i = np.arange(w.shape[1]) - 4.0
    outside = (i < 0) | (i > 9)
    assert (w[:, outside] == 0).all() and (dw[:, outside] == 0).all()
    assert (w >= -8 * U).all()
    assert np.abs(w.sum(axis=1) - 1).max() <= 32 * U
    assert np.abs(dw.sum(axis=1)).max() <= 64 * U
    assert np.abs(w @ i - x).max() <= 64 * U * 9
    assert np.abs(dw @ i - 1).max() <= 128 * U * 9
    D = (w * (i - x[:, None]) ** 2).sum(axis=1)
    assert D[-2] == pytest.approx(0, abs=1e-14) and D[0] > 0


@pytest.mark.parametrize("basis", GHOSTS)
def test_other_wide_bases_reach_behind_a_wall(basis, rng):
    """What does not hold for plain splines and uGIMP: beside a wall the nodes inside alone have
    sum w < 1 and sum w i > x, which is why ghost nodes are mirrored."""
    x = 0.15 * rng.random(50)
    w, _ = bent(basis, x)
    i = np.arange(w.shape[1]) - 4.0
    inside = i >= 0
    assert (w[:, inside].sum(axis=1) < 1).all()
    assert (w[:, inside] @ i[inside] > x).all()
    assert np.abs(w @ i - x).max() <= 64 * U
