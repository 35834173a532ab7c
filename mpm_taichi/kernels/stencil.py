"""Walking a stencil by lines: a line is the `support` nodes along the last axis, side by side.

Lines are unrolled.  With loops over them the kernels of a 3D scene compile in 1 to 3 s less, once,
before Taichi's cache has them; but P2G and G2P work on memory where they had registers, and a step
takes 5 % longer with quadratic MLS, 28 % with APIC, 33 % with cubic MLS.  That pays for less than
some 10^7 particle-steps, and would make the last bits depend on the length of a run."""

import taichi as ti

from ..runtime import Template


@ti.func
def index(grid: Template, i):
    """Linear index of node i (a multi-index), masked."""
    linear = 0
    for d in ti.static(range(grid.dim)):
        linear += i[d] * grid.strides[d]
    return linear & grid.mask


@ti.func
def offset(grid: Template, lead: Template):
    """Distance in memory of a line from the first node of its stencil."""
    linear = 0
    for d in ti.static(range(grid.dim - 1)):
        linear += lead[d] * grid.strides[d]
    return linear


@ti.func
def grid_coordinate(x, grid: Template):
    """xi = x / dx, counted from the first ghost node."""
    return x * grid.constants[None].inv_dx + ti.cast(grid.ghost, float)


@ti.func
def bend_at_walls(w: Template, base, grid: Template, basis: Template):
    """The weights (or slopes) w of a node behind a wall go to the two nodes before it, as if
    v_-1 = 2 v_0 - v_1 (bases/quadratic_boundary.py)."""
    last = ti.static(basis.support - 1)
    for axis, upper in ti.static(grid.walled):
        behind, wall, before = ti.static((last, last - 1, last - 2) if upper else (0, 1, 2))
        edge = ti.static(grid.ghost + (grid.cells[axis] + 1 - last if upper else -1))
        if base[axis] == edge:
            w[wall, axis] += 2.0 * w[behind, axis]
            w[before, axis] -= w[behind, axis]
            w[behind, axis] = 0.0


@ti.func
def first_node(x, grid: Template, basis: Template):
    """First node of the stencil of a particle at x, a multi-index; with a modified basis it has at
    most one node behind a wall."""
    base = basis.first(grid_coordinate(x, grid))
    if ti.static(basis.modified):
        for axis, upper in ti.static(grid.walled):
            if ti.static(upper):
                base[axis] = ti.min(base[axis], grid.ghost + grid.cells[axis] + 2 - basis.support)
    return base


@ti.func
def weigh(p, particles: Template, grid: Template, basis: Template):
    """First node of the stencil of particle p, a = xi - that node, weights w, slopes dw [k, d]."""
    return weigh_at(particles.x[p], p, particles, grid, basis)


@ti.func
def weigh_at(x, p, particles: Template, grid: Template, basis: Template):
    """As if the particle were at x."""
    base = first_node(x, grid, basis)
    a = grid_coordinate(x, grid) - base
    half = 0.0
    if ti.static(basis.extended):
        half = particles.half_width[p]
    w, dw = basis.weights(a, half), basis.slopes(a, half)
    if ti.static(basis.modified):
        bend_at_walls(w, base, grid, basis)
        bend_at_walls(dw, base, grid, basis)
    return base, a, w, dw


@ti.func
def moment(w, a):
    """D of each axis, sum_k w_k (k - a)^2 [dx^2]."""
    D = 0.0 * a
    for k in ti.static(range(w.n)):
        for d in ti.static(range(w.m)):
            D[d] += w[k, d] * (k - a[d]) ** 2
    return D


@ti.func
def line_weight(w, lead: Template):
    """Product of the weights of the leading axes."""
    weight = 1.0
    for d in ti.static(range(w.m - 1)):
        weight *= w[lead[d], d]
    return weight


@ti.func
def line_slope(w, dw, lead: Template, axis: Template):
    """Derivative of `line_weight` along a leading axis [1/cell]."""
    slope = 1.0
    for d in ti.static(range(w.m - 1)):
        slope *= dw[lead[d], d] if ti.static(d == axis) else w[lead[d], d]
    return slope
