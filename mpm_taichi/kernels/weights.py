"""For display: the nodes that each particle touches, and with what weight."""

import numpy as np
import taichi as ti

from ..runtime import Array, Template
from .stencil import weigh


@ti.kernel
def weigh_particles(particles: Template, grid: Template, basis: Template, table: Array):
    """Row id of the table: first node, w, dw."""
    dim, count = ti.static(grid.dim, basis.support * grid.dim)
    for p in range(particles.count):
        base, _a, w, dw = weigh(p, particles, grid, basis)
        id = particles.id[p]
        for d in ti.static(range(dim)):
            table[id, d] = base[d]
            for k in ti.static(range(basis.support)):
                table[id, dim + k * dim + d] = w[k, d]
                table[id, dim + count + k * dim + d] = dw[k, d]


def weights(particles, grid, basis):
    """First node of the stencil [n, dim], a multi-index that counts ghost nodes; and of each axis
    weights w [n, support, dim] and slopes dw [n, support, dim] (per cell), in the order of the
    scene."""
    n, dim, count = particles.count, grid.dim, basis.support * grid.dim
    table = np.zeros((n, dim + 2 * count), particles.dtype)
    weigh_particles(particles, grid, basis, table)
    base = table[:, :dim].astype(int)
    w, dw = table[:, dim:].astype(float).reshape(n, 2, basis.support, dim).swapaxes(0, 1)
    return base, w, dw
