"""Compressible neo-Hookean solid: Bonet and Wood (2008), Nonlinear Continuum Mechanics, 6.4.3."""

from typing import Literal

import taichi as ti

from .elastic import Elastic
from .invariants import left_strain, log_volume_ratio, squared_stretches, volume_strain


class NeoHookean(Elastic):
    """psi = mu/2 (tr b - 3) - mu ln J + lam/2 (ln J)^2;  tau = mu (b - I) + lam ln J I.

    Stiffens in compression, rotates with the body; J must stay above 0."""

    type: Literal["neo_hookean"] = "neo_hookean"

    @staticmethod
    @ti.func
    def update(c, H, L, dt, s):
        tau = c.mu * left_strain(H)
        pressure = c.lam * log_volume_ratio(volume_strain(H))
        for d in ti.static(range(H.n)):
            tau[d, d] += pressure
        return H, s, tau

    def stiffening(self, dim: int) -> tuple[float, float]:
        """As the square of the largest stretch, or as 1/J."""
        return 2.0, 1.0

    @staticmethod
    @ti.func
    def moduli(c, H, s):
        """rho0 c^2 = mu s^2 + mu + lam (1 - ln J), s the stretch along the wave; ln J is at
        least 1 - 1/J."""
        _least, most = squared_stretches(H)
        along = c.mu + ti.max(c.lam, c.lam / (1.0 + volume_strain(H)))
        return along + c.mu * most, H.n * ti.max(c.lam, 0.0) + 2.0 * c.mu * most

    @staticmethod
    @ti.func
    def energy_density(c, H, s):
        log_J = log_volume_ratio(volume_strain(H))
        return 0.5 * c.mu * left_strain(H).trace() - c.mu * log_J + 0.5 * c.lam * log_J**2

    @staticmethod
    @ti.func
    def out_of_plane_stress(c, H, s):
        return c.lam * log_volume_ratio(volume_strain(H))
