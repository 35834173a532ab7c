"""Linear elasticity whose stress turns with the body; see mpm_taichi/materials/hypoelastic.py."""

import numpy as np

from .accumulated_strain import AccumulatedStrain
from .invariants import left_strain


class Hypoelastic(AccumulatedStrain):
    """eps <- R eps R^T + ln V with I + dt L = V R, both to third order in A = V^2 - I."""

    @staticmethod
    def update(c, H, L, dt, s):
        one, A = np.eye(len(H)), left_strain(dt * L)
        R = (one - A / 2 + 3 / 8 * A @ A - 5 / 16 * A @ A @ A) @ (one + dt * L)
        s.strain = R @ s.strain @ R.T + A / 2 - A @ A / 4 + A @ A @ A / 6
        return H, s, AccumulatedStrain.kirchhoff_stress(c, H, s)
