"""Stage 4b, of filtered transfers: take away the velocities that the nodes do not see."""

from .g2p import g2p
from .ghosts import fill_ghosts, fold_ghosts
from .p2g import p2g


def average(grid, empty):
    """Residual momentum to velocity at the nodes, or nothing at all."""
    occupied = grid.m > (float("inf") if empty else grid.mass_cutoff)
    grid.residual[occupied] /= grid.m[occupied][:, None]
    grid.residual[~occupied] = 0.0


def take_residual(particles, grid, basis, transfer, walls, gravity, order):
    """R <- (1 - S S+) R, order - 1 times, from R = v_FLIP - sum_i w_ip v_i = (1 - S S+) v_old.

    On return the change dv of the velocity has lost R."""
    particles.R[:] = particles.v + particles.dv - particles.v_pic
    for _ in range(order - 1):
        average(grid, True)
        p2g(particles, grid, basis, transfer, "residual")
        fold_ghosts(grid, walls, gravity, 0.0, updated=True)
        average(grid, False)
        fill_ghosts(grid, walls, gravity)
        g2p(particles, grid, basis, transfer, "residual")
    particles.dv -= particles.R
