"""St. Venant-Kirchhoff solid in logarithmic strain: Hencky (1928), Z. Tech. Phys. 9; Klar et al.
(2016), Drucker-Prager elastoplasticity for sand animation, section 6."""

from typing import Literal

import taichi as ti

from .elastic import Elastic
from .invariants import left_strain, log_volume_ratio, volume_strain
from .symmetric import logarithm


class Hencky(Elastic):
    """psi = mu e : e + lam/2 (tr e)^2;  tau = 2 mu e + lam tr(e) I;  e = ln(F F^T) / 2.

    Linear in the logarithms of the stretches, as stiff in compression as in tension; softens where
    it is stretched far."""

    type: Literal["hencky"]

    @staticmethod
    @ti.func
    def strain(H):
        return 0.5 * logarithm(left_strain(H))

    @staticmethod
    @ti.func
    def stress(c, e, volume):
        """tau of the strain e, whose trace, that across the plane included, is `volume`."""
        tau = 2.0 * c.mu * e
        for d in ti.static(range(e.n)):
            tau[d, d] += c.lam * volume
        return tau

    @staticmethod
    @ti.func
    def update(c, H, L, dt, s):
        e = Hencky.strain(H)
        return H, s, Hencky.stress(c, e, e.trace())

    @staticmethod
    @ti.func
    def energy_density(c, H, s):
        e = Hencky.strain(H)
        return c.mu * e.norm_sqr() + 0.5 * c.lam * e.trace() ** 2

    @staticmethod
    @ti.func
    def out_of_plane_stress(c, H, s):
        return c.lam * log_volume_ratio(volume_strain(H))
