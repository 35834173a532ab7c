"""Before the first step: the moments of a given velocity gradient."""

import taichi as ti

from ..runtime import Template
from ..stages import stage
from .stencil import moment, weigh


@ti.kernel
def start_each(particles: Template, grid: Template, basis: Template):
    for p in range(particles.count):
        _base, a, w, _dw = weigh(p, particles, grid, basis)
        D = moment(w, a)
        for d, row in ti.static(enumerate(particles.layout.moments)):
            particles.rows[p, row] = D[d] * particles.rows[p, row]


@stage
def start_moments(particles, grid, basis):
    """B = L D, for bases whose D varies; the rows of the moments hold L dx on entry."""
    start_each(particles, grid, basis)
