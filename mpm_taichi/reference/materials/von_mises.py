"""Metal: von Mises plasticity with linear hardening in logarithmic strain; see
mpm_taichi/materials/von_mises.py for the sources."""

import numpy as np

from .flowing import Flowing, across, flowed
from .hencky import Hencky
from .principal import assembled, logarithmic_strains


class VonMises(Flowing):
    """f = q - (Y + h k) <= 0 with q = sqrt(3/2) |dev tau|; dk = f / (3 mu + h)."""

    @staticmethod
    def update(c, H, L, dt, s):
        e, V = logarithmic_strains(H, across(H, s))
        deviator = e - e.sum() / 3
        size = np.linalg.norm(deviator)
        excess = np.sqrt(6) * c.mu * size - (c.yield_stress + c.hardening * s.plastic_strain)
        if excess > 0:
            flow = excess / (3 * c.mu + c.hardening)
            s.plastic_strain = s.plastic_strain + flow
            change = -np.sqrt(1.5) * flow / size * deviator
            H, s = flowed(H, V, change, s)
            e = e + change
        return H, s, assembled(Hencky.principal_stress(c, e), V)

    @staticmethod
    def dissipated_energy(c, H, s):
        return (c.yield_stress + 0.5 * c.hardening * s.plastic_strain) * s.plastic_strain

    @staticmethod
    def plastic_strain(c, H, s):
        return s.plastic_strain
