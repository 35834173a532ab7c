"""St. Venant-Kirchhoff solid in logarithmic strain: Hencky (1928), Z. Tech. Phys. 9; Klar et al.
(2016), Drucker-Prager elastoplasticity for sand animation, section 6."""

from typing import Literal

import taichi as ti

from .elastic import Elastic
from .invariants import left_strain, log_volume_ratio, squared_stretches, volume_strain
from .symmetric import logarithm


class Hencky(Elastic):
    """psi = mu e : e + lam/2 (tr e)^2;  tau = 2 mu e + lam tr(e) I;  e = ln(F F^T) / 2.

    Linear in the logarithms of the stretches, as stiff in compression as in tension; softens where
    it is stretched far."""

    type: Literal["hencky"] = "hencky"

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
    def moduli(c, H, s):
        return Hencky.moduli_at(c, H, log_volume_ratio(volume_strain(H)))

    @staticmethod
    @ti.func
    def moduli_at(c, H, volume):
        """A wave along n that moves along a has, in principal axes and with p_i = |a_i n_i|,

            rho0 c^2 <= sum_i D_i p_i^2 + sum_(i != j) C_ij p_i p_j + G (1 - sum_i p_i^2)

        with D_i = lam + 2 mu - tau_i, C_ij = lam + mu y coth y - (tau_i + tau_j) / 2 and
        G = mu (y + y coth y), where 2 y is the difference of the logarithms of b.  The p_i add up
        to 1 at most and D - G is below C, so G + |C| is a bound; y coth y <= 1 + y^2 / 3."""
        least, most = squared_stretches(H)
        low, high = log_volume_ratio(least - 1.0), log_volume_ratio(most - 1.0)
        y = 0.5 * (high - low)
        shear, pressure = c.mu * (1.0 + y * y / 3.0), c.lam * (1.0 - volume)
        softest, stiffest = pressure + c.mu * (1.0 - high), pressure + shear - c.mu * low
        wave = shear + c.mu * y + ti.max(stiffest, ti.max(-softest, 0.0))
        return wave, H.n * ti.max(c.lam, 0.0) + 2.0 * shear

    @staticmethod
    @ti.func
    def energy_density(c, H, s):
        e = Hencky.strain(H)
        return c.mu * e.norm_sqr() + 0.5 * c.lam * e.trace() ** 2

    @staticmethod
    @ti.func
    def out_of_plane_stress(c, H, s):
        return c.lam * log_volume_ratio(volume_strain(H))
