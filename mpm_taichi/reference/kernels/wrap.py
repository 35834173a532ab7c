"""Particles that have left a periodic axis enter again at its other end."""

import numpy as np


def wrap(particles, grid):
    """On return 0 <= x <= size along periodic axes."""
    for d in grid.periodic:
        size = grid.cells[d] * grid.dx
        particles.x[:, d] -= size * np.floor(particles.x[:, d] / size)
