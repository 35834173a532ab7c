"""The nodes that a particle touches."""

from itertools import product

import numpy as np


def bend_at_walls(w, base, grid, basis):
    """The weights (or slopes) w of a node behind a wall go to the two nodes before it, as if
    v_-1 = 2 v_0 - v_1 (bases/quadratic_boundary.py)."""
    for axis, upper in grid.walled:
        wall = grid.ghost + (grid.cells[axis] if upper else 0)
        outward = 1 if upper else -1
        k = wall + outward - base[axis]
        if 0 <= k < len(w):
            w[k - outward, axis] += 2 * w[k, axis]
            w[k - 2 * outward, axis] -= w[k, axis]
            w[k, axis] = 0.0


def first_node(x, grid, basis):
    """First node of the stencil of a particle at x, a multi-index; with a modified basis it has at
    most one node behind a wall."""
    base = basis.first(x / grid.dx + grid.ghost)
    if basis.modified:
        for axis, upper in grid.walled:
            if upper:
                base[axis] = min(base[axis], grid.ghost + grid.cells[axis] + 2 - basis.support)
    return base


def weigh(p, particles, grid, basis):
    """First node of the stencil of particle p, a = xi - that node, weights w, slopes dw [k, d]."""
    return weigh_at(particles.x[p], p, particles, grid, basis)


def weigh_at(x, p, particles, grid, basis):
    """As if the particle were at x."""
    base = first_node(x, grid, basis)
    a = x / grid.dx + grid.ghost - base
    half = particles.half_width[p]
    w, dw = basis.weights(a, half), basis.slopes(a, half)
    if basis.modified:
        bend_at_walls(w, base, grid, basis)
        bend_at_walls(dw, base, grid, basis)
    return base, a, w, dw


def moment(w, a):
    """D of each axis, sum_k w_k (k - a)^2 [dx^2]."""
    return sum(w[k] * (k - a) ** 2 for k in range(len(w)))


def stencil(p, particles, grid, basis):
    """For each node i of the stencil of particle p: i, x_i - x [m], w_i, grad w_i [1/m]."""
    yield from stencil_at(particles.x[p], p, particles, grid, basis)


def stencil_at(x, p, particles, grid, basis):
    """As if the particle were at x."""
    base, a, w, dw = weigh_at(x, p, particles, grid, basis)
    axes = range(grid.dim)
    for o in product(range(basis.support), repeat=grid.dim):
        weight = np.prod([w[o[d], d] for d in axes])
        gradient = [np.prod([(dw if e == d else w)[o[e], e] for e in axes]) for d in axes]
        yield tuple(base + o), (o - a) * grid.dx, weight, np.array(gradient) / grid.dx
