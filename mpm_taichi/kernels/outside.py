"""Particles that have left the domain, where the scene has a rule for them."""

import taichi as ti

from ..runtime import Template
from ..stages import stage

NOTHING = 2.0**-60
"""What is left of mass and volume of a deleted particle, as a part: no sum of the others changes by
it, and no weight, momentum or stress divides by zero."""


@ti.func
def clamp(p, particles: Template, grid: Template):
    """Onto the border, where it does not move across."""
    x, q = particles.x[p], particles.rows[p, 0]
    size = grid.constants[None].size
    for d in ti.static(grid.bounded):
        if x[d] < 0.0 or x[d] > size[d]:
            x[d] = ti.min(ti.max(x[d], 0.0), size[d])
            q[d] = 0.0
    particles.x[p], particles.rows[p, 0] = x, q
    particles.brought_in[None] += 1


@ti.func
def delete(p, particles: Template, grid: Template, lightest):
    """What is left of it follows the others from the middle of the domain on."""
    if particles.m[p] >= lightest:
        particles.m[p] = NOTHING * particles.m[p]
        particles.V0[p] = NOTHING * particles.V0[p]
        particles.brought_in[None] += 1
    for row in ti.static(range(particles.layout.count)):
        particles.rows[p, row] = ti.Vector.zero(float, 4)
    particles.rows[p, 0][grid.dim] = particles.m[p]
    particles.H[p] = ti.Matrix.zero(float, grid.dim, grid.dim)
    particles.x[p] = 0.5 * grid.constants[None].size


@ti.kernel
def bring_in_particles(particles: Template, grid: Template, deletes: Template, lightest: float):
    for p in range(particles.count):
        inside = True
        for d in ti.static(grid.bounded):
            x = particles.x[p][d]
            inside = inside and x >= 0.0 and x <= grid.constants[None].size[d]
        if not inside:
            if ti.static(deletes):
                delete(p, particles, grid, lightest)
            else:
                clamp(p, particles, grid)


@stage
def bring_in(particles, grid, deletes, lightest):
    """On return no particle is outside: each is clamped to the border, or deleted: then less than a
    part 2^-60 of its mass is left, which stays below `lightest` [kg].  `particles.brought_in`
    counts how often.  All positions have to be numbers; a sort is due where some were deleted."""
    bring_in_particles(particles, grid, deletes, lightest)
    particles.lost[None] = particles.count
