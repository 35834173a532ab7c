"""Nodes too light for the step, where the slopes of a basis stay while its weights go to 0.

Under USL a node i keeps no velocity from one step to the next: the strain that it makes goes by
1 - dt^2 k_i / m_i a step, and grows for

    dt^2 k_i > 2 m_i    (4 m_i where particles carry their affine velocity).

Where the nodes of a plane across axis d move together, as at the face of a body, their weights
along the other axes sum to 1, and k_i = sum_p V0_p rho0 c_p^2 (dw_d)^2 prod_(e != d) w_e, with w_e
and dw_d of node i along one axis: of the axes the worst counts.  There and for one particle that is
the limit of numerics.md, 4.1, dt^2 H rho0 c^2 > 2 rho, with H = 1 / w for a small weight w.  Inside
a body k_i / m_i is 2 (c / dx)^2, which no step comes near to."""

import taichi as ti

from ..runtime import Template
from .blocks import active_blocks, first_active_node, first_block
from .clear import clear
from .ghosts import fold_ghosts
from .p2g import add
from .stencil import index, line_slope, line_weight, offset, weigh
from .tiles import takes
from .update_stress import load_state

EVERY_STEPS = 32
"""Between two looks, which so cost 2 % of the run."""


@ti.func
def stiffen_particle(
    p, particles: Template, law: Template, material, grid: Template, basis: Template
):
    """Lanes 0 .. dim - 1 of a node += V0 rho0 c^2 (dw_d)^2 prod w_e, lane dim += w m."""
    last = ti.static(grid.dim - 1)
    base, _a, w, dw = weigh(p, particles, grid, basis)
    first = index(grid, base)
    wave, _lone = law.kind.moduli(law.constants[material], particles.H[p], load_state(law, p))
    k = particles.V0[p] * wave * grid.constants[None].inv_dx ** 2
    for lead in ti.static(grid.lines):
        at, w_line = first + offset(grid, lead), line_weight(w, lead)
        for n in ti.static(range(w.n)):
            lanes = ti.Vector.zero(float, 4)
            for d in ti.static(range(last)):
                lanes[d] = k * w[n, last] * line_slope(w, dw, lead, d) * dw[lead[d], d]
            lanes[last] = k * w_line * dw[n, last] ** 2
            lanes[grid.dim] = w_line * w[n, last] * particles.m[p]
            add(grid.node, at + n, lanes, grid.atomic)


@ti.func
def stiffen_share(
    particles: Template, law: Template, material, group, grid: Template, basis: Template, color,
    worker, workers,
):  # fmt: skip
    """As in P2G, the worker's tiles of one color."""
    for tile in range(grid.tile_begin[color], grid.tile_begin[color + 1]):
        if takes(worker, workers, tile, grid):
            for plane in range(grid.slab):
                s = grid.tile[tile] + plane * grid.strips
                for p in range(grid.start[group, s], grid.start[group, s + 1]):
                    stiffen_particle(p, particles, law, material, grid, basis)


@ti.kernel
def stiffen_nodes(
    particles: Template, law: Template, material: int, group: int, begin: int, end: int,
    grid: Template, basis: Template, color: int, workers: int,
):  # fmt: skip
    for counter in range(grid.gate * workers):
        if counter % grid.gate == 0:
            worker = counter // grid.gate
            if ti.static(grid.atomic):
                stiffen_particle(begin + worker, particles, law, material, grid, basis)
            else:
                stiffen_share(particles, law, material, group, grid, basis, color, worker, workers)


@ti.func
def light_nodes(grid: Template, bound, worker, workers):
    """How many of a worker's nodes are too light."""
    count, blocks = 0, active_blocks(grid)
    for block in range(
        first_block(worker, workers, blocks), first_block(worker + 1, workers, blocks)
    ):
        first = first_active_node(block, grid)
        for i in range(first, first + grid.node_block):
            lanes = grid.node[i]
            mass, k = lanes[grid.dim], lanes[0]
            for d in ti.static(range(1, grid.dim)):
                k = ti.max(k, lanes[d])
            if mass > grid.constants[None].mass_cutoff and k > bound * mass:
                count += 1
    return count


@ti.kernel
def count_light_nodes(grid: Template, bound: float, workers: int) -> int:
    total = 0
    for counter in range(grid.gate * workers):
        if counter % grid.gate == 0:
            total += light_nodes(grid, bound, counter // grid.gate, workers)
    return total


def slivers(particles, grid, basis, transfer, walls, gravity, dt) -> int:
    """How many nodes are too light for a USL step of dt [s], those aside that the mass cut-off
    takes as empty.

    Particles must be within a cell of where the sort found them.  Nodes are left with other numbers
    than those of a step, which the next one clears."""
    clear(grid)
    for number, group in enumerate(particles.groups):
        workers = grid.workers(group.end - group.begin)
        for color in range(grid.colors):
            stiffen_nodes(
                particles, group.law, group.number, number, group.begin, group.end, grid, basis,
                color, workers,
            )  # fmt: skip
    fold_ghosts(grid, walls, gravity, 0.0)
    return count_light_nodes(grid, (4 if transfer.affine else 2) / dt**2, grid.node_workers)
