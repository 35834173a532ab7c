"""Before P2G: the body force of a formula, at the particles."""

import taichi as ti

from ..runtime import Template
from ..stages import stage
from .blocks import blocks_of, first_block
from .rows import put_vector


@ti.func
def push_particle(p, particles: Template, body_force: Template, time, dt):
    b = ti.Vector(ti.static(body_force.on_device(particles.X[p], particles.x[p], time)))
    put_vector(particles.rows, p, particles.layout.force, (dt * particles.m[p]) * b, 0.0)


@ti.func
def push_share(
    particles: Template, grid: Template, body_force: Template, time, dt, worker, workers
):
    blocks = blocks_of(particles.count, grid.block)
    for block in range(
        first_block(worker, workers, blocks), first_block(worker + 1, workers, blocks)
    ):
        first = block * grid.block
        for p in range(first, ti.min(first + grid.block, particles.count)):
            push_particle(p, particles, body_force, time, dt)


@ti.kernel
def push_particles(
    particles: Template, grid: Template, body_force: Template, time: float, dt: float, workers: int
):
    for counter in range(grid.gate * workers):
        if counter % grid.gate == 0:
            push_share(particles, grid, body_force, time, dt, counter // grid.gate, workers)


@stage
def push(particles, grid, body_force, time, dt):
    """On return the row of the force holds dt m b(X, x, t), b the force per mass [m/s^2]."""
    push_particles(particles, grid, body_force, time, dt, grid.workers(particles.count))
