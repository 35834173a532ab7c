"""A run of a moved, turned, mirrored or renumbered scene is the moved, turned, ... run.

Rounding errors only: f64, 20 steps, so 1e-11 of the largest value (some hundred contributions to a
node, each step)."""

import numpy as np
import pytest

from mpm_taichi.bases import GIMP, CubicBSpline, QuadraticBSpline
from mpm_taichi.transfers import APIC, MLS, TPIC

from ..cases import CASES
from ..verification.motions import JELLY, advance, ball_points, restart, solver

CELLS = {2: 16, 3: 10}
STEPS = 20


def cloud(rng, dim):
    """A jittered lattice of two per cell and axis in the middle of the unit box, a tenth of it left
    out, with random velocities and volumes.  (Points as random as that would leave hat functions
    nodes of almost no mass, which magnify rounding errors: a tenth of a cell is kept.)"""
    h = 0.5 / CELLS[dim]
    lattice = np.indices((6,) * dim).reshape(dim, -1).T + 0.5 + 0.3 * (rng.random(dim) - 0.5)
    x = round(0.4 * CELLS[dim]) / CELLS[dim] + h * (
        lattice + 0.3 * (rng.random(lattice.shape) - 0.5)
    )
    x = x[rng.random(len(x)) < 0.9]
    return x, rng.normal(size=x.shape), h**dim * (0.5 + rng.random(len(x)))


def run(mpm, x, v, V0):
    restart(mpm, x, v, V0)
    advance(mpm, 0.05 * mpm.grid.dx / JELLY.wave_speed(), STEPS)
    return mpm.particles.to_numpy("x"), mpm.particles.to_numpy("H")


def close(a, b):
    return np.abs(a - b).max() < 1e-11 * max(np.abs(b).max(), 1.0)


@pytest.mark.parametrize(("dim", "basis", "transfer"), CASES)
def test_mirror_rotation_and_order(exact, rng, dim, basis, transfer):
    """Mirror image in x, turn by 90 degrees (x, y) -> (-y, x) about the middle, cyclic exchange of
    the axes, and the particles in another order."""
    x, v, V0 = cloud(rng, dim)
    mpm = solver(x, v, V0, CELLS[dim], basis, transfer)
    x_end, H_end = run(mpm, x, v, V0)
    one = np.eye(dim)
    mirror, cycle, turn = one.copy(), np.roll(one, 1, axis=0), one.copy()
    mirror[0, 0] = -1
    turn[:2, :2] = [[0, -1], [1, 0]]
    for Q in (mirror, cycle, turn):
        x_turned, H_turned = run(mpm, (x - 0.5) @ Q.T + 0.5, v @ Q.T, V0)
        assert close(x_turned, (x_end - 0.5) @ Q.T + 0.5)
        assert close(H_turned, Q @ H_end @ Q.T)
    order = rng.permutation(len(x))
    x_shuffled, H_shuffled = run(mpm, x[order], v[order], V0[order])
    assert close(x_shuffled, x_end[order])
    assert close(H_shuffled, H_end[order])


@pytest.mark.parametrize("dim", [2, 3])
def test_translation_by_a_cell(exact, rng, dim):
    """The scene a cell further along every axis: the same motion there."""
    x, v, V0 = cloud(rng, dim)
    dx = 1 / CELLS[dim]
    mpm = solver(x, v, V0, CELLS[dim], QuadraticBSpline, MLS)
    x_end, H_end = run(mpm, x, v, V0)
    x_moved, H_moved = run(mpm, x + dx, v, V0)
    assert close(x_moved, x_end + dx)
    assert close(H_moved, H_end)


@pytest.mark.parametrize(("dim", "cells"), [(2, 96), pytest.param(3, 40, marks=pytest.mark.slow)])
def test_through_the_ends_of_periodic_axes(exact, rng, dim, cells):
    """The scene further along every axis, all of which close on themselves: the same motion across
    corners and ends, and where only stencils reach over them, to nodes that no particle is near.
    Only nodes near particles and their images are touched."""
    x, v, V0 = cloud(rng, dim)
    scale = CELLS[dim] / cells
    x, V0 = scale * (x - x.mean(axis=0)) + 0.5, scale**dim * V0
    mpm = solver(x, v, V0, cells, QuadraticBSpline, MLS, periodic=tuple(range(dim)))
    x_end, H_end = run(mpm, x, v, V0)
    for way in (0.5, 0.5 - 2 / cells):
        x_moved, H_moved = run(mpm, (x + way) % 1.0, v, V0)
        assert close((x_moved - x_end) % 1.0, way + 0 * x)
        assert close(H_moved, H_end)
        assert mpm.grid.active_count[None] < 0.5 * mpm.grid.chunks


@pytest.mark.parametrize(
    ("basis", "transfer"),
    [(QuadraticBSpline, MLS), (CubicBSpline, MLS), (QuadraticBSpline, APIC), (GIMP, TPIC)],
)
def test_galilean_pair(fast, basis, transfer):
    """A ball that breathes at rest, and the same ball on its way through three cells: the motion
    about its middle is the same but for the discretization, 10 % of the largest displacement for a
    ball 3.5 cells in radius (splines stay below 5 %)."""
    x, V0 = ball_points(2, CELLS[2], 0.22, -0.15)
    breathing = 3.0 * (x - x.mean(axis=0))
    mpm = solver(x, breathing, V0, CELLS[2], basis, transfer)
    steps, dt = 40, 0.2 * mpm.grid.dx / JELLY.wave_speed()
    V = 3 * mpm.grid.dx / (steps * dt) * np.array([1.0, 0.7])
    ends = []
    for uniform in (0 * V, V):
        restart(mpm, x, breathing + uniform, V0)
        advance(mpm, dt, steps)
        ends.append(mpm.particles.to_numpy("x") - x - steps * dt * uniform)
    at_rest, riding = ends
    assert np.abs(at_rest).max() > 0.1 * mpm.grid.dx
    assert np.abs(riding - at_rest).max() < 0.1 * np.abs(at_rest).max()
