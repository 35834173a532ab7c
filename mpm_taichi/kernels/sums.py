"""For reports: what is conserved and where the energy is, added up body by body on the device."""

import numpy as np
import taichi as ti
from taichi.lang.util import to_numpy_type

from ..runtime import Array, Template, widest_float
from .blocks import first_block
from .rows import columns, vector
from .stencil import moment, weigh
from .tally import TURNS
from .update_stress import load_state

MOST_BLOCKS = {"cpu": 128, "gpu": 2048}
"""A block has a row for each body, so that a scene of hundreds of bodies still takes megabytes."""


@ti.func
def body_of(id, ranges: Template):
    """b with ranges[b] <= id < ranges[b + 1]."""
    low, high = 0, ranges.shape[0] - 1
    while high - low > 1:
        middle = (low + high) // 2
        if ranges[middle] <= id:
            low = middle
        else:
            high = middle
    return low


@ti.func
def add(table: Template, block, body, at: Template, value):
    table[block, body, at] = table[block, body, at] + value  # "a = a + b" is never atomic


@ti.func
def add_particle(
    p, particles: Template, law: Template, material, grid: Template, basis: Template,
    transfer: Template, ranges: Template, block, table: Template, real: Template,
):  # fmt: skip
    """Columns: m x, m v, angular momentum, kinetic, stored and dissipated energy."""
    dim = ti.static(grid.dim)
    g = grid.constants[None]
    body = body_of(particles.id[p], ranges)
    m, x = ti.cast(particles.m[p], real), particles.x[p].cast(real)
    mv = vector(particles.rows, p, 0, dim).cast(real)
    v = mv / m
    c, H, s, V0 = law.constants[material], particles.H[p], load_state(law, p), particles.V0[p]
    stored = law.kind.energy_density(c, H, s)
    dissipated = law.kind.dissipated_energy(c, H, s)
    # Where the moments were gathered D is one number, or a factor that A carries (kernels/rows.py).
    D = ti.Vector.one(float, dim) / g.inverse_moment
    if ti.static(transfer.affine and not transfer.moments):
        _base, a, w, _dw = weigh(p, particles, grid, basis)
        D = moment(w, a) * g.dx**2
    A = columns(particles.rows, p, particles.layout.affine, dim) * g.inv_dx
    for d in ti.static(range(dim)):
        add(table, block, body, d, m * x[d])
        add(table, block, body, dim + d, mv[d])
    for k, plane in ti.static(enumerate(TURNS[dim])):
        d, e = ti.static(plane[0]), ti.static(plane[1])
        spin = ti.cast(D[d] * A[e, d] - D[e] * A[d, e], real)
        add(table, block, body, ti.static(2 * dim + k), x[d] * mv[e] - x[e] * mv[d] + spin)
    last = ti.static(2 * dim + len(TURNS[dim]))
    add(table, block, body, last, 0.5 * mv.dot(v))
    add(table, block, body, last + 1, ti.cast(V0, real) * stored)
    add(table, block, body, last + 2, ti.cast(V0, real) * dissipated)


@ti.func
def sum_share(
    particles: Template, law: Template, material, grid: Template, basis: Template,
    transfer: Template, begin, end, size, ranges: Template, table: Template, real: Template,
    worker, workers,
):  # fmt: skip
    blocks = table.shape[0]
    for block in range(
        first_block(worker, workers, blocks), first_block(worker + 1, workers, blocks)
    ):
        first = begin + block * size
        for p in range(first, ti.min(first + size, end)):
            add_particle(
                p, particles, law, material, grid, basis, transfer, ranges, block, table, real
            )


@ti.kernel
def sum_particles(
    particles: Template, law: Template, material: int, grid: Template, basis: Template,
    transfer: Template, begin: int, end: int, size: int, ranges: Array, table: Array,
    real: Template, workers: int,
):  # fmt: skip
    for counter in range(grid.gate * workers):
        if counter % grid.gate == 0:
            sum_share(
                particles, law, material, grid, basis, transfer, begin, end, size, ranges, table,
                real, counter // grid.gate, workers,
            )  # fmt: skip


def sums(particles, grid, basis, transfer, ranges):
    """Over each body, whose particles are ranges[b] to ranges[b + 1] in the order of the scene:

        mass_moment       sum m x [kg m], shape [bodies, dim]
        momentum          sum m v [kg m/s], shape [bodies, dim]
        angular_momentum  about the origin, sum x x m v and the moments of the affine velocity
                          (Jiang et al. 2015) [kg m^2/s], shape [bodies, 1] in 2D, [bodies, 3] in 3D
        kinetic_energy    sum m |v|^2 / 2 [J], shape [bodies]
        elastic_energy    sum V0 psi, what the laws store [J], shape [bodies]
        dissipated_energy what the laws have lost since the start [J], shape [bodies]

    Blocks of particles are added up each on its own, then in their order: the result does not
    depend on the number of threads.  Terms and sums are f64 also in an f32 run, where every device
    of the kind has it (`widest_float`)."""
    dim, turns, real = grid.dim, len(TURNS[grid.dim]), widest_float()
    total = np.zeros((len(ranges) - 1, 2 * dim + turns + 3))
    for group in particles.groups:
        count = group.end - group.begin
        most = MOST_BLOCKS["gpu" if grid.atomic else "cpu"]
        size = max(grid.block, -(-count // most))
        table = np.zeros((-(-count // size), *total.shape), to_numpy_type(real))
        sum_particles(
            particles, group.law, group.number, grid, basis, transfer, group.begin, group.end,
            size, np.asarray(ranges, np.int32), table, real, grid.workers(len(table)),
        )  # fmt: skip
        total += table.sum(axis=0, dtype=float)
    return {
        "mass_moment": total[:, :dim],
        "momentum": total[:, dim : 2 * dim],
        "angular_momentum": total[:, 2 * dim : 2 * dim + turns],
        "kinetic_energy": total[:, -3],
        "elastic_energy": total[:, -2],
        "dissipated_energy": total[:, -1],
    }
