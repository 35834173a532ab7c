"""Stage 4: nodes to particles."""

import numpy as np

from .stencil import stencil


def g2p(particles, grid, basis, transfer):
    """v_p = sum_i w_ip v_i, B_p = sum_i w_ip v_i (x_i - x_p)^T, S_p = sum_i v_i grad w_ip^T, and
    with `transfer.increment` the change sum_i w_ip (v_i - v_i^old)."""
    for field in (particles.v_pic, particles.dv, particles.B, particles.S):
        field[:] = 0.0
    for p in range(particles.count):
        for i, r, w, dw in stencil(particles.x[p], grid, basis):
            particles.v_pic[p] += w * grid.v[i]
            if transfer.increment:
                particles.dv[p] += w * (grid.v[i] - grid.v_old[i])
            particles.B[p] += w * np.outer(grid.v[i], r)
            particles.S[p] += np.outer(grid.v[i], dw)
