"""The step: the table of contents of the method."""

from math import sqrt

import numpy as np

from .grid import Grid
from .kernels.clear import clear
from .kernels.g2p import g2p
from .kernels.grid_update import grid_update
from .kernels.p2g import p2g
from .kernels.update_stress import update_stress
from .particles import Particles


class Solver:
    """Bodies in a box of `cells` cells of edge `dx` [m], stress updated last (USL)."""

    def __init__(self, bodies, cells, dx, basis, transfer, walls, gravity, mass_cutoff=None):
        self.basis, self.transfer, self.walls = basis, transfer, walls
        self.particles = Particles(bodies, transfer, dx)
        self.grid = Grid(cells, dx, basis, self._mass_cutoff(mass_cutoff, bodies, cells))
        self.gravity = np.array(gravity, float)

    def _mass_cutoff(self, part, bodies, cells):
        """`part` of the lightest particle's mass [kg]; not given: the rounding error of a weight
        where gradients do not vanish with the weight."""
        if part is None:
            smooth = self.basis.steepness is not None
            part = 0.0 if smooth else 16 * np.finfo(float).eps * max(cells)
        lightest = min((body.material.density * body.V0).min() for body in bodies)
        return float(part * lightest)

    def start(self, dt):
        """Write the impulse of the first step, of length dt [s]."""
        for group in self.particles.groups:
            update_stress(self.particles, group, self.grid, self.transfer, 0.0, dt)

    def step(self, dt, choose_dt):
        """Advance by dt [s]; returns the length of the next step, choose_dt(speed)."""
        clear(self.grid)
        p2g(self.particles, self.grid, self.basis, self.transfer)
        grid_update(self.grid, self.walls, self.gravity, dt)
        speed = sqrt(self.grid.speed_squared)
        dt_next = choose_dt(speed)
        g2p(self.particles, self.grid, self.basis, self.transfer)
        for group in self.particles.groups:
            update_stress(self.particles, group, self.grid, self.transfer, dt, dt_next)
        return dt_next
