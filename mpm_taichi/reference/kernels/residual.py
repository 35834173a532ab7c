"""Stage 4b, of filtered transfers: take away the velocities that the nodes do not see."""

import numpy as np

from .g2p import g2p
from .ghosts import fill_ghosts, fold_ghosts
from .grid_update import apply_walls
from .p2g import p2g


def average(grid, walls, empty):
    """Residual momentum to velocity at the nodes, which a wall holds as it holds that of the
    particles; or nothing at all."""
    for i in np.ndindex(grid.shape):
        if grid.m[i] > grid.mass_cutoff and not empty:
            grid.residual[i] = apply_walls(grid.residual[i] / grid.m[i], i, grid, walls)
        else:
            grid.residual[i] = 0.0


def take_residual(particles, grid, basis, transfer, walls, gravity, order):
    """R <- (1 - S S+) R, order - 1 times, from R = v_FLIP - sum_i w_ip v_i = (1 - S S+) v_old.

    On return the change dv of the velocity has lost R."""
    firm = tuple(wall for wall in walls if not wall.rule.lets_go)
    particles.R[:] = particles.v + particles.dv - particles.v_pic
    for _ in range(order - 1):
        average(grid, firm, True)
        p2g(particles, grid, basis, transfer, "residual")
        fold_ghosts(grid, walls, gravity, 0.0, updated=True)
        average(grid, firm, False)
        fill_ghosts(grid, walls, gravity)
        g2p(particles, grid, basis, transfer, "residual")
    particles.dv -= particles.R
