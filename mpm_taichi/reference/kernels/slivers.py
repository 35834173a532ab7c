"""Nodes too light for the step, where the slopes of a basis stay while its weights go to 0."""

import numpy as np

from .clear import clear
from .ghosts import exchange_all
from .stencil import stencil


def slivers(particles, grid, basis, transfer, walls, gravity, dt):
    """How many nodes have dt^2 k_i > 2 m_i, or 4 m_i where particles carry their affine velocity,
    with k_i = sum_p V0_p rho0 c_p^2 |grad w_ip|^2; those aside that the mass cut-off takes as
    empty."""
    clear(grid)
    k = np.zeros(grid.shape)
    for group in particles.groups:
        for p in group.members:
            wave, _lone = group.law.moduli(group.constants, particles.H[p], group.state[p])
            for i, _, w, dw in stencil(p, particles, grid, basis):
                k[i] += particles.V0[p] * wave * (dw**2).sum()
                grid.m[i] += w * particles.m[p]
    exchange_all(grid, walls, gravity, 0.0, False, False, (k, grid.m))
    bound = (4 if transfer.affine else 2) / dt**2
    return int(((grid.m > grid.mass_cutoff) & (k > bound * grid.m)).sum())
