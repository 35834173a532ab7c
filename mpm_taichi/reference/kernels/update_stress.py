"""Stage 5: particles alone."""

import numpy as np

from .tally import note_stress


def note_if_lost(p, x, particles, grid):
    kept = [d for d in range(grid.dim) if d not in grid.periodic]
    size = np.array(grid.cells) * grid.dx
    if not ((x >= 0) & (x <= size))[kept].all():
        particles.lost = min(particles.lost, p)


def update_stress(
    particles, group, grid, transfer, dt, dt_next, alpha=1.0, velocity=True, stress=True, move=True,
    tally=None,
):  # fmt: skip
    """Velocity and affine momentum from what was gathered, alpha being the FLIP part of a blend;
    H <- H + dt L (I + H), stress and state by the law; x <- x + dt sum_i w_ip v_i.

    On return A and T = - dt_next V0 tau are what P2G scatters; `particles.lost` is the least id of
    a particle outside the closed domain, or the number of particles; the grid has the largest |L|^2
    and - tr L that have strained particles, and once these have moved the largest
    |sum_i w_ip v_i|^2.  A `tally` has noted the work of the stress."""
    c = group.constants
    for p in group.members:
        L = particles.S[p]
        C, T = 0 * L, 0 * L
        if velocity:
            v_pic = particles.v_pic[p]
            particles.v[p] = transfer.velocity(particles.v[p] + particles.dv[p], v_pic, alpha)
            C, L = transfer.gradients(particles.B[p], particles.S[p], grid.inverse_moment)
        if stress:
            H = particles.H[p]
            H_new, s, tau = group.law.update(c, H + dt * (L + L @ H), L, dt, group.state[p])
            particles.H[p], group.state[p] = H_new, s
            T = (-dt_next * particles.V0[p]) * tau
            particles.T[p] = T
            grid.rate_squared = max(grid.rate_squared, (L**2).sum())
            grid.compression = max(grid.compression, -L.trace())
            if tally:
                note_stress(p, L, particles.V0[p] * tau, dt, particles, tally)
        if velocity and transfer.affine:
            m = particles.m[p]
            particles.A[p] = transfer.affine_momentum(m, C, T, grid.inverse_moment)
            particles.free_A[p] = transfer.affine_momentum(m, C, 0 * T, grid.inverse_moment)
        if move:
            particles.x[p] = particles.x[p] + dt * particles.v_pic[p]
            grid.speed_squared = max(grid.speed_squared, (particles.v_pic[p] ** 2).sum())
            note_if_lost(p, particles.x[p], particles, grid)
