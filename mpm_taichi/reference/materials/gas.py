"""Ideal gas with internal energy and artificial viscosity; see mpm_taichi/materials/gas.py."""

import numpy as np

from .invariants import exp_less_one, isotropic, log_volume_ratio, volume_strain
from .law import MaterialLaw


class Gas(MaterialLaw):
    """p = (gamma - 1) U / J;  tau = - J (p + q) I;  U <- U (J' / J)^(1 - gamma) - q dJ."""

    @staticmethod
    def update(c, H, L, dt, s):
        strain, D = volume_strain(H), L.trace()
        growth, q = log_volume_ratio(volume_strain(dt * L)), 0.0
        if D < 0:
            a = np.sqrt(c.heat_ratio * (c.heat_ratio - 1) * s.energy / c.density)
            q = c.density * c.dx * D * (c.quadratic * D - c.linear * a)
        s.energy = s.energy * (1 + exp_less_one((1 - c.heat_ratio) * growth)) - q * growth
        tau = -((c.heat_ratio - 1) * s.energy + q) * np.eye(len(H))
        return isotropic(H, strain), s, tau

    @staticmethod
    def moduli(c, H, s):
        """rho0 c^2 = gamma (gamma - 1) U, more with the linear artificial viscosity."""
        elastic = c.heat_ratio * (c.heat_ratio - 1) * s.energy
        return (c.linear + np.sqrt(1 + c.linear**2)) ** 2 * elastic, len(H) * elastic

    @staticmethod
    def energy_density(c, H, s):
        return s.energy

    @staticmethod
    def out_of_plane_stress(c, H, s):
        return -(c.heat_ratio - 1) * s.energy
