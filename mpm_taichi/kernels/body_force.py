"""Before P2G: the body force of a formula, at the particles."""

import taichi as ti

from ..runtime import Template
from ..stages import stage
from .blocks import BLOCK, first_block
from .rows import put_vector


@ti.func
def push_particle(p, particles: Template, body_force: Template, time, dt):
    b = ti.Vector(ti.static(body_force.on_device(particles.X[p], particles.x[p], time)))
    put_vector(particles.rows, p, particles.layout.force, (dt * particles.m[p]) * b, 0.0)


@ti.kernel
def push_particles(
    particles: Template, grid: Template, body_force: Template, time: float, dt: float, threads: int
):
    if ti.static(grid.atomic):
        for p in range(particles.count):
            push_particle(p, particles, body_force, time, dt)
    else:
        for counter in range(512 * threads):
            if counter % 512 == 0:
                worker = counter // 512
                last = first_block(worker + 1, threads, particles.count)
                for block in range(first_block(worker, threads, particles.count), last):
                    start = block * BLOCK
                    for p in range(start, ti.min(start + BLOCK, particles.count)):
                        push_particle(p, particles, body_force, time, dt)


@stage
def push(particles, grid, body_force, time, dt):
    """On return the row of the force holds dt m b(X, x, t), b the force per mass [m/s^2]."""
    push_particles(particles, grid, body_force, time, dt, grid.threads)
