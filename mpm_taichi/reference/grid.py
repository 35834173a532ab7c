"""Nodes of a box of cells, with ghost nodes as wide as the stencil around it."""

import numpy as np


class Grid:
    """m [kg], mv [kg m/s], impulse [kg m/s], v_old and v [m/s] of node i at (i - ghost) dx;
    of an audit, the momentum without the stress in it, `given`."""

    def __init__(self, cells, dx, basis, mass_cutoff, walls, periodic):
        self.dim, self.cells, self.dx = len(cells), tuple(cells), dx
        self.ghost = basis.support
        self.periodic = tuple(periodic)
        self.walled = tuple((wall.axis, wall.upper) for wall in walls)
        mirrors = basis.support > 2 and not basis.modified
        self.folded = tuple(sorted({*self.periodic, *(wall.axis for wall in walls if mirrors)}))
        self.inverse_moment = (basis.inverse_moment or 1.0) / dx**2
        self.mass_cutoff = mass_cutoff
        self.shape = tuple(n + 1 + 2 * self.ghost for n in cells)
        self.m = np.zeros(self.shape)
        self.mv, self.impulse, self.v_old, self.v = np.zeros((4, *self.shape, self.dim))
        self.residual, self.given = np.zeros((2, *self.mv.shape))
        self.speed_squared, self.rate_squared, self.compression = 0.0, 0.0, 0.0
        self.cut = 0
