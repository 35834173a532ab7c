"""Stage 4b, of filtered transfers: take away the velocities that the nodes do not see."""

import taichi as ti

from ..runtime import Template
from ..stages import stage
from .blocks import active_blocks, blocks_of, first_active_node, first_block
from .g2p import g2p
from .ghosts import fill_ghosts, fold_ghosts
from .grid_update import apply_walls
from .p2g import p2g
from .rows import put_vector, vector


@ti.func
def begin_or_end(p, particles: Template, dim: Template, end: Template):
    """m R = m (v_FLIP - sum_i w_i v_i), and when it has been filtered, m v = m v_FLIP - m R."""
    row = ti.static(particles.layout.residual)
    if ti.static(end):
        particles.rows[p, 0] = particles.rows[p, 0] - particles.rows[p, row]
    else:
        v_pic = vector(particles.rows, p, particles.layout.pic, dim)
        mv = vector(particles.rows, p, 0, dim)
        put_vector(particles.rows, p, row, mv - particles.m[p] * v_pic, 0.0)


@ti.kernel
def begin_or_end_all(particles: Template, grid: Template, end: Template, workers: int):
    for counter in range(grid.gate * workers):
        if counter % grid.gate == 0:
            worker, blocks = counter // grid.gate, blocks_of(particles.count, grid.block)
            for block in range(
                first_block(worker, workers, blocks), first_block(worker + 1, workers, blocks)
            ):
                first = block * grid.block
                for p in range(first, ti.min(first + grid.block, particles.count)):
                    begin_or_end(p, particles, grid.dim, end)


@ti.func
def average_node(i, grid: Template, walls: Template, empty: Template):
    mass = grid.node[i][grid.dim]
    lanes = ti.Vector.zero(float, 4)
    if not empty and mass > grid.constants[None].mass_cutoff:
        R = ti.Vector([grid.node[i + grid.apart][d] for d in range(grid.dim)])
        R = apply_walls(R / mass, i, grid, walls)
        for d in ti.static(range(grid.dim)):
            lanes[d] = R[d]
    grid.node[i + grid.apart] = lanes


@ti.kernel
def average(grid: Template, walls: Template, empty: Template, workers: int):
    """Residual momentum to velocity at the nodes, which a wall holds as it holds that of the
    particles; or nothing at all."""
    for counter in range(grid.gate * workers):
        if counter % grid.gate == 0:
            worker, blocks = counter // grid.gate, active_blocks(grid)
            for block in range(
                first_block(worker, workers, blocks), first_block(worker + 1, workers, blocks)
            ):
                first = first_active_node(block, grid)
                for i in range(first, first + grid.node_block):
                    average_node(i, grid, walls, empty)


@stage
def take_residual(particles, grid, basis, transfer, walls, gravity, order):
    """R <- (1 - S S+) R, order - 1 times, from R = v_FLIP - sum_i w_ip v_i = (1 - S S+) v_old.

    On return row 0 holds (m (v_FLIP - R), m)."""
    firm = tuple(wall for wall in walls if not wall.rule.lets_go)
    begin_or_end_all(particles, grid, False, grid.workers(particles.count))
    for _ in range(order - 1):
        average(grid, firm, True, grid.node_workers)
        p2g(particles, grid, basis, transfer, "residual")
        fold_ghosts(grid, walls, gravity, 0.0, updated=True)
        average(grid, firm, False, grid.node_workers)
        fill_ghosts(grid, walls, gravity)
        g2p(particles, grid, basis, transfer, "residual")
    begin_or_end_all(particles, grid, True, grid.workers(particles.count))
