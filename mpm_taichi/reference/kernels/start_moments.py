"""Before the first step: the moments of a given velocity gradient."""

from .stencil import moment, weigh


def start_moments(particles, grid, basis):
    """B = L D, for bases whose D varies; B holds L dx^2 on entry."""
    for p in range(particles.count):
        _, a, w, _ = weigh(p, particles, grid, basis)
        particles.B[p] *= moment(w, a)
