"""Stage 5: particles alone."""

import numpy as np


def update_stress(particles, group, grid, transfer, dt, dt_next):
    """H <- H + dt L (I + H), stress and state by the law, x <- x + dt sum_i w_ip v_i.

    On return A and T = - dt_next V0 tau are what P2G scatters; `particles.lost` is the least id of
    a particle outside the closed domain, or the number of particles."""
    c = group.constants
    for p in group.members:
        m, V0 = particles.m[p], particles.V0[p]
        v_pic = particles.v_pic[p]
        particles.v[p] = transfer.velocity(particles.v[p] + particles.dv[p], v_pic)
        C, L = transfer.gradients(particles.B[p], particles.S[p], grid.inverse_moment)
        H = particles.H[p]
        H_new, s, tau = group.law.update(c, H + dt * (L + L @ H), L, dt, group.state[p])
        particles.H[p], group.state[p] = H_new, s
        T = (-dt_next * V0) * tau
        particles.T[p] = T
        if transfer.affine:
            particles.A[p] = transfer.affine_momentum(m, C, T, grid.inverse_moment)
        x = particles.x[p] + dt * v_pic
        particles.x[p] = x
        if not ((x >= 0).all() and (x <= np.array(grid.cells) * grid.dx).all()):
            particles.lost = min(particles.lost, p)
