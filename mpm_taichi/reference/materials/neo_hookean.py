"""Compressible neo-Hookean solid: Bonet and Wood (2008), Nonlinear Continuum Mechanics, 6.4.3."""

import numpy as np

from .invariants import left_strain, log_volume_ratio, squared_stretches, volume_strain
from .law import MaterialLaw


class NeoHookean(MaterialLaw):
    """psi = mu/2 (tr b - 3) - mu ln J + lam/2 (ln J)^2;  tau = mu (b - I) + lam ln J I."""

    @staticmethod
    def update(c, H, L, dt, s):
        log_J = log_volume_ratio(volume_strain(H))
        tau = c.mu * left_strain(H) + c.lam * log_J * np.eye(len(H))
        return H, s, tau

    @staticmethod
    def moduli(c, H, s):
        """rho0 c^2 = mu s^2 + mu + lam (1 - ln J), s the stretch along the wave; ln J is at
        least 1 - 1/J."""
        _, most = squared_stretches(H)
        along = c.mu + max(c.lam, c.lam / (1 + volume_strain(H)))
        return along + c.mu * most, len(H) * max(c.lam, 0.0) + 2 * c.mu * most

    @staticmethod
    def energy_density(c, H, s):
        log_J = log_volume_ratio(volume_strain(H))
        return 0.5 * c.mu * left_strain(H).trace() - c.mu * log_J + 0.5 * c.lam * log_J**2

    @staticmethod
    def out_of_plane_stress(c, H, s):
        return c.lam * log_volume_ratio(volume_strain(H))
