"""Linear elasticity with accumulated small strain: Sulsky, Chen and Schreyer (1994)."""

import numpy as np

from .invariants import volume_strain


class LinearElastic:
    """eps += dt sym(L); sigma = 2 mu eps + lam tr(eps) I; tau = J sigma; psi = J/2 sigma : eps."""

    @staticmethod
    def cauchy_stress(c, strain):
        return 2 * c.mu * strain + c.lam * strain.trace() * np.eye(len(strain))

    @staticmethod
    def update(c, H, L, dt, s):
        s.strain = s.strain + 0.5 * dt * (L + L.T)
        tau = (1 + volume_strain(H)) * LinearElastic.cauchy_stress(c, s.strain)
        return H, s, tau

    @staticmethod
    def energy_density(c, H, s):
        sigma = LinearElastic.cauchy_stress(c, s.strain)
        return 0.5 * (1 + volume_strain(H)) * (sigma * s.strain).sum()

    @staticmethod
    def out_of_plane_stress(c, H, s):
        return (1 + volume_strain(H)) * c.lam * s.strain.trace()
