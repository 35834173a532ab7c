"""Stage 1: empty the nodes."""

import taichi as ti

from ..runtime import Template
from ..stages import stage
from .blocks import BLOCK, first_block


@ti.func
def clear_node(i, grid: Template):
    grid.node[i] = ti.Vector.zero(float, 4)
    if ti.static(grid.increment):
        grid.node[i + grid.apart] = ti.Vector.zero(float, 4)


@ti.kernel
def clear_nodes(grid: Template, threads: int):
    grid.speed_squared[None] = 0.0
    if ti.static(grid.atomic):
        for i in range(grid.active[0], grid.active[1]):
            clear_node(i, grid)
    else:
        for counter in range(512 * threads):
            if counter % 512 == 0:
                begin, end = grid.active[0], grid.active[1]
                worker = counter // 512
                last = first_block(worker + 1, threads, end - begin)
                for block in range(first_block(worker, threads, end - begin), last):
                    start = begin + block * BLOCK
                    for i in range(start, ti.min(start + BLOCK, end)):
                        clear_node(i, grid)


@stage
def clear(grid):
    """On return every node that a particle can reach is zero."""
    clear_nodes(grid, grid.threads)
