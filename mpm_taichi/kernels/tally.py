"""For the audit: what walls, gravity and body forces give and what each stage does to the kinetic
energy, added up where it arises.

Particles give their nodes the momentum p_i of before the fold and the mass m_i, and get back (PIC)
sum_i m_i v_i or (FLIP) sum_i m_i (v_i - v_i^old): so what walls give to the momentum of particles
is, over the nodes where a wall can act, sum m_i v_i - p_i - impulse_i - m_i dt g, or the same of
the change; elsewhere this is zero.  About the origin likewise, with x_i x.

A row of a table belongs to a block of nodes or particles and so to one worker."""

from typing import ClassVar

import taichi as ti

from ..runtime import Template
from ..stages import stage
from .blocks import BLOCK, CHUNK, blocks_of, first_block
from .rows import columns, put_columns, vector
from .stencil import moment, weigh

TURNS = {2: ((0, 1),), 3: ((1, 2), (2, 0), (0, 1))}
"""The plane of each component of an angular momentum."""


class NoTally:
    """For stages of which nothing is noted."""

    is_on = False
    has_walls = False
    has_particles = False
    lets_go = False
    start = ()
    stored: ClassVar = {}


@ti.func
def add(table: Template, row, column: Template, value):
    table[row, column] = table[row, column] + value  # "a = a + b" is never atomic


@ti.func
def add_vector(table: Template, row, column: Template, values):
    for d in ti.static(range(values.n)):
        add(table, row, ti.static(column + d), values[d])


@ti.func
def cross(a, b, dim: Template):
    """The components of a x b that `dim` dimensions have."""
    return ti.Vector([a[d] * b[e] - a[e] * b[d] for d, e in ti.static(TURNS[dim])])


@ti.func
def energy(mass, v, real: Template):
    """m |v|^2 / 2."""
    return 0.5 * ti.cast(mass, real) * v.cast(real).norm_sqr()


@ti.func
def lanes_of(i, record: Template, grid: Template, real: Template):
    lanes = grid.node[i + record * grid.apart]
    return ti.Vector([ti.cast(lanes[d], real) for d in range(grid.dim)])


@ti.func
def before_forces(i, v_old, grid: Template):
    """v_i^old without the impulse that a transfer without increment has in it."""
    if ti.static(not grid.increment):
        lanes = grid.node[i]
        for d in ti.static(range(grid.dim)):
            v_old[d] -= grid.node[i + grid.apart][d] / lanes[grid.dim]
    return v_old


@ti.func
def note_node(i, v_old, v_held, v, grid: Template, tally: Template, row):
    """A node in the grid update: what it was given, v_old, the same after the walls, v_held, and v.
    In an increment the walls take nothing of v_old from the particles."""
    mass = grid.node[i][grid.dim]
    given = v_old
    if ti.static(grid.increment):
        given = v_held
    add(tally.at_nodes, row, tally.nodes.given, energy(mass, given, tally.real))
    add(tally.at_nodes, row, tally.nodes.held, energy(mass, v_held, tally.real))
    add(tally.at_nodes, row, tally.nodes.end, energy(mass, v, tally.real))


@ti.func
def note_cut_node(i, gravity: Template, dt, grid: Template, tally: Template, row):
    """A node that the mass cut-off empties: what its particles do not get back."""
    lanes = grid.node[i]
    mass = lanes[grid.dim]
    p, given = lanes_of(i, 0, grid, tally.real), lanes_of(i, 1, grid, tally.real)
    raw, lost = p, given
    if ti.static(not grid.increment):
        raw, lost = p - given, p
    lost += ti.cast(mass * dt, tally.real) * gravity[None].cast(tally.real)
    taken = energy(1.0, raw, tally.real) / ti.cast(mass, tally.real)
    add(tally.at_nodes, row, tally.nodes.given, taken)
    add(tally.at_nodes, row, tally.nodes.cut, taken)
    add_vector(tally.at_nodes, row, tally.nodes.lost, lost)


@ti.func
def affine_energy(
    p, particles: Template, grid: Template, basis: Template, transfer: Template, real: Template
):
    """Of the gathered rows: m tr(C D C^T) / 2, C = B D^-1 or the velocity gradient."""
    found = ti.cast(0.0, real)
    if ti.static(transfer.affine):
        D = ti.Vector.one(float, grid.dim) / ti.static(basis.inverse_moment or 1.0)
        if ti.static(not basis.inverse_moment):
            _base, a, w, _dw = weigh(p, particles, grid, basis)
            D = moment(w, a)
        moments = ti.static(transfer.moments)
        at = ti.static(particles.layout.moments if moments else particles.layout.gradient)
        for d, row in ti.static(enumerate(at)):
            column = vector(particles.rows, p, row, grid.dim).norm_sqr()
            found += ti.cast(column / D[d] if ti.static(moments) else column * D[d], real)
    return 0.5 * ti.cast(particles.m[p], real) * found


@ti.func
def gathered(
    p, particles: Template, grid: Template, basis: Template, transfer: Template, dt, tally: Template
):
    """A row of `of_particles` for one particle whose rows were gathered just now."""
    dim = ti.static(grid.dim)
    found = ti.Vector.zero(tally.real, tally.particles.count)
    v, x = vector(particles.rows, p, particles.layout.pic, dim).cast(tally.real), particles.x[p]
    if ti.static(not transfer.increment):
        found[tally.particles.kinetic] = energy(particles.m[p], v, tally.real) + affine_energy(
            p, particles, grid, basis, transfer, tally.real
        )
    if ti.static(tally.falls):
        share = ti.cast(particles.m[p], tally.real) * ti.cast(dt, tally.real)
        for d in ti.static(range(dim)):
            found[tally.particles.path + d] = share * v[d]
            found[tally.particles.moment + d] = share * ti.cast(x[d], tally.real)
    if ti.static(tally.force):
        f = vector(particles.rows, p, particles.layout.force, dim).cast(tally.real)
        twist = cross(x.cast(tally.real), f, dim)
        for d in ti.static(range(dim)):
            found[tally.particles.push + d] = f[d]
        for k in ti.static(range(twist.n)):
            found[tally.particles.twist + k] = twist[k]
        found[tally.particles.pushing] = f.dot(v)
    return found


@ti.func
def note_particles(found, tally: Template, row):
    """A block of particles, added up; of the kinetic energy the last value is kept too."""
    if ti.static(not tally.increment):
        found[tally.particles.kinetics] = found[tally.particles.kinetic]
        tally.of_particles[row, tally.particles.kinetic] = 0.0
    add_vector(tally.of_particles, row, 0, found)


@ti.func
def note_stress(
    p, L, V0_tau, dt, dt_next, particles: Template, grid: Template, tally: Template, row
):
    """The work of the stress in a step, V0 / 2 (tau_old : dt L + tau : dt L (I + dt L)^-1), which
    is that of P along the straight way from F to (I + dt L) F, by the trapezoidal rule."""
    g = grid.constants[None]
    unit, unit_next = -1.0, -1.0
    if ti.static(tally.stress_in_affine):
        unit = -1.0 / (dt * g.inverse_moment * g.dx) if dt > 0.0 else 0.0
        unit_next = -dt_next * g.inverse_moment * g.dx
    if dt > 0.0:
        old = unit * columns(particles.rows, p, particles.layout.stress, grid.dim)
        advance = ti.Matrix.identity(float, grid.dim) + dt * L
        new = V0_tau @ advance.inverse().transpose()
        work = (0.5 * dt) * ((old + new) * L).sum()
        add(tally.of_stress, row, tally.stress.work, ti.cast(work, tally.real))
    put_columns(particles.rows, p, particles.layout.stress, unit_next * V0_tau)


@ti.func
def place(i, grid: Template, real: Template):
    """x of node i [m]."""
    x = ti.Vector.zero(real, grid.dim)
    for d in ti.static(range(grid.dim)):
        number = i // grid.strides[d] % grid.extent[d] - grid.ghost
        x[d] = ti.cast(number, real) * ti.cast(grid.constants[None].dx, real)
    return x


@ti.func
def note_at_wall(
    k, grid: Template, gravity: Template, dt, alpha, tally: Template, when: Template, row
):
    """Node k of those where a wall can act, at one of three moments."""
    i = tally.wall_node[k]
    if grid.reached[i // CHUNK] == 1:
        first = lanes_of(i, 0, grid, tally.real)
        part = ti.cast(alpha if ti.static(grid.increment) else 0.0, tally.real)
        mass = ti.cast(tally.wall_mass[k], tally.real)
        change = 0.0 * first
        if ti.static(when == "given"):
            tally.wall_mass[k] = grid.node[i][grid.dim]
            change = (part - 1.0) * first
            if ti.static(grid.increment):
                change -= lanes_of(i, 1, grid, tally.real)
        elif ti.static(when == "taken"):
            change = (1.0 - part) * first - ti.cast(dt, tally.real) * gravity[None].cast(tally.real)
            if ti.static(grid.increment):
                change += part * lanes_of(i, 1, grid, tally.real)
            change *= mass
            if ti.static(tally.lets_go):
                add(tally.at_walls, row, tally.walls.images, energy(mass, first, tally.real))
        else:
            had = energy(grid.node[i][grid.dim], first, tally.real)
            add(tally.at_walls, row, tally.walls.images, -had)
        if ti.static(when != "kept"):
            add_vector(tally.at_walls, row, tally.walls.impulse, change)
            add_vector(
                tally.at_walls,
                row,
                tally.walls.turn,
                cross(place(i, grid, tally.real), change, grid.dim),
            )


@ti.func
def note_share(
    grid: Template, gravity: Template, dt, alpha, tally: Template, when: Template, worker, workers
):
    count = ti.static(tally.node_count)
    blocks = blocks_of(count, BLOCK)
    for block in range(
        first_block(worker, workers, blocks), first_block(worker + 1, workers, blocks)
    ):
        for k in range(block * BLOCK, ti.min((block + 1) * BLOCK, count)):
            note_at_wall(k, grid, gravity, dt, alpha, tally, when, block)


@ti.kernel
def note_walls(
    grid: Template, gravity: Template, dt: float, alpha: float, tally: Template, when: Template,
    workers: int,
):  # fmt: skip
    for counter in range(grid.gate * workers):
        if counter % grid.gate == 0:
            note_share(grid, gravity, dt, alpha, tally, when, counter // grid.gate, workers)


@stage
def note_at_walls(grid, gravity, dt, alpha, tally, when):
    """At the nodes where a wall can act, of a step of length dt [s] with the FLIP part alpha:
    before the fold what particles have `given`, after the grid update the energy that nodes have
    `kept`, and after the fill what particles have `taken` back."""
    if grid.is_near_wall and (when != "kept" or tally.lets_go):
        note_walls(grid, gravity, dt, alpha, tally, when, grid.workers(tally.node_count))


@ti.kernel
def note_start_of_each(
    particles: Template, grid: Template, basis: Template, transfer: Template, tally: Template
):
    ti.loop_config(serialize=True)
    for block in range(blocks_of(particles.count, BLOCK)):
        found = ti.Vector.zero(tally.real, tally.particles.count)
        for p in range(block * BLOCK, ti.min((block + 1) * BLOCK, particles.count)):
            found += gathered(p, particles, grid, basis, transfer, 0.0, tally)
        tally.of_particles[block, tally.particles.kinetic] = found[tally.particles.kinetic]


@stage
def note_start(particles, grid, basis, transfer, tally):
    """The kinetic energy of the particles before the first step, whose rows are as after a gather;
    of transfers without increment."""
    note_start_of_each(particles, grid, basis, transfer, tally)
