"""Nodes too light for the step, where the slopes of a basis stay while its weights go to 0."""

from itertools import product

import numpy as np

from .clear import clear
from .ghosts import exchange_all
from .stencil import weigh


def slivers(particles, grid, basis, transfer, walls, gravity, dt):
    """How many nodes have dt^2 k_i > 2 m_i, or 4 m_i where particles carry their affine velocity,
    with k_i = max_d sum_p V0_p rho0 c_p^2 (dw_d)^2 prod_(e != d) w_e; those aside that the mass
    cut-off takes as empty."""
    clear(grid)
    k = np.zeros((grid.dim, *grid.shape))
    for group in particles.groups:
        for p in group.members:
            wave, _lone = group.law.moduli(group.constants, particles.H[p], group.state[p])
            base, _, w, dw = weigh(p, particles, grid, basis)
            for o in product(range(basis.support), repeat=grid.dim):
                i = tuple(base + o)
                weights = np.array([w[o[d], d] for d in range(grid.dim)])
                grid.m[i] += weights.prod() * particles.m[p]
                for d in range(grid.dim):
                    stiffness = particles.V0[p] * wave * (dw[o[d], d] / grid.dx) ** 2
                    k[d][i] += stiffness * np.delete(weights, d).prod()
    exchange_all(grid, walls, gravity, 0.0, False, False, (*k, grid.m))
    bound = (4 if transfer.affine else 2) / dt**2
    return int(((grid.m > grid.mass_cutoff) & (k.max(axis=0) > bound * grid.m)).sum())
