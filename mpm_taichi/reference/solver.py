"""The step: the table of contents of the method."""

from math import sqrt
from typing import Any

import numpy as np

from .grid import Grid
from .kernels.body_force import push
from .kernels.clear import clear
from .kernels.g2p import g2p
from .kernels.ghosts import fill_ghosts, fold_ghosts
from .kernels.grid_update import grid_update
from .kernels.p2g import p2g
from .kernels.residual import take_residual
from .kernels.start_moments import start_moments
from .kernels.tally import note_at_walls, note_start
from .kernels.update_stress import update_stress
from .kernels.wrap import wrap
from .particles import Particles
from .tally import Tally


class Solver:
    """Bodies in a box of `cells` cells of edge `dx` [m]; see mpm_taichi/solver.py."""

    def __init__(
        self, bodies, cells, dx, basis, transfer, walls, gravity, mass_cutoff=None, periodic=(),
        stress_update="usl", flip_part=None, filter_order=1, body_force=None,
        audited=False,
    ):  # fmt: skip
        self.basis, self.transfer, self.walls = basis, transfer, walls
        self.stress_update, self.body_force = stress_update, body_force
        self.flip_part, self.filter_order = flip_part or (lambda dt: 1.0), filter_order
        self.particles = Particles(bodies, basis, transfer, dx)
        self.grid = Grid(
            cells, dx, basis, self._mass_cutoff(mass_cutoff, bodies, cells), walls, periodic
        )
        self.gravity = np.array(gravity, float)
        if transfer.moments and not basis.inverse_moment:
            start_moments(self.particles, self.grid, basis)
        self.tally: Any = None
        if audited:
            force = body_force is not None
            self.tally = Tally(self.grid, walls, transfer, self.gravity, force)

    def _mass_cutoff(self, part, bodies, cells):
        """`part` of the lightest particle's mass [kg]; not given: the rounding error of a weight
        where gradients do not vanish with the weight, and strain follows from forces."""
        if part is None:
            unbent = self.basis.modified and not self.walls
            harmless = self.stress_update != "usl" and not self.basis.modified
            smooth = unbent or harmless or self.basis.steepness(0.25) is not None
            part = 0.0 if smooth else 16 * np.finfo(float).eps * max(cells)
        lightest = min((body.material.density * body.V0).min() for body in bodies)
        return float(part * lightest)

    def start(self, dt):
        """Write the impulse of the first step, of length dt [s]."""
        if self.tally and not self.transfer.increment:
            note_start(self.particles, self.grid, self.basis, self.transfer, self.tally)
        self.update(0.0, dt)

    def update(self, dt, dt_next, **parts):
        for group in self.particles.groups:
            alpha = self.flip_part(dt)
            update_stress(
                self.particles, group, self.grid, self.transfer, dt, dt_next, alpha,
                tally=self.tally, **parts,
            )  # fmt: skip

    def step(self, time, dt, dt_next):
        """Advance from `time` by dt [s], the next step being of length dt_next; returns the largest
        |sum_i w_i v_i| [m/s], |L| and - tr L [1/s] of all particles."""
        wrap(self.particles, self.grid)
        rates = None
        if self.stress_update == "usf":
            self.map_gradient()
            self.update(dt, dt, velocity=False, move=False)
            rates = self.rates()
        self.map_motion(time, dt)
        if self.stress_update == "usl":
            self.update(dt, dt_next)
        elif self.stress_update == "usf":
            self.update(dt, dt_next, stress=False)
        else:
            self.update(dt, dt_next, stress=False, move=False)
            self.map_gradient()
            self.update(dt, dt_next, velocity=False)
        return sqrt(self.grid.speed_squared), *(rates or self.rates())

    def rates(self):
        """The largest |grad v| and - div v [1/s] that have strained particles."""
        return sqrt(self.grid.rate_squared), self.grid.compression

    def map_motion(self, time, dt):
        """Particles to nodes, the motion of the nodes, and back."""
        if self.body_force is not None:
            push(self.particles, self.grid, self.body_force, time, dt)
        clear(self.grid)
        p2g(self.particles, self.grid, self.basis, self.transfer)
        self.note_at_walls(dt, "given")
        fold_ghosts(self.grid, self.walls, self.gravity, dt)
        grid_update(self.grid, self.walls, self.gravity, dt, self.tally)
        self.note_at_walls(dt, "kept")
        fill_ghosts(self.grid, self.walls, self.gravity)
        self.note_at_walls(dt, "taken")
        g2p(self.particles, self.grid, self.basis, self.transfer, dt=dt, tally=self.tally)
        if self.transfer.filtered:
            take_residual(
                self.particles, self.grid, self.basis, self.transfer, self.walls, self.gravity,
                self.filter_order,
            )  # fmt: skip

    def map_gradient(self):
        """L of the velocities that particles have now, as the nodes see them."""
        clear(self.grid)
        p2g(self.particles, self.grid, self.basis, self.transfer, "momentum")
        fold_ghosts(self.grid, self.walls, self.gravity, 0.0)
        grid_update(self.grid, self.walls, self.gravity, 0.0)
        fill_ghosts(self.grid, self.walls, self.gravity)
        g2p(self.particles, self.grid, self.basis, self.transfer, "gradient")

    def note_at_walls(self, dt, when):
        if self.tally and self.walls:
            note_at_walls(self.grid, self.gravity, dt, self.flip_part(dt), self.tally, when)
