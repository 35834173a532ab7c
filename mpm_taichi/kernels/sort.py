"""Stage 0, when due: counting sort of each material by the first node of the stencil."""

import numpy as np
import taichi as ti

from ..runtime import Array, Template
from ..stages import stage
from .blocks import CHUNK
from .ghosts import periodic_image
from .stencil import first_node, index
from .tiles import list_tiles, segment_of


@ti.func
def cell(p, particles: Template, grid: Template, basis: Template):
    return index(grid, first_node(particles.x[p], grid, basis))


@ti.kernel
def find_order(particles: Template, grid: Template, basis: Template, g: int, begin: int, end: int):
    """order[new place] = old place, and start[g, segment].  Serial on a CPU: equal cells keep their
    order, whatever the number of threads.  On a GPU each chunk takes the next places that are free.

    The first group forgets what the last sort has found.  Cells are counted, but only chunks with
    particles are looked at again."""
    ti.loop_config(serialize=not grid.atomic)
    for chunk in range(grid.chunks):
        if g == 0:
            grid.occupied[chunk] = 0
    ti.loop_config(serialize=True)
    for _ in range(1):
        for s in range(grid.segments + 1):
            grid.start[g, s] = 0
        for d in ti.static(range(grid.dim)):
            if g == 0:
                grid.lowest[None][d] = grid.nodes
                grid.highest[None][d] = 0
    ti.loop_config(serialize=not grid.atomic)
    for p in range(begin, end):
        base = first_node(particles.x[p], grid, basis)
        i = index(grid, base)
        grid.count[i] += 1
        grid.occupied[i // CHUNK] = 1
        for d in ti.static(range(grid.dim)):
            ti.atomic_min(grid.lowest[None][d], base[d])
            ti.atomic_max(grid.highest[None][d], base[d])
        if ti.static(not grid.atomic):
            grid.start[g, segment_of(base, grid)] += 1
    ti.loop_config(serialize=True)
    for _ in range(1):
        grid.placed[None] = begin
        if ti.static(not grid.atomic):
            total = begin
            for s in range(grid.segments):
                inside = grid.start[g, s]
                grid.start[g, s] = total
                total += inside
            grid.start[g, grid.segments] = end
    ti.loop_config(serialize=not grid.atomic)
    for chunk in range(grid.chunks):
        if grid.occupied[chunk]:
            inside = 0
            for i in range(chunk * CHUNK, (chunk + 1) * CHUNK):
                inside += grid.count[i]
            place = ti.atomic_add(grid.placed[None], inside)
            for i in range(chunk * CHUNK, (chunk + 1) * CHUNK):
                here = grid.count[i]
                grid.count[i] = place
                place += here
    ti.loop_config(serialize=not grid.atomic)
    for p in range(begin, end):
        place = ti.atomic_add(grid.count[cell(p, particles, grid, basis)], 1)
        particles.order[place] = p
    ti.loop_config(serialize=not grid.atomic)
    for chunk in range(grid.chunks):
        if grid.occupied[chunk]:
            for i in range(chunk * CHUNK, (chunk + 1) * CHUNK):
                grid.count[i] = 0


@ti.func
def move(from_field: Template, i, to_field: Template, j):
    """Element i of one field to element j of another, or all records of a particle."""
    if ti.static(len(from_field.shape) > 1):
        for r in ti.static(range(from_field.shape[1])):
            to_field[j, r] = from_field[i, r]
    else:
        to_field[j] = from_field[i]


@ti.kernel
def permute(particles: Template):
    """field[p] <- field[order[p]] of all that is carried.  Fields that share a scratch take turns:
    a loop brings back what the one before it has taken, and takes the next."""
    for brought, taken in ti.static(particles.turns):
        for p in range(particles.count):
            for field, scratch, begin in ti.static(brought):
                if begin <= p and p < begin + field.shape[0]:
                    move(scratch, p - begin, field, p - begin)
            for field, scratch, begin in ti.static(taken):
                if begin <= p and p < begin + field.shape[0]:
                    move(field, particles.order[p] - begin, scratch, p - begin)


@ti.func
def mark_around(chunk, grid: Template):
    """The chunks that particles reach whose stencil begins in this one: with a cell of drift from 1
    node before it to `support` nodes behind it, along each axis."""
    for lead in ti.grouped(ti.ndrange(*[(-1, grid.support + 1)] * (grid.dim - 1))):
        first = chunk * CHUNK - 1
        last = (chunk + 1) * CHUNK - 1 + grid.support
        for d in ti.static(range(grid.dim - 1)):
            first += lead[d] * grid.strides[d]
            last += lead[d] * grid.strides[d]
        for near in range(ti.max(first, 0) // CHUNK, ti.min(last, grid.nodes - 1) // CHUNK + 1):
            grid.reached[near] = 1


@ti.func
def mark_images(chunk, axis: Template, grid: Template):
    """The chunks where a periodic axis has the images of ghost nodes in this one."""
    stride, ghosts, end = ti.static(grid.strides[axis], grid.ghost, grid.ghost + grid.cells[axis])
    for i in range(chunk * CHUNK, ti.min((chunk + 1) * CHUNK, grid.nodes)):
        k = i // stride % grid.extent[axis]
        if k < ghosts or (k >= end and k < grid.shape[axis]):
            image = i + (periodic_image(k, axis, grid) - k) * stride
            grid.reached[image // CHUNK] = 1


@ti.kernel
def plan(particles: Template, grid: Template, reach: Array):
    """From occupied: reached and active.  From start[group, segment]: the tiles.  For the host:
    reach = [active_count, lowest, highest]."""
    for a in range(grid.active_count[None]):
        grid.reached[grid.active[a]] = 0
    ti.loop_config(serialize=not grid.atomic)
    for chunk in range(grid.chunks):
        if grid.occupied[chunk]:
            mark_around(chunk, grid)
    for axis in ti.static(grid.periodic):  # in the order in which ghosts are folded
        ti.loop_config(serialize=not grid.atomic)
        for chunk in range(grid.chunks):
            if grid.reached[chunk]:
                mark_images(chunk, axis, grid)
    grid.active_count[None] = 0
    ti.loop_config(serialize=not grid.atomic)
    for chunk in range(grid.chunks):
        if grid.reached[chunk]:
            grid.active[ti.atomic_add(grid.active_count[None], 1)] = chunk
    ti.loop_config(serialize=True)
    for _ in range(1):
        if ti.static(not grid.atomic):
            list_tiles(particles, grid)
        reach[0] = grid.active_count[None]
        for d in ti.static(range(grid.dim)):
            reach[1 + d] = grid.lowest[None][d]
            reach[1 + grid.dim + d] = grid.highest[None][d]


@stage
def sort(particles, grid, basis):
    """On return the particles of each material lie in the order of their cells, `grid.start` says
    where each segment begins, `grid.tile` lists the tiles and `grid.active` the chunks of nodes
    that particles can reach before one of them has moved a cell."""
    for g, group in enumerate(particles.groups):
        find_order(particles, grid, basis, g, group.begin, group.end)
    permute(particles)
    take_up(particles, grid)


def take_up(particles, grid):
    """What follows from what a sort has found, also where that was put back into the fields."""
    reach = np.zeros(1 + 2 * grid.dim, np.int32)
    plan(particles, grid, reach)
    grid.note_reach(int(reach[0]), reach[1 : 1 + grid.dim], reach[1 + grid.dim :])
