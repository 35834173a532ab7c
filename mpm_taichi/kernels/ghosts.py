"""Stages 2b and 3b: nodes behind a wall are mirror images, and a periodic axis closes on itself.

A wall reflects: with k the distance from the wall in nodes and v_n the velocity across it,
v_n(-k) = - v_n(k) and v_t(-k) = +- v_t(k), + where the rule lets material slide.  So what particles
give to node -k belongs to node k, as if mirrored matter lay behind the wall; at k = 0 the rule
itself acts (kernels/grid_update.py).  Zeroed nodes instead make a clamped beam too long and let a
gas at rest stream.  A wall that material may leave reflects only where its node is pressed on it.

The axes are folded one after the other over whole planes, ghost nodes included: corners come right.
"""

import taichi as ti

from ..runtime import Template
from ..stages import stage
from .blocks import CHUNK, blocks_of, first_block


@ti.func
def line_start(j, axis: Template, grid: Template):
    """First node of line j along an axis."""
    i = 0
    for e in ti.static(range(grid.dim)):
        if ti.static(e != axis):
            i += (j % grid.shape[e]) * grid.strides[e]
            j = j // grid.shape[e]
    return i


@ti.func
def is_active(i, grid: Template):
    """Whether the node was cleared in this step; others hold what an earlier one has left."""
    return grid.reached[i // CHUNK] == 1


@ti.func
def periodic_image(k, axis: Template, grid: Template):
    """Of node k along a periodic axis, which may have fewer cells than ghost nodes."""
    cells, ghosts = ti.static(grid.cells[axis], grid.ghost)
    return (k - ghosts + cells * ghosts) % cells + ghosts


@ti.func
def reflected(lanes, grid: Template, wall: Template):
    """The record of a node's mirror image behind a wall."""
    for d in ti.static(range(grid.dim)):
        if ti.static(d == wall.axis or wall.rule.holds):
            lanes[d] = -lanes[d]
    return lanes


@ti.func
def is_pressed(i, grid: Template, wall: Template, gravity: Template, dt, updated: Template):
    """Whether the wall node i moves into the wall, or stands: before the grid update judged by its
    momentum and impulses, after it by its velocity."""
    lanes = grid.node[i]
    across = lanes[wall.axis]
    if ti.static(not updated):
        across += dt * gravity[None][wall.axis] * lanes[grid.dim]
        if ti.static(grid.increment):
            across += grid.node[i + grid.apart][wall.axis]
    return (across >= 0.0) if ti.static(wall.upper) else (across <= 0.0)


@ti.func
def exchange(ghost, image, grid: Template, wall: Template, fill: Template, records: Template):
    """Between a ghost node and its image: fill the ghost, or give what it has to the image."""
    if is_active(ghost, grid):
        for record in ti.static(records):
            there, here = ghost + record * grid.apart, image + record * grid.apart
            lanes = grid.node[here if ti.static(fill) else there]
            if ti.static(wall):
                lanes = reflected(lanes, grid, wall)
            if ti.static(fill):
                grid.node[there] = lanes
            else:
                grid.node[here] = grid.node[here] + lanes
                grid.node[there] = ti.Vector.zero(float, 4)


@ti.func
def exchange_along(
    j, axis: Template, grid: Template, walls: Template, gravity: Template, dt,
    updated: Template, fill: Template, records: Template,
):  # fmt: skip
    """All ghost nodes of line j along an axis."""
    start = line_start(j, axis, grid)
    stride, cells, ghosts = ti.static(grid.strides[axis], grid.cells[axis], grid.ghost)
    if ti.static(axis in grid.periodic):
        for ghost in range(grid.shape[axis] - cells):
            k = ghost if ghost < ghosts else ghost + cells
            image = periodic_image(k, axis, grid)
            exchange(start + k * stride, start + image * stride, grid, None, fill, records)
    for wall in ti.static([wall for wall in walls if wall.axis == axis]):
        at_wall = start + ti.static((ghosts + cells * wall.upper) * stride)
        outward = ti.static(stride if wall.upper else -stride)
        if not wall.rule.lets_go or is_pressed(at_wall, grid, wall, gravity, dt, updated):
            for k in range(1, ghosts):
                exchange(at_wall + k * outward, at_wall - k * outward, grid, wall, fill, records)


@ti.func
def exchange_share(
    axis: Template, grid: Template, walls: Template, gravity: Template, dt,
    updated: Template, fill: Template, records: Template, lines, worker, workers,
):  # fmt: skip
    blocks = blocks_of(lines, grid.block)
    for block in range(
        first_block(worker, workers, blocks), first_block(worker + 1, workers, blocks)
    ):
        first = block * grid.block
        for j in range(first, ti.min(first + grid.block, lines)):
            exchange_along(j, axis, grid, walls, gravity, dt, updated, fill, records)


@ti.kernel
def exchange_lines(
    axis: Template, grid: Template, walls: Template, gravity: Template, dt: float,
    updated: Template, fill: Template, records: Template, lines: int, workers: int,
):  # fmt: skip
    for counter in range(grid.gate * workers):
        if counter % grid.gate == 0:
            exchange_share(
                axis, grid, walls, gravity, dt, updated, fill, records, lines,
                counter // grid.gate, workers,
            )  # fmt: skip


def exchange_all(grid, walls, gravity, dt, updated, fill, records):
    for axis in grid.folded:
        if grid.is_near_end(axis):
            lines = grid.lines_along[axis]
            exchange_lines(
                axis, grid, walls, gravity, dt, updated, fill, records, lines, grid.workers(lines)
            )  # fmt: skip


@stage
def fold_ghosts(grid, walls, gravity, dt, updated=False):
    """On return ghost nodes are empty, and what they had been given is with their images: before
    the grid update in all records, after it (`updated`) in the second one."""
    records = (1,) if updated else grid.records
    exchange_all(grid, walls, gravity, dt, updated, False, records)


@stage
def fill_ghosts(grid, walls, gravity):
    """After the grid update.  On return ghost nodes are images of the nodes inside."""
    exchange_all(grid, walls, gravity, 0.0, True, True, grid.records)
