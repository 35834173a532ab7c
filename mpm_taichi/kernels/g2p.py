"""Stage 4: nodes to particles, axis by axis (sum factorization)."""

import taichi as ti

from ..runtime import Template
from ..stages import stage
from .blocks import blocks_of, first_block
from .stencil import index, weigh
from .tally import NoTally, gathered, note_particles


@ti.func
def gather(at, axis: Template, grid: Template, w, dw, v: Template, B: Template, S: Template):
    """v += sum w_i n_i, B[d] += sum w_i n_i o_i[d], S[d] += sum n_i dw_i[d] over the records n_i of
    a stencil along the axes from `axis` on, o_i the offset of node i from its first node [cells].

    B and S are lists of vectors and may be empty; v must be 0 before.  From the last node back, so
    that moments need no products: q1 + 2 q2 + 3 q3 = (q3) + (q3 + q2) + (q3 + q2 + q1)."""
    for back in ti.static(range(w.n)):
        k = ti.static(w.n - 1 - back)
        zero = ti.Vector.zero(float, 4)
        part = zero
        if ti.static(axis == grid.dim - 1):
            part = grid.node[at + k]
        else:
            B_part, S_part = [zero for _ in B], [zero for _ in S]
            gather(at + k * grid.strides[axis], axis + 1, grid, w, dw, part, B_part, S_part)
            for d in ti.static(range(axis + 1, grid.dim)):
                if ti.static(B):
                    B[d] += w[k, axis] * B_part[d]
                if ti.static(S):
                    S[d] += w[k, axis] * S_part[d]
        v += w[k, axis] * part
        if ti.static(B and k > 0):
            B[axis] += v
        if ti.static(S):
            S[axis] += dw[k, axis] * part


@ti.func
def gather_particle(
    p, particles: Template, grid: Template, basis: Template, transfer: Template, what: Template
):
    base, a, w, dw = weigh(p, particles, grid, basis)
    first = index(grid, base)
    zero = ti.Vector.zero(float, 4)
    v, dv = zero, zero
    if ti.static(what == "residual"):
        gather(first + grid.apart, 0, grid, w, dw, v, [], [])
        row = ti.static(particles.layout.residual)
        particles.rows[p, row] = particles.rows[p, row] - particles.m[p] * v
        return
    B = [zero for row in particles.layout.moments if what == "all"]
    S = [zero for row in particles.layout.gradient]
    gather(first, 0, grid, w, dw, v, B, S)
    # Rows in the order of memory: then the stores pack into lanes.
    if ti.static(what == "all"):
        if ti.static(transfer.increment):
            gather(first + grid.apart, 0, grid, w, dw, dv, [], [])
            particles.rows[p, 0] = particles.rows[p, 0] + particles.m[p] * dv
        else:
            particles.rows[p, 0] = v
        for d, row in ti.static(enumerate(particles.layout.moments)):
            particles.rows[p, row] = B[d] - a[d] * v
    for d, row in ti.static(enumerate(particles.layout.gradient)):
        particles.rows[p, row] = S[d]
    if ti.static(what == "all" and particles.layout.pic):
        particles.rows[p, particles.layout.pic] = v


@ti.func
def gather_share(
    particles: Template, grid: Template, basis: Template, transfer: Template, what: Template,
    dt, tally: Template, worker, workers,
):  # fmt: skip
    blocks = blocks_of(particles.count, grid.block)
    for block in range(
        first_block(worker, workers, blocks), first_block(worker + 1, workers, blocks)
    ):
        first = block * grid.block
        end = ti.min(first + grid.block, particles.count)
        if ti.static(tally.has_particles):
            found = ti.Vector.zero(tally.real, tally.particles.count)
            for p in range(first, end):
                gather_particle(p, particles, grid, basis, transfer, what)
                found += gathered(p, particles, grid, basis, transfer, dt, tally)
            note_particles(found, tally, block)
        else:
            for p in range(first, end):
                gather_particle(p, particles, grid, basis, transfer, what)


@ti.kernel
def gather_particles(
    particles: Template, grid: Template, basis: Template, transfer: Template, what: Template,
    dt: float, tally: Template, workers: int,
):  # fmt: skip
    for counter in range(grid.gate * workers):
        if counter % grid.gate == 0:
            gather_share(
                particles, grid, basis, transfer, what, dt, tally, counter // grid.gate, workers
            )


@stage
def g2p(particles, grid, basis, transfer, what="all", dt=0.0, tally=NoTally):
    """v_p = sum_i w_ip v_i, B_p = sum_i w_ip v_i (x_i - x_p)^T, S_p = sum_i v_i grad w_ip^T, and
    with `transfer.increment` the change sum_i w_ip (v_i - v_i^old).  Of these `what` asks for "all"
    or for the "gradient" S_p; or it is the "residual" of a filter, R_p -= sum_i w_ip R_i.

    On return the rows hold what was gathered (see kernels/rows.py); x, H and the state are as
    before; a `tally` has noted energy and supplies of the step, which is dt [s] long."""
    workers = grid.workers(particles.count)
    gather_particles(particles, grid, basis, transfer, what, dt, tally, workers)
