"""Stage 4: nodes to particles."""

import numpy as np

from .stencil import stencil
from .tally import note_particles


def g2p(particles, grid, basis, transfer, what="all", dt=0.0, tally=None):
    """v_p = sum_i w_ip v_i, B_p = sum_i w_ip v_i (x_i - x_p)^T, S_p = sum_i v_i grad w_ip^T, and
    with `transfer.increment` the change sum_i w_ip (v_i - v_i^old).  Of these `what` asks for "all"
    or for the "gradient" S_p; or it is the "residual" of a filter, R_p -= sum_i w_ip R_i.
    A `tally` has noted energy and supplies of the step, which is dt [s] long."""
    if what == "residual":
        for p in range(particles.count):
            for i, _, w, _ in stencil(p, particles, grid, basis):
                particles.R[p] -= w * grid.residual[i]
        return
    particles.S[:] = 0.0
    if what == "all":
        for field in (particles.v_pic, particles.dv, particles.B):
            field[:] = 0.0
    for p in range(particles.count):
        for i, r, w, dw in stencil(p, particles, grid, basis):
            particles.S[p] += np.outer(grid.v[i], dw)
            if what == "all":
                particles.v_pic[p] += w * grid.v[i]
                particles.B[p] += w * np.outer(grid.v[i], r)
                if transfer.increment:
                    particles.dv[p] += w * (grid.v[i] - grid.v_old[i])
    if tally:
        note_particles(particles, grid, basis, transfer, dt, tally)
