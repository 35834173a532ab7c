"""Before a sort: particles that have left a periodic axis enter again at its other end."""

import taichi as ti

from ..runtime import Template
from ..stages import stage


@ti.kernel
def wrap_particles(particles: Template, grid: Template):
    for p in range(particles.count):
        for d in ti.static(grid.periodic):
            size = grid.constants[None].size[d]
            particles.x[p][d] -= size * ti.floor(particles.x[p][d] / size)


@stage
def wrap(particles, grid):
    """On return 0 <= x <= size along periodic axes.  Between two sorts a particle drifts a cell at
    most, and ghost nodes are wide enough for it."""
    wrap_particles(particles, grid)
