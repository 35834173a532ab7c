"""The step: the table of contents of the method."""

from math import inf, sqrt

import numpy as np
import taichi as ti

from .grid import Grid
from .kernels.clear import clear
from .kernels.g2p import g2p
from .kernels.grid_update import grid_update
from .kernels.p2g import p2g
from .kernels.sort import sort
from .kernels.update_stress import update_stress
from .particles import Particles


class Solver:
    """Bodies in a box of `cells` cells of edge `dx` [m], stress updated last (USL).

    `walls` lists the sides of the domain that have a rule; the others are open.  Nodes no heavier
    than `mass_cutoff` times the lightest particle are taken as empty.  `threads` workers share the
    work on a CPU, and the result does not depend on it; `atomic` is the form for GPUs."""

    def __init__(self, bodies, cells, dx, basis, transfer, walls, gravity, mass_cutoff=None,
                 threads=1, atomic=False):  # fmt: skip
        self.basis, self.transfer, self.walls = basis, transfer, walls
        self.particles = Particles(bodies, transfer, dx)
        self.grid = Grid(
            cells, dx, basis, self.particles.group_count, transfer.increment,
            self._mass_cutoff(mass_cutoff, bodies, cells), threads, atomic,
        )  # fmt: skip
        self.gravity = ti.Vector.field(self.particles.dim, float, ())
        self.gravity[None] = list(gravity)
        self.drift = inf  # bound of the cells that a particle has moved since the sort
        self.sorts = 0

    def _mass_cutoff(self, part, bodies, cells):
        """`part` of the lightest particle's mass [kg].  Not given: 0 for smooth bases.  Hat
        functions have gradients that stay where the weight goes to 0, so a weight of the size of
        the rounding error of x / dx would take a full force."""
        if part is None:
            smooth = self.basis.steepness is not None
            part = 0.0 if smooth else 16 * np.finfo(self.particles.dtype).eps * max(cells)
        lightest = min((body.material.density * body.V0).min() for body in bodies)
        return float(part * lightest)

    def start(self, dt):
        """Write the rows of the first step, of length dt [s]."""
        for group in self.particles.groups:
            update_stress(self.particles, group, self.grid, self.transfer, 0.0, dt)

    def sort_if_due(self):
        """Slabs leave room for one cell of drift.  Particles move with sum_i w_i v_i, the weights
        are >= 0 and sum to 1: none is faster than the fastest node."""
        if not self.drift < 0.99:
            sort(self.particles, self.grid, self.basis)
            self.drift = 0.0
            self.sorts += 1

    def step(self, dt, choose_dt):
        """Advance by dt [s]; the stress is written as the impulse of the next step, whose length
        choose_dt(speed) gives from the largest nodal speed [m/s].  Returns that length."""
        self.sort_if_due()
        clear(self.grid)
        p2g(self.particles, self.grid, self.basis, self.transfer)
        grid_update(self.grid, self.walls, self.gravity, dt)
        speed = sqrt(self.grid.speed_squared[None])
        dt_next = choose_dt(speed)
        g2p(self.particles, self.grid, self.basis, self.transfer)
        for group in self.particles.groups:
            update_stress(self.particles, group, self.grid, self.transfer, dt, dt_next)
        self.drift += dt * speed / self.grid.dx
        return dt_next
