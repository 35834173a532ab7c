"""Metal: von Mises plasticity with linear hardening in logarithmic strain; see
mpm_taichi/materials/von_mises.py for the sources."""

import numpy as np

from .flowing import Flowing
from .hencky import Hencky


class VonMises(Flowing):
    """f = q - (Y + h k) <= 0 with q = sqrt(3/2) |dev tau|; dk = f / (3 mu + h)."""

    @staticmethod
    def update(c, H, L, dt, s):
        e, e_zz, volume = Flowing.strain(H, s)
        D, D_zz, size = Flowing.deviator(e, e_zz, volume)
        excess = np.sqrt(6) * c.mu * size - (c.yield_stress + c.hardening * s.plastic_strain)
        if excess > 0:
            flow = excess / (3 * c.mu + c.hardening)
            s.plastic_strain = s.plastic_strain + flow
            part = -np.sqrt(1.5) * flow / size
            H, s = Flowing.flowed(H, s, part * D, part * D_zz)
            e = e + part * D
        return H, s, Hencky.stress(c, e, volume)

    @staticmethod
    def dissipated_energy(c, H, s):
        return (c.yield_stress + 0.5 * c.hardening * s.plastic_strain) * s.plastic_strain

    @staticmethod
    def plastic_strain(c, H, s):
        return s.plastic_strain
