"""St. Venant-Kirchhoff solid in logarithmic strain: Hencky (1928), Z. Tech. Phys. 9; Klar et al.
(2016), Drucker-Prager elastoplasticity for sand animation, section 6."""

from typing import Literal

import taichi as ti

from .elastic import Elastic
from .principal import assembled, logarithmic_strains


class Hencky(Elastic):
    """psi = mu sum_i e_i^2 + lam/2 (sum_i e_i)^2 with e_i = ln s_i;  tau_i = 2 mu e_i + lam sum e.

    As stiff in compression as in tension, and linear in ln J; grows softer where stretched."""

    type: Literal["hencky"]

    @staticmethod
    @ti.func
    def principal_stress(c, e):
        """tau_i [3] of the principal strains e [3]."""
        return 2.0 * c.mu * e + c.lam * e.sum()

    @staticmethod
    @ti.func
    def energy_of(c, e):
        return c.mu * e.norm_sqr() + 0.5 * c.lam * e.sum() ** 2

    @staticmethod
    @ti.func
    def update(c, H, L, dt, s):
        e, V = logarithmic_strains(H, 0.0)
        return H, s, assembled(Hencky.principal_stress(c, e), V)

    @staticmethod
    @ti.func
    def energy_density(c, H, s):
        e, _V = logarithmic_strains(H, 0.0)
        return Hencky.energy_of(c, e)

    @staticmethod
    @ti.func
    def out_of_plane_stress(c, H, s):
        e, _V = logarithmic_strains(H, 0.0)
        return c.lam * e.sum()
