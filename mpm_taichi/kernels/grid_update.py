"""Stage 3: momentum to velocity, gravity, walls."""

import taichi as ti

from ..runtime import Template
from ..stages import stage
from .blocks import active_blocks, first_active_node, first_block
from .tally import NoTally, before_forces, note_cut_node, note_node


@ti.func
def apply_walls(v, i, grid: Template, walls: Template):
    """The rule of each wall acts at its nodes; those behind it are images (kernels/ghosts.py)."""
    for wall in ti.static(walls):
        i_d = i // grid.strides[wall.axis] % grid.extent[wall.axis] - grid.ghost
        n = ti.Vector.unit(grid.dim, wall.axis, float)
        if ti.static(wall.upper):
            if i_d == grid.cells[wall.axis]:
                v = wall.rule.velocity(v, -n)
        elif i_d == 0:
            v = wall.rule.velocity(v, n)
    return v


@ti.func
def update_node(i, grid: Template, walls: Template, gravity: Template, dt, tally: Template, row):
    lanes = grid.node[i]
    mass = lanes[grid.dim]
    v = ti.Vector.zero(float, grid.dim)
    if mass > 0:
        v_old = v
        if mass > grid.constants[None].mass_cutoff:
            v_old = ti.Vector([lanes[d] / mass for d in range(grid.dim)])
            v = v_old + dt * gravity[None]
            if ti.static(grid.increment):
                v += ti.Vector([grid.node[i + grid.apart][d] / mass for d in range(grid.dim)])
            v = apply_walls(v, i, grid, walls)
            if ti.static(tally.is_on):
                given = before_forces(i, v_old, grid)
                note_node(i, given, apply_walls(given, i, grid, walls), v, grid, tally, row)
            v_old = apply_walls(v_old, i, grid, walls)
        else:
            if ti.static(tally.is_on):
                note_cut_node(i, gravity, dt, grid, tally, row)
            ti.atomic_add(grid.cut[None], 1)
        for d in ti.static(range(grid.dim)):
            lanes[d] = v[d]
        grid.node[i] = lanes
        if ti.static(grid.increment):
            for d in ti.static(range(grid.dim)):
                grid.node[i + grid.apart][d] = v[d] - v_old[d]


@ti.func
def update_share(
    grid: Template, walls: Template, gravity: Template, dt, tally: Template, worker, workers
):
    blocks = active_blocks(grid)
    for block in range(
        first_block(worker, workers, blocks), first_block(worker + 1, workers, blocks)
    ):
        first = first_active_node(block, grid)
        for i in range(first, first + grid.node_block):
            update_node(i, grid, walls, gravity, dt, tally, block)


@ti.kernel
def update_nodes(
    grid: Template, walls: Template, gravity: Template, dt: float, tally: Template, workers: int
):
    for counter in range(grid.gate * workers):
        if counter % grid.gate == 0:
            update_share(grid, walls, gravity, dt, tally, counter // grid.gate, workers)


@stage
def grid_update(grid, walls, gravity, dt, tally=NoTally):
    """v_i = ((m v)_i + impulse_i) / m_i + dt g, then the rules of the walls, which hold for
    v_i^old = (m v)_i / m_i too: the velocity that a wall takes is no change of the motion.

    A node no heavier than the relative cut-off of its basis stands still and is counted in
    `grid.cut`.  On return a node holds (v, m), with `grid.increment` also v - v_old in the record
    apart; a `tally` has noted the energies."""
    update_nodes(grid, walls, gravity, dt, tally, grid.node_workers)
