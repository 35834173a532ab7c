"""Stage 1: empty the nodes."""

import taichi as ti

from ..runtime import Template
from ..stages import stage
from .blocks import active_blocks, first_active_node, first_block


@ti.func
def clear_node(i, grid: Template):
    grid.node[i] = ti.Vector.zero(float, 4)
    if ti.static(len(grid.records) > 1):
        grid.node[i + grid.apart] = ti.Vector.zero(float, 4)


@ti.func
def clear_share(grid: Template, worker, workers):
    blocks = active_blocks(grid)
    for block in range(
        first_block(worker, workers, blocks), first_block(worker + 1, workers, blocks)
    ):
        first = first_active_node(block, grid)
        for i in range(first, first + grid.node_block):
            clear_node(i, grid)


@ti.kernel
def clear_nodes(grid: Template, workers: int):
    grid.speed_squared[None] = 0.0
    grid.rate_squared[None] = 0.0
    grid.compression[None] = 0.0
    for counter in range(grid.gate * workers):
        if counter % grid.gate == 0:
            clear_share(grid, counter // grid.gate, workers)


@stage
def clear(grid):
    """On return every node that a particle can reach is zero, and so are the largest speed and
    rate."""
    clear_nodes(grid, grid.node_workers)
