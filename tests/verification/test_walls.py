"""Walls: the rules at the nodes, and a ball that falls on a floor."""

import numpy as np
import pytest

from mpm_taichi.bases import GIMP, CubicBSpline, QuadraticBoundary, QuadraticBSpline
from mpm_taichi.boundaries import RULES, Separate, Slip, Sticky, Wall
from mpm_taichi.kernels.clear import clear
from mpm_taichi.kernels.ghosts import fill_ghosts, fold_ghosts
from mpm_taichi.kernels.grid_update import grid_update
from mpm_taichi.kernels.p2g import p2g
from mpm_taichi.particles import BodyPoints
from mpm_taichi.solver import Solver
from mpm_taichi.transfers import FLIP, MLS

from ..parity.states import nodes
from .motions import JELLY, advance, ball_points, restart, snapshot, solver

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


def after_the_grid_update(mpm, dt):
    """m [kg] and v [m/s] of all nodes, ghosts included."""
    mpm.start(dt)
    mpm.sort_if_due()
    clear(mpm.grid)
    p2g(mpm.particles, mpm.grid, mpm.basis, mpm.transfer)
    fold_ghosts(mpm.grid, mpm.walls, mpm.gravity, dt)
    grid_update(mpm.grid, mpm.walls, mpm.gravity, dt)
    fill_ghosts(mpm.grid, mpm.walls, mpm.gravity)
    return nodes(mpm.grid, mpm.grid.dim)[0], nodes(mpm.grid, list(range(mpm.grid.dim)))[0]


def mirrored(x, v, V0):
    """Particles in [0, 1]^2 and their images in its sides and corners, with the signs of velocity
    that a wall which holds (first) and one which lets slide (second) give them."""
    places, holding, sliding = [], [], []
    for i in (-1, 0, 1):
        for j in (-1, 0, 1):
            flips = np.array([-1.0 if i else 1.0, -1.0 if j else 1.0])
            at = np.array([{-1: 0.0, 0: 0.0, 1: 2.0}[k] for k in (i, j)])
            places.append(at + flips * x)
            holding.append(v * flips.prod())
            sliding.append(v * flips)
    return np.concatenate(places), np.concatenate(holding), np.concatenate(sliding)


@pytest.mark.parametrize("rule", [Sticky, Slip])
def test_walls_mirror(fast, rng, rule):
    """A box full of random motion between walls has the nodal masses and velocities of nine boxes
    in the open, eight of which are mirror images of the one in the middle: 1e-12.  (On the walls
    the images would double mass and momentum alike.)  There a sticky rule leaves nothing, a slip
    rule no velocity across."""
    x, V0 = ball_points(2, CELLS, 0.75, 0.0)
    x = np.clip(x + 0.4 / CELLS * (rng.random(x.shape) - 0.5), 0.0, 1.0)
    v = rng.normal(size=x.shape)
    walls = tuple(Wall(axis, upper, rule) for axis, upper in SIDES)
    closed = Solver(
        [BodyPoints(JELLY, x, v, V0)], (CELLS, CELLS), 1 / CELLS, QuadraticBSpline, MLS, walls,
        [0.0, 0.0],
    )  # fmt: skip
    m, v_i = after_the_grid_update(closed, 1e-3)
    places, holding, sliding = mirrored(x, v, V0)
    nine = solver(
        (places + 1) / 3, (holding if rule is Sticky else sliding) / 3, np.tile(V0, 9) / 9,
        3 * CELLS, QuadraticBSpline, MLS,
    )  # fmt: skip
    m_nine, v_nine = after_the_grid_update(nine, 1e-3)
    ghost = closed.grid.ghost
    middle = (slice(CELLS, 2 * CELLS + 1 + 2 * ghost),) * 2
    inner = (slice(ghost - 1, ghost + CELLS + 2),) * 2
    inside = (slice(ghost + 1, ghost + CELLS),) * 2
    assert np.abs(m - 9 * m_nine[middle])[inside].max() < 1e-12 * m.max()
    assert np.abs(v_i - 3 * v_nine[middle])[inner].max() < 1e-12 * np.abs(v_i).max()
    on_wall = v_i[ghost, ghost:-ghost]
    assert (on_wall == 0).all() if rule is Sticky else (on_wall[:, 0] == 0).all()


@pytest.mark.slow
def test_a_wall_that_lets_go(fast, rng):
    """Nodes of a separate wall: where the material presses they are those of a slip wall, where it
    moves away those of no wall at all."""
    found = []
    x, V0 = ball_points(2, CELLS, 0.75, 0.0)
    for rule in (Separate, Slip, None):
        walls = () if rule is None else (Wall(0, False, rule),)
        mpm = Solver(
            [BodyPoints(JELLY, x, 0 * x, V0)], (CELLS, CELLS), 1 / CELLS, QuadraticBSpline, MLS,
            walls, [0.0, 0.0],
        )  # fmt: skip
        for push in (-1.0, 1.0):
            v = np.tile([push, 0.3], (len(x), 1)) + 0.1 * np.sin(9 * x[:, ::-1])
            restart(mpm, x, v, V0)
            found.append(after_the_grid_update(mpm, 1e-3)[1])
    pressed, leaving, slip_pressed, _, _, free_leaving = found
    assert np.abs(pressed - slip_pressed).max() < 1e-13
    assert np.abs(leaving - free_leaving).max() < 1e-13


@pytest.mark.parametrize(
    "basis",
    [
        pytest.param(GIMP, marks=pytest.mark.campaign), QuadraticBSpline, CubicBSpline,
        QuadraticBoundary,
    ],
)  # fmt: skip
def test_a_compressed_block_rests_between_walls(fast, basis):
    """Uniform pressure in a box full of material, walls all round: nothing may move, since the
    mirror images push back as hard.  (Zeroed ghost nodes let it stream.)  400 steps, FLIP."""
    h = 0.5 / CELLS
    x = (np.indices((2 * CELLS,) * 2).reshape(2, -1).T + 0.5) * h
    H = np.tile(-0.05 * np.eye(2), (len(x), 1, 1))
    walls = tuple(Wall(axis, upper, Slip) for axis, upper in SIDES)
    mpm = Solver(
        [BodyPoints(JELLY, x, 0 * x, np.full(len(x), h**2 / 0.95**2), x, H)], (CELLS, CELLS),
        1 / CELLS, basis, FLIP, walls, [0.0, 0.0],
    )  # fmt: skip
    advance(mpm, 0.2 / CELLS / JELLY.wave_speed(), 400)
    now = snapshot(mpm)
    assert np.abs(now.position - x).max() < 1e-12
    assert np.abs(now.velocity).max() < 1e-10


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
        mpm.step(0.0, dt, dt)
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
