"""Walking a stencil by lines: a line is the `support` nodes along the last axis, side by side."""

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
