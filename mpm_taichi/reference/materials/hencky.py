"""St. Venant-Kirchhoff solid in logarithmic strain; see mpm_taichi/materials/hencky.py."""

import numpy as np

from .invariants import left_strain, log_volume_ratio, squared_stretches, volume_strain
from .law import MaterialLaw
from .symmetric import logarithm


class Hencky(MaterialLaw):
    """psi = mu e : e + lam/2 (tr e)^2;  tau = 2 mu e + lam tr(e) I;  e = ln(F F^T) / 2."""

    @staticmethod
    def strain(H):
        return 0.5 * logarithm(left_strain(H))

    @staticmethod
    def stress(c, e, volume):
        return 2 * c.mu * e + c.lam * volume * np.eye(len(e))

    @staticmethod
    def update(c, H, L, dt, s):
        e = Hencky.strain(H)
        return H, s, Hencky.stress(c, e, e.trace())

    @staticmethod
    def moduli(c, H, s):
        return Hencky.moduli_at(c, H, log_volume_ratio(volume_strain(H)))

    @staticmethod
    def moduli_at(c, H, volume):
        """G + |C|, see mpm_taichi/materials/hencky.py."""
        low, high = np.log(squared_stretches(H))
        y = 0.5 * (high - low)
        shear, pressure = c.mu * (1 + y**2 / 3), c.lam * (1 - volume)
        softest, stiffest = pressure + c.mu * (1 - high), pressure + shear - c.mu * low
        wave = shear + c.mu * y + max(stiffest, -softest, 0.0)
        return wave, len(H) * max(c.lam, 0.0) + 2 * shear

    @staticmethod
    def energy_density(c, H, s):
        e = Hencky.strain(H)
        return c.mu * (e**2).sum() + 0.5 * c.lam * e.trace() ** 2

    @staticmethod
    def out_of_plane_stress(c, H, s):
        return c.lam * log_volume_ratio(volume_strain(H))
