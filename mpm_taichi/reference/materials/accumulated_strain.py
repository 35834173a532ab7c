"""Hooke's law on small strain that is added up step by step: what linear laws share."""

import numpy as np

from .invariants import volume_strain
from .law import MaterialLaw


class AccumulatedStrain(MaterialLaw):
    """sigma = 2 mu eps + lam tr(eps) I;  tau = J sigma;  psi = J/2 sigma : eps."""

    @staticmethod
    def cauchy_stress(c, strain):
        return 2 * c.mu * strain + c.lam * strain.trace() * np.eye(len(strain))

    @staticmethod
    def kirchhoff_stress(c, H, s):
        return (1 + volume_strain(H)) * AccumulatedStrain.cauchy_stress(c, s.strain)

    @staticmethod
    def moduli(c, H, s):
        """Those of small strain and the stress itself, which turns with a body or does not."""
        J, size = 1 + volume_strain(H), np.linalg.norm(AccumulatedStrain.kirchhoff_stress(c, H, s))
        wave, lone = c.lam + 2 * c.mu, len(H) * max(c.lam, 0.0) + 2 * c.mu
        return J * wave + size, J * lone + np.sqrt(len(H)) * size

    @staticmethod
    def energy_density(c, H, s):
        sigma = AccumulatedStrain.cauchy_stress(c, s.strain)
        return 0.5 * (1 + volume_strain(H)) * (sigma * s.strain).sum()

    @staticmethod
    def out_of_plane_stress(c, H, s):
        return (1 + volume_strain(H)) * c.lam * s.strain.trace()
