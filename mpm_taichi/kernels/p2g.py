"""Stage 2: particles to nodes, on a CPU without atomics."""

import taichi as ti

from ..runtime import Template
from ..stages import stage
from .stencil import index, line_slope, line_weight, moment, offset, weigh
from .tiles import takes


@ti.func
def add(node: Template, i, lanes, atomic: Template):
    if ti.static(atomic):
        node[i] += lanes
    else:
        node[i] = node[i] + lanes  # "a = a + b" is never atomic


@ti.func
def scatter(first, grid: Template, w, dw, q, A: Template, T: Template):
    """node_i += w_i (q + A o_i) + T dw_i over a stencil, q being the value at its first node and
    o_i the offset of node i from there [cells].

    A and T are lists of columns and may be empty.  Walks line by line: to a line by adding columns,
    then along it.  One kind of record per walk, and scalars multiplied before vectors: otherwise
    the stores are not packed into lanes (P2G costs up to twice as much)."""
    last = ti.static(grid.dim - 1)
    for lead in ti.static(grid.lines):
        at = first + offset(grid, lead)
        w_line = line_weight(w, lead)
        value = q
        if ti.static(A):
            for d in ti.static(range(last)):
                value += A[d] * lead[d]
        value *= w_line
        if ti.static(T):
            for d in ti.static(range(last)):
                value += T[d] * line_slope(w, dw, lead, d)
        for k in ti.static(range(w.n)):
            lanes = w[k, last] * value
            if ti.static(A):
                lanes = w[k, last] * (value + (A[last] * w_line) * k)
            if ti.static(T):
                lanes += (dw[k, last] * w_line) * T[last]
            add(grid.node, at + k, lanes, grid.atomic)


@ti.func
def affine_column(
    p, row: Template, d: Template, particles: Template, D, basis: Template, transfer: Template
):
    """Column d of A; where D varies, the place of the scatter gives it."""
    column = particles.rows[p, row]
    if ti.static(transfer.moments and not basis.inverse_moment):
        column /= D[d]
    return column


@ti.func
def scatter_particle(
    p, particles: Template, grid: Template, basis: Template, transfer: Template, what: Template
):
    base, a, w, dw = weigh(p, particles, grid, basis)
    first = index(grid, base)
    if ti.static(what == "residual"):
        R = particles.rows[p, particles.layout.residual]
        scatter(first + grid.apart, grid, w, dw, R, [], [])
    else:
        q = particles.rows[p, 0]
        force = 0.0 * q
        if ti.static(what == "all" and particles.layout.force):
            force = particles.rows[p, particles.layout.force]
        D = moment(w, a)
        A = [
            affine_column(p, row, d, particles, D, basis, transfer)
            for d, row in enumerate(particles.layout.affine)
        ]
        T = [particles.rows[p, row] for row in particles.layout.gradient if what == "all"]
        if ti.static(A):
            for d in ti.static(range(grid.dim)):
                q -= A[d] * a[d]
        if ti.static(not transfer.increment):
            scatter(first, grid, w, dw, q + force, A, T)
            if ti.static(what == "all" and grid.audited):
                S = [particles.rows[p, row] for row in particles.layout.impulse]
                for d in ti.static(range(len(S))):
                    force -= S[d] * a[d]
                scatter(first + grid.apart, grid, w, dw, force, S, T)
        else:
            scatter(first, grid, w, dw, q, A, [])
            if ti.static(what == "all"):
                scatter(first + grid.apart, grid, w, dw, force, [], T)


@ti.func
def scatter_share(
    particles: Template, grid: Template, basis: Template, transfer: Template, what: Template,
    color, worker, workers,
):  # fmt: skip
    """The worker's tiles of one color."""
    for tile in range(grid.tile_begin[color], grid.tile_begin[color + 1]):
        if takes(worker, workers, tile, grid):
            for plane in range(grid.slab):
                s = grid.tile[tile] + plane * grid.strips
                for g in range(particles.group_count):
                    for p in range(grid.start[g, s], grid.start[g, s + 1]):
                        scatter_particle(p, particles, grid, basis, transfer, what)


@ti.kernel
def scatter_particles(
    particles: Template, grid: Template, basis: Template, transfer: Template, what: Template,
    color: int, workers: int,
):  # fmt: skip
    """On a CPU the tiles of one color, which share no node."""
    for counter in range(grid.gate * workers):
        if counter % grid.gate == 0:
            if ti.static(grid.atomic):
                scatter_particle(counter, particles, grid, basis, transfer, what)
            else:
                worker = counter // grid.gate
                scatter_share(particles, grid, basis, transfer, what, color, worker, workers)


@stage
def p2g(particles, grid, basis, transfer, what="all"):
    """m_i = sum_p w_ip m_p and (m v)_i = sum_p w_ip (m_p v_p + A_p (x_i - x_p)), and the impulse of
    stress and body force, sum_p T_p grad w_ip + w_ip dt m_p b_p.  Of these `what` asks for "all" or
    for mass and "momentum"; or it is the "residual" of a filter, sum_p w_ip m_p R_p.

    On return a node holds (momentum and impulse [kg m/s], mass [kg]); with `transfer.increment` the
    impulse is in the record apart, and so is the residual; if `grid.audited` a copy of it is."""
    workers = grid.workers(particles.count)
    for color in range(grid.colors):
        scatter_particles(particles, grid, basis, transfer, what, color, workers)
