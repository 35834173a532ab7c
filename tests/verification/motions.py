"""Solvers with particles set by hand, and what they conserve."""

import numpy as np

from mpm_taichi import diagnostics, runtime
from mpm_taichi.materials import NeoHookean
from mpm_taichi.particles import BodyPoints
from mpm_taichi.shapes import Ball
from mpm_taichi.snapshot import take_snapshot
from mpm_taichi.solver import Solver
from mpm_taichi.transfers import FlipPart

JELLY = NeoHookean(type="neo_hookean", density=1000, youngs_modulus=1e4, poissons_ratio=0.3)


def ball_points(dim, cells, radius, offset):
    """Lattice of 2 per cell and axis inside a ball in the middle of the unit box, then moved."""
    h = 0.5 / cells
    lattice = (np.indices((2 * cells,) * dim).reshape(dim, -1).T + 0.5) * h
    ball = Ball(type="ball", center=[0.5] * dim, radius=radius)
    x = lattice[ball.signed_distance(lattice) < 0] + offset
    return x, np.full(len(x), h**dim)


def solver(x, v, V0, cells, basis, transfer, gravity=None, **options):
    dim = x.shape[1]
    return Solver(
        [BodyPoints(JELLY, x, v, V0)], (cells,) * dim, 1 / cells, basis, transfer, (),
        gravity or [0.0] * dim, **options,
    )  # fmt: skip


def restart(solver, x, v, V0):
    """The same solver with as many particles at other places: nothing is compiled again."""
    particles = solver.particles
    assert particles.count == len(x)
    particles.H.fill(0.0)
    particles.fill([BodyPoints(JELLY, x, v, V0)], [0])
    solver.drift = np.inf


class Living:
    """Solvers of one start of Taichi, f64: those of a method with as many particles are compiled
    once, and start again with others."""

    def __init__(self, **options):
        runtime.start("cpu", "f64", threads=2, **options)
        self.solvers = {}

    def solver(
        self, x, v, V0, cells, basis, transfer, gravity=None, flip_part=None, filter_order=1
    ):
        key = x.shape, cells, basis, transfer
        if key not in self.solvers:
            self.solvers[key] = solver(x, v, V0, cells, basis, transfer)
        found = self.solvers[key]
        restart(found, x, v, V0)
        found.gravity[None] = list(gravity or [0.0] * x.shape[1])
        found.flip_part, found.filter_order = flip_part or FlipPart(), filter_order
        found.grid.cut[None] = 0
        return found


def advance(solver, dt, steps):
    solver.start(dt)
    for step in range(steps):
        solver.step(step * dt, dt, dt)


def snapshot(solver):
    particles = solver.particles
    constant = {"mass": particles.to_numpy("m"), "initial_volume": particles.to_numpy("V0")}
    return take_snapshot(solver, constant, 0.0, 0)


def momenta(solver):
    now = snapshot(solver)
    return diagnostics.momentum(now), diagnostics.angular_momentum(now)
