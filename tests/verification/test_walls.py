"""Walls: the rules at the nodes, and a ball that falls on a floor."""

import numpy as np
import pytest

from mpm_taichi.bases import QuadraticBSpline
from mpm_taichi.boundaries import RULES, Slip, Sticky, Wall
from mpm_taichi.kernels.clear import clear
from mpm_taichi.kernels.grid_update import grid_update
from mpm_taichi.kernels.p2g import p2g
from mpm_taichi.particles import BodyPoints
from mpm_taichi.solver import Solver
from mpm_taichi.transfers import MLS

from ..parity.states import nodes
from .motions import JELLY, ball_points, snapshot

CELLS = 16
SIDES = [(axis, upper) for axis in (0, 1) for upper in (False, True)]


def ball_in_a_box(rng, rule, dim=2, velocity=None, gravity=None, radius=0.2):
    x, V0 = ball_points(dim, CELLS, radius, 0.0)
    v = rng.normal(size=x.shape) if velocity is None else np.tile(velocity, (len(x), 1))
    walls = tuple(Wall(axis, upper, rule) for axis in range(dim) for upper in (False, True))
    return Solver(
        [BodyPoints(JELLY, x, v, V0)], (CELLS,) * dim, 1 / CELLS, QuadraticBSpline, MLS, walls,
        gravity or [0.0] * dim,
    )  # fmt: skip


@pytest.mark.parametrize("rule", RULES)
def test_rule_holds_at_and_behind_each_wall(fast, rng, rule):
    """After the grid update of random motion in the whole box: sticky nodes stand; slip nodes have
    no normal velocity and keep the tangential one; separate nodes do not move into the wall."""
    mpm = ball_in_a_box(rng, rule, radius=0.75)
    mpm.start(1e-3)
    mpm.sort_if_due()
    clear(mpm.grid)
    p2g(mpm.particles, mpm.grid, mpm.basis, mpm.transfer)
    momentum, _ = nodes(mpm.grid, [0, 1])
    mass, _ = nodes(mpm.grid, 2)
    grid_update(mpm.grid, mpm.walls, mpm.gravity, 1e-3)
    v, _ = nodes(mpm.grid, [0, 1])
    occupied = mass > 0
    free = np.where(occupied[..., None], momentum / np.where(occupied, mass, 1)[..., None], 0)
    index = np.indices(mass.shape) - mpm.grid.ghost
    expected = free.copy()
    for axis, upper in SIDES:
        at = index[axis] >= CELLS if upper else index[axis] <= 0
        inward = -1.0 if upper else 1.0
        if rule is Sticky:
            expected[at] = 0
        elif rule is Slip:
            expected[at, axis] = 0
        else:
            expected[at, axis] = inward * np.maximum(inward * expected[at, axis], 0)
    assert (occupied & (index[0] <= 0)).any() and (occupied & (index[1] >= CELLS)).any()
    assert np.abs(v - expected).max() < 1e-13 * np.abs(free).max()


@pytest.mark.parametrize("rule", RULES)
def test_ball_bounces_off_the_floor(fast, rng, rule):
    """Falls 0.25 m under g and slides: it stays inside and comes back up.  A frictionless floor
    leaves the horizontal momentum as it was, to rounding error; a sticky one takes more than a
    tenth of it."""
    mpm = ball_in_a_box(rng, rule, velocity=[0.2, 0.0], gravity=[0.0, -9.81])
    dt = 0.3 / CELLS / JELLY.wave_speed()
    mpm.start(dt)
    start = now = snapshot(mpm)
    heights, lowest = [], 1.0
    for _ in range(int(0.55 / dt)):
        mpm.step(dt, lambda speed: dt)
        now = snapshot(mpm)
        heights.append(now.position[:, 1].mean())
        lowest = min(lowest, now.position[:, 1].min())
    assert mpm.particles.lost[None] == mpm.particles.count
    assert lowest > 0
    impact = int(np.argmin(heights))
    assert heights[impact] < 0.25 and max(heights[impact:]) > heights[impact] + 0.08
    before, after = (s.mass @ s.velocity[:, 0] for s in (start, now))
    if rule is Sticky:
        assert after < 0.9 * before
    else:
        assert after == pytest.approx(before, rel=1e-11)
