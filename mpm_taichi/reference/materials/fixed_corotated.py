"""Fixed-corotated solid: Stomakhin, Howes, Schroeder and Teran (2012), Energetically consistent
invertible elasticity."""

import numpy as np

from .invariants import squared_stretches, volume_strain
from .law import MaterialLaw
from .polar import rotation


class FixedCorotated(MaterialLaw):
    """psi = mu sum_i (s_i - 1)^2 + lam/2 (J - 1)^2;  tau = 2 mu (F - R) F^T + lam (J - 1) J I."""

    @staticmethod
    def update(c, H, L, dt, s):
        F, pressure = np.eye(len(H)) + H, FixedCorotated.out_of_plane_stress(c, H, s)
        tau = 2 * c.mu * (H - rotation(H)) @ F.T + pressure * np.eye(len(H))
        return H, s, tau

    @staticmethod
    def moduli(c, H, s):
        """Along the wave rho0 c^2 = 2 mu s^2 + lam J^2, across it less; softer where J is small."""
        _, most = squared_stretches(H)
        stretch, J, lam = np.sqrt(most), 1 + volume_strain(H), max(c.lam, 0.0)
        wave = c.mu * max(2 * most, stretch) + lam * J**2
        lone = 2 * c.mu * FixedCorotated.slope(stretch) + len(H) * lam * FixedCorotated.slope(J)
        return wave, lone

    @staticmethod
    def slope(a):
        """d(a^2 - a) / d ln a = 2 a^2 - a; below 3/4 a^4 of the same value there, which lies above
        it and grows no faster."""
        return a * (2 * a - 1) if a >= 0.75 else 32 / 27 * a**4

    @staticmethod
    def energy_density(c, H, s):
        return c.mu * ((H - rotation(H)) ** 2).sum() + 0.5 * c.lam * volume_strain(H) ** 2

    @staticmethod
    def out_of_plane_stress(c, H, s):
        strain = volume_strain(H)
        return c.lam * strain * (1 + strain)
