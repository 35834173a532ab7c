"""The nodes that each particle touches, and with what weight."""

import numpy as np

from .stencil import weigh


def weights(particles, grid, basis):
    """First node of the stencil [n, dim], a multi-index that counts ghost nodes; and of each axis
    weights w [n, support, dim] and slopes dw [n, support, dim] (per cell)."""
    found = (weigh(p, particles, grid, basis) for p in range(particles.count))
    base, _a, w, dw = map(np.array, zip(*found, strict=True))
    return base, w, dw
