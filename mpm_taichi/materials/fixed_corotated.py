"""Fixed-corotated solid: Stomakhin, Howes, Schroeder and Teran (2012), Energetically consistent
invertible elasticity."""

from math import sqrt
from typing import Literal

import taichi as ti

from .elastic import Elastic
from .invariants import squared_stretches, volume_strain
from .polar import rotation


class FixedCorotated(Elastic):
    """psi = mu sum_i (s_i - 1)^2 + lam/2 (J - 1)^2;  tau = 2 mu (F - R) F^T + lam (J - 1) J I, with
    F = R S and s_i the eigenvalues of S: if J < 0, the least singular value is taken negative.

    Rotates with the body, and pushes back also when turned inside out; in plane strain the
    out-of-plane stretch is 1."""

    invertible = True

    type: Literal["fixed_corotated"] = "fixed_corotated"

    @staticmethod
    @ti.func
    def update(c, H, L, dt, s):
        D = H - rotation(H)
        tau = (2.0 * c.mu) * (D + D @ H.transpose())
        pressure = FixedCorotated.out_of_plane_stress(c, H, s)
        for d in ti.static(range(H.n)):
            tau[d, d] += pressure
            for e in ti.static(range(d)):
                tau[d, e] = tau[e, d]  # symmetric to the last bit, and three sums are spared
        return H, s, tau

    def stiffening(self, dim: int) -> tuple[float, float]:
        """As J^4, which grows by 4 sqrt(dim) per strain where it grows fastest."""
        return 4 * sqrt(dim), 0.0

    @staticmethod
    @ti.func
    def moduli(c, H, s):
        """Along the wave rho0 c^2 = 2 mu s^2 + lam J^2, across it less; softer where J is small."""
        _least, most = squared_stretches(H)
        stretch, J, lam = ti.sqrt(most), 1.0 + volume_strain(H), ti.max(c.lam, 0.0)
        wave = c.mu * ti.max(2.0 * most, stretch) + lam * J * J
        lone = 2.0 * c.mu * FixedCorotated.slope(stretch) + H.n * lam * FixedCorotated.slope(J)
        return wave, lone

    @staticmethod
    @ti.func
    def slope(a):
        """d(a^2 - a) / d ln a = 2 a^2 - a; below 3/4 a^4 of the same value there, which lies above
        it and grows no faster."""
        found = a * (2.0 * a - 1.0)
        if a < 0.75:
            found = ti.static(32.0 / 27.0) * a**4
        return found

    @staticmethod
    @ti.func
    def energy_density(c, H, s):
        return c.mu * (H - rotation(H)).norm_sqr() + 0.5 * c.lam * volume_strain(H) ** 2

    @staticmethod
    @ti.func
    def out_of_plane_stress(c, H, s):
        strain = volume_strain(H)
        return c.lam * strain * (1.0 + strain)
