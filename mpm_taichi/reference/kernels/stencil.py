"""The nodes that a particle touches."""

from itertools import product

import numpy as np


def stencil(x, grid, basis):
    """For each node i of the stencil of a particle at x: i, x_i - x [m], w_i, grad w_i [1/m]."""
    xi = x / grid.dx + grid.ghost
    base = basis.first(xi)
    w, dw = basis.weights(xi - base), basis.slopes(xi - base)
    axes = range(grid.dim)
    for o in product(range(basis.support), repeat=grid.dim):
        i = base + o
        weight = np.prod([w[o[d], d] for d in axes])
        gradient = [np.prod([(dw if e == d else w)[o[e], e] for e in axes]) for d in axes]
        yield tuple(i), (i - xi) * grid.dx, weight, np.array(gradient) / grid.dx
