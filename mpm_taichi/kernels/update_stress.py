"""Stage 5: particles alone.  One kernel per law, so that laws never meet in one, and one launch per
material.

Particle by particle: tiles of 4 or 8 in one basic block, for LLVM to pack across particles, are no
faster (neo-Hookean in 3D: 1.27 and 1.33 times the P2G beside it; one by one 1.10 to 1.46), not with
H laid out by tiles either (1.41), and compile in 6 and 22 s more."""

import taichi as ti

from ..runtime import Template
from ..stages import stage
from .blocks import blocks_of, first_block
from .rows import columns, put_columns, put_vector, vector
from .tally import NoTally, note_stress


@ti.func
def load_state(law: Template, p):
    """History of particle p; 0 under a law that has none."""
    if ti.static(law.has_state):
        return law.state[p - law.begin]
    else:
        return 0


@ti.func
def store_state(law: Template, p, s):
    if ti.static(law.has_state):
        law.state[p - law.begin] = s


@ti.func
def note_if_lost(p, x, particles: Template, grid: Template):
    inside = True
    for d in ti.static(grid.bounded):
        inside = inside and x[d] >= 0.0 and x[d] <= grid.constants[None].size[d]
    if not inside:
        ti.atomic_min(particles.lost[None], particles.id[p])


@ti.func
def update_particle(
    p, particles: Template, law: Template, material, grid: Template, transfer: Template,
    dt, dt_next, alpha, velocity: Template, stress: Template, move: Template, tally: Template, row,
):  # fmt: skip
    """Returns |v_pic|^2 if it moves, and |L|^2, the sum of squares, and - tr L if that strains."""
    dim = ti.static(grid.dim)
    g = grid.constants[None]
    m = particles.m[p]
    v_pic = vector(particles.rows, p, particles.layout.pic, dim)
    v = vector(particles.rows, p, 0, dim) / m
    L = columns(particles.rows, p, particles.layout.gradient, dim) * g.inv_dx
    C, T = 0.0 * L, 0.0 * L
    if ti.static(velocity):
        v = transfer.velocity(v, v_pic, alpha)
        B = columns(particles.rows, p, particles.layout.moments, dim) * g.dx
        C, L = transfer.gradients(B, L, g.inverse_moment)
    if ti.static(stress):
        H = particles.H[p]
        H_new, s, tau = law.kind.update(
            law.constants[material], H + dt * (L + L @ H), L, dt, load_state(law, p)
        )
        particles.H[p] = H_new
        store_state(law, p, s)
        T = (-dt_next * particles.V0[p]) * tau
        if ti.static(tally.is_on):
            note_stress(p, L, particles.V0[p] * tau, dt, dt_next, particles, grid, tally, row)
    if ti.static(velocity):
        put_vector(particles.rows, p, 0, m * v, m)
        if ti.static(transfer.affine):
            # A dx: linear in m and D^-1, and two numbers are cheaper to scale than a matrix
            A_dx = transfer.affine_momentum(m * g.dx, C, T, g.inverse_moment * g.dx)
            put_columns(particles.rows, p, particles.layout.affine, A_dx)
    if ti.static(stress):
        put_columns(particles.rows, p, particles.layout.gradient, T * g.inv_dx)
    if ti.static(move):
        x = particles.x[p] + dt * v_pic
        particles.x[p] = x
        note_if_lost(p, x, particles, grid)
    speed_squared, rate_squared, compression = 0.0, 0.0, 0.0
    if ti.static(move):
        speed_squared = v_pic.norm_sqr()
    if ti.static(stress):
        rate_squared, compression = L.norm_sqr(), -L.trace()
    return speed_squared, rate_squared, compression


@ti.func
def note_motion(grid: Template, speed_squared, rate_squared, compression):
    """On a GPU for each particle: few of them have to wait for another; and behind its loops the
    compiler of software Vulkan (Mesa 22.3) has lost the largest of a worker."""
    if speed_squared > grid.speed_squared[None]:
        ti.atomic_max(grid.speed_squared[None], speed_squared)
    if rate_squared > grid.rate_squared[None]:
        ti.atomic_max(grid.rate_squared[None], rate_squared)
    if compression > grid.compression[None]:
        ti.atomic_max(grid.compression[None], compression)


@ti.func
def stress_share(
    particles: Template, law: Template, material, grid: Template, transfer: Template,
    begin, end, dt, dt_next, alpha,
    velocity: Template, stress: Template, move: Template, tally: Template, worker, workers,
):  # fmt: skip
    blocks = blocks_of(end - begin, grid.block)
    fastest, steepest, tightest = 0.0, 0.0, 0.0
    row = begin // grid.block + law.first + material  # of the tally: none is another material's
    for block in range(
        first_block(worker, workers, blocks), first_block(worker + 1, workers, blocks)
    ):
        first = begin + block * grid.block
        for p in range(first, ti.min(first + grid.block, end)):
            speed_squared, rate_squared, compression = update_particle(
                p, particles, law, material, grid, transfer, dt, dt_next, alpha,
                velocity, stress, move, tally, row + block,
            )  # fmt: skip
            if ti.static(grid.atomic):
                note_motion(grid, speed_squared, rate_squared, compression)
            elif ti.static(move or stress):  # ti.max would spoil the packing of lanes
                if speed_squared > fastest:
                    fastest = speed_squared
                if rate_squared > steepest:
                    steepest = rate_squared
                if compression > tightest:
                    tightest = compression
    if ti.static((move or stress) and not grid.atomic):
        note_motion(grid, fastest, steepest, tightest)


@ti.kernel
def update_particles(
    particles: Template, law: Template, material: int, grid: Template, transfer: Template,
    begin: int, end: int, dt: float, dt_next: float, alpha: float,
    velocity: Template, stress: Template, move: Template, tally: Template, workers: int,
):  # fmt: skip
    for counter in range(grid.gate * workers):
        if counter % grid.gate == 0:
            stress_share(
                particles, law, material, grid, transfer, begin, end, dt, dt_next, alpha,
                velocity, stress, move, tally, counter // grid.gate, workers,
            )  # fmt: skip


@stage
def update_stress(
    particles, group, grid, transfer, dt, dt_next, alpha=1.0, velocity=True, stress=True, move=True,
    tally=NoTally,
):  # fmt: skip
    """Velocity and affine momentum from what was gathered, alpha being the FLIP part of a blend;
    H <- H + dt L (I + H), stress and state by the law; x <- x + dt sum_i w_ip v_i.  Stress orders
    other than USL ask for these at different times.

    On return the rows hold what P2G scatters: (m v, m), the affine momentum and the impulse
    T = - dt_next V0 tau of the step to come; `particles.lost` is the least id of a particle that
    has left the closed domain, or the number of particles; the grid has the largest |L|^2 and
    - tr L that strain particles, and once these have moved the largest |sum_i w_ip v_i|^2."""
    update_particles(
        particles, group.law, group.number, grid, transfer, group.begin, group.end,
        dt, dt_next, alpha, velocity, stress, move, tally, grid.workers(group.end - group.begin),
    )  # fmt: skip
