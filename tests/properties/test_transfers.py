"""What transfers keep between particles and nodes, in a stencil that is whole."""

import numpy as np
import pytest

from mpm_taichi.bases import QuadraticBSpline
from mpm_taichi.kernels.clear import clear
from mpm_taichi.kernels.evaluate import evaluate
from mpm_taichi.kernels.g2p import g2p
from mpm_taichi.kernels.grid_update import grid_update
from mpm_taichi.kernels.p2g import p2g
from mpm_taichi.kernels.sort import sort
from mpm_taichi.transfers import FLIP, PIC

from ..cases import CASES
from ..verification.motions import Living, ball_points

pytestmark = pytest.mark.xdist_group("transfers")


@pytest.fixture(scope="module")
def living():
    return Living(fast_math=False)


def gathered(mpm):
    """v, C or S [n, dim, dim] in 1/s after one P2G, grid update and G2P without force."""
    P, G, dim = mpm.particles, mpm.grid, mpm.grid.dim
    sort(P, G, mpm.basis)
    clear(G)
    p2g(P, G, mpm.basis, mpm.transfer)
    grid_update(G, mpm.walls, mpm.gravity, 0.0)
    g2p(P, G, mpm.basis, mpm.transfer)
    rows = P.to_numpy("rows")
    columns = lambda at: rows[:, list(at), :dim].swapaxes(1, 2)  # noqa: E731
    C = columns(P.layout.moments) * G.dx * (mpm.basis.inverse_moment or 1.0) / G.dx**2
    if mpm.transfer.moments and not mpm.basis.inverse_moment:
        C /= evaluate(P, G, mpm.basis)["D"][:, None, :]
    S = columns(P.layout.gradient) / G.dx
    return rows[:, P.layout.pic, :dim], C, S


def scattering(living, rng, dim, basis, transfer, field):
    """A ball with random masses whose particles scatter the affine field v = a + M x."""
    cells = {2: 16, 3: 10}[dim]
    x, V0 = ball_points(dim, cells, 0.25, 0.1 * (rng.random(dim) - 0.5))
    a, M = field
    mpm = living.solver(x, x @ M.T + a, V0 * (0.5 + rng.random(len(x))), cells, basis, transfer)
    mpm.start(0.0)
    if transfer.affine:
        rows = mpm.particles.rows.to_numpy()
        m, D = mpm.particles.m.to_numpy(), np.ones_like(x)
        if transfer.moments and not basis.inverse_moment:
            D = evaluate(mpm.particles, mpm.grid, basis)["D"]
        for d, row in enumerate(mpm.particles.layout.affine):
            rows[:, row, :dim] = (m * D[:, d])[:, None] * M[:, d] * mpm.grid.dx
        mpm.particles.rows.from_numpy(rows)
    return mpm, x


@pytest.mark.parametrize(("dim", "basis", "transfer"), CASES)
def test_uniform_motion_comes_back(living, rng, dim, basis, transfer):
    """v = a at all particles: v = a at all nodes and back, with no gradient (sum w = 1)."""
    a = rng.normal(size=dim)
    mpm, _ = scattering(living, rng, dim, basis, transfer, (a, np.zeros((dim, dim))))
    v, C, S = gathered(mpm)
    assert np.abs(v - a).max() < 1e-13
    dx = mpm.grid.dx
    assert max(np.abs(C).max(initial=0), np.abs(S).max(initial=0)) * dx < 1e-12


AFFINE = [case for case in CASES if getattr(case.values[2], "affine", False)]


@pytest.mark.parametrize(("dim", "basis", "transfer"), AFFINE)
def test_affine_motion_comes_back(living, rng, dim, basis, transfer):
    """v = a + M x with C = M: P2G puts a + M x_i on every node, also at the ragged edge, and G2P
    returns v, C = M (and L = M) to rounding error.  (TPIC gathers L alone.)"""
    a, M = rng.normal(size=dim), rng.normal(size=(dim, dim))
    mpm, x = scattering(living, rng, dim, basis, transfer, (a, M))
    v, C, S = gathered(mpm)
    assert np.abs(v - (x @ M.T + a)).max() < 1e-12
    if transfer.moments:
        assert np.abs(C - M).max() < 1e-11
    if transfer.gradient:
        assert np.abs(S - M).max() < 1e-11


@pytest.mark.parametrize("transfer", [PIC, FLIP])
def test_affine_motion_blurs_without_an_affine_part(living, rng, transfer):
    """The control: PIC and FLIP scatter no affine part, so the gathered velocity differs at the
    edge of the body."""
    basis = QuadraticBSpline
    a, M = rng.normal(size=2), np.array([[1.0, 2.0], [-2.0, 1.0]])
    mpm, x = scattering(living, rng, 2, basis, transfer, (a, M))
    v, _, _ = gathered(mpm)
    assert np.abs(v - (x @ M.T + a)).max() > 1e-3
