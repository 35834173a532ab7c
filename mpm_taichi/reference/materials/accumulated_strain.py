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
    def energy_density(c, H, s):
        sigma = AccumulatedStrain.cauchy_stress(c, s.strain)
        return 0.5 * (1 + volume_strain(H)) * (sigma * s.strain).sum()

    @staticmethod
    def out_of_plane_stress(c, H, s):
        return (1 + volume_strain(H)) * c.lam * s.strain.trace()
