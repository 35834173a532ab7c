"""For the time step: whose speed and whose velocity gradient are the largest of all particles."""

import numpy as np

from .stencil import stencil_at


def fastest(particles, grid, basis, transfer, dt):
    """The largest |sum_i w_ip v_i|^2 and whose it is, and the largest |L|^2 and whose that is, of
    the step of dt [s] that has just been taken: gathered once more where particles were before."""
    speeds = (particles.v_pic**2).sum(axis=1)
    rates = np.zeros(particles.count)
    for p in range(particles.count):
        B = S = np.zeros((grid.dim, grid.dim))
        for i, r, w, dw in stencil_at(
            particles.x[p] - dt * particles.v_pic[p], p, particles, grid, basis
        ):
            B = B + w * np.outer(grid.v[i], r)
            S = S + np.outer(grid.v[i], dw)
        rates[p] = (transfer.gradients(B, S, grid.inverse_moment)[1] ** 2).sum()
    fastest, steepest = int(speeds.argmax()), int(rates.argmax())
    return float(speeds[fastest]), fastest, float(rates[steepest]), steepest
