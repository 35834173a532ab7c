"""Stage 0, when due: counting sort of each material by the first node of the stencil."""

import taichi as ti

from ..runtime import Template
from ..stages import stage
from .stencil import first_node, index


@ti.func
def cell(p, particles: Template, grid: Template, basis: Template):
    return index(grid, first_node(particles.x[p], grid, basis))


@ti.kernel
def find_order(particles: Template, grid: Template, basis: Template, g: int, begin: int, end: int):
    """order[new place] = old place, and start[g, slab].  Serial on a CPU: equal cells keep their
    order, whatever the number of threads."""
    for i in grid.count:
        grid.count[i] = 0
    ti.loop_config(serialize=not grid.atomic)
    for p in range(begin, end):
        grid.count[cell(p, particles, grid, basis)] += 1
    ti.loop_config(serialize=True)
    for _ in range(1):
        total = begin
        for slab in range(grid.slabs):
            grid.start[g, slab] = total
            width = grid.slab * grid.strides[0]
            for i in range(slab * width, ti.min((slab + 1) * width, grid.nodes)):
                here = grid.count[i]
                grid.count[i] = total
                total += here
        grid.start[g, grid.slabs] = end
    ti.loop_config(serialize=not grid.atomic)
    for p in range(begin, end):
        place = ti.atomic_add(grid.count[cell(p, particles, grid, basis)], 1)
        particles.order[place] = p


@ti.kernel
def permute(field: Template, scratch: Template, order: Template, begin: int, width: Template):
    """field[i] <- field[order[begin + i] - begin]; `width` records per particle, 0 if 1-D."""
    for i in range(field.shape[0]):
        if ti.static(width):
            for r in ti.static(range(width)):
                scratch[i, r] = field[order[begin + i] - begin, r]
        else:
            scratch[i] = field[order[begin + i] - begin]
    for i in range(field.shape[0]):
        if ti.static(width):
            for r in ti.static(range(width)):
                field[i, r] = scratch[i, r]
        else:
            field[i] = scratch[i]


@ti.kernel
def plan(particles: Template, grid: Template):
    """From start[group, slab]: the `share` of each slab, and the `active` range of nodes."""
    ti.loop_config(serialize=True)
    for _ in range(1):
        before = 0
        grid.active[0] = grid.nodes
        grid.active[1] = 0
        for slab in range(grid.slabs):
            inside = 0
            for g in range(particles.group_count):
                inside += grid.start[g, slab + 1] - grid.start[g, slab]
            grid.share[slab] = (before + 0.5 * inside) / particles.count
            before += inside
            if (
                inside > 0
            ):  # drift and mirror images to the left; drift and the stencil to the right
                left, right = slab * grid.slab - grid.ghost, (slab + 2) * grid.slab
                if ti.static(0 in grid.periodic):
                    left, right = 0, grid.extent[0]
                grid.active[0] = ti.min(grid.active[0], ti.max(left, 0) * grid.strides[0])
                grid.active[1] = ti.min(right * grid.strides[0], grid.nodes)


@stage
def sort(particles, grid, basis):
    """On return the particles of each material lie in the order of their slabs and cells,
    `grid.start` says where each slab begins and `grid.active` which nodes they can reach before
    one of them has moved a cell."""
    for g, group in enumerate(particles.groups):
        find_order(particles, grid, basis, g, group.begin, group.end)
        if group.has_state:
            permute(group.state, group.scratch, particles.order, group.begin, 0)
    for field, scratch in particles.carried:
        permute(field, scratch, particles.order, 0, field.shape[1] if len(field.shape) > 1 else 0)
    plan(particles, grid)
