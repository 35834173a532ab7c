"""Snow: Stomakhin, Schroeder, Chai, Teran and Selle (2013), A material point method for snow
simulation, ACM Trans. Graph. 32, sections 4 to 6."""

from math import log, sqrt
from typing import Any, Literal

import taichi as ti
from pydantic import Field

from ..model import Positive
from .elastic import Elastic
from .fixed_corotated import FixedCorotated
from .invariants import exp_less_one, left_strain, volume_strain
from .symmetric import SMALL, assembled, eigen, is_above, of_square_root, powers


class Snow(Elastic):
    """Fixed-corotated, with mu and lam times exp(xi (1 - J_P)): packed snow is harder.  Stretches
    of the elastic part stay within [1 - theta_c, 1 + theta_s]; what lies beyond goes into J_P.

    The clamps are no flow along a potential: where a stretch is clamped under pressure from the
    sides, they give back a little energy.  In plane strain the stretch across the plane is 1,
    within the limits: no history.  Hardening is capped, which keeps time steps from vanishing; a
    cap that acts is counted."""

    counters = {"capped": "hardening of snow capped"}

    type: Literal["snow"] = "snow"
    critical_compression: float = Field(gt=0, lt=1, description="theta_c [-]")
    critical_stretch: Positive = Field(description="theta_s [-]")
    hardening: float = Field(ge=0, description="xi [-]")
    largest_hardening: float = Field(
        default=10.0, ge=1, description="largest factor of the Lame parameters [-]"
    )

    def constants(self, cell_size: float) -> dict[str, float]:
        return super().constants(cell_size) | {
            "least": -self.critical_compression,
            "most": self.critical_stretch,
            "hardening": self.hardening,
            "capped_at": log(self.largest_hardening),
        }

    def state(self, dim: int) -> dict[str, Any]:
        """plastic_volume: J_P - 1 [-]; dissipated: energy per reference volume [J/m^3]; capped:
        number of steps."""
        return {"plastic_volume": 0.0, "dissipated": 0.0, "capped": 0.0}

    def stiffening(self, dim: int) -> tuple[float, float]:
        """Packed, it hardens by exp(xi) per J_P; the rest as the fixed-corotated law."""
        return (self.hardening + 4) * sqrt(dim), 0.0

    @staticmethod
    @ti.func
    def hardness(c, s):
        """Factor of the Lame parameters [-]; not below exp(-80), nothing, where J_P is large."""
        power = ti.min(-c.hardening * s.plastic_volume, c.capped_at)
        return 1.0 + exp_less_one(ti.max(power, -80.0))

    @staticmethod
    @ti.func
    def energy_of(c, x, factor):
        """psi of principal stretches 1 + x [dim]."""
        strain = volume_of(x)
        return factor * (c.mu * x.norm_sqr() + 0.5 * c.lam * strain * strain)

    @staticmethod
    @ti.func
    def update(c, H, L, dt, s):
        A, is_elastic, stretch = left_strain(H), False, H
        if A.norm_sqr() < SMALL**2:
            stretch = powers(A, ti.static(of_square_root()))  # of F = V R, V - I
            is_elastic = is_above(stretch, c.least) and is_above(-stretch, -c.most)
        D, factor = A - stretch, Snow.hardness(c, s)  # V^2 - V
        if not is_elastic:
            squares, axes = eigen(A)
            x, y, growth = squares, squares, squares
            for d in ti.static(range(H.n)):
                x[d] = squares[d] / (1.0 + ti.sqrt(1.0 + squares[d]))
                y[d] = ti.min(ti.max(x[d], c.least), c.most)
                growth[d] = (y[d] - x[d]) / (1.0 + x[d])
            s.dissipated += Snow.energy_of(c, x, factor)
            G, kept = assembled(growth, axes), volume_of(y)
            H += G + G @ H
            s.plastic_volume = compound(s.plastic_volume, (volume_of(x) - kept) / (1.0 + kept))
            factor = Snow.hardness(c, s)
            s.dissipated -= Snow.energy_of(c, y, factor)
            D = assembled(y + y * y, axes)
        s.capped += ti.select(-c.hardening * s.plastic_volume > c.capped_at, 1.0, 0.0)
        tau, strain = 2.0 * c.mu * D, volume_strain(H)
        for d in ti.static(range(H.n)):
            tau[d, d] += c.lam * strain * (1.0 + strain)
        return H, s, factor * tau

    @staticmethod
    @ti.func
    def moduli(c, H, s):
        """Those of fixed-corotated snow as hard as it is."""
        factor = Snow.hardness(c, s)
        wave, lone = FixedCorotated.moduli(c, H, s)
        return factor * wave, factor * lone

    @staticmethod
    @ti.func
    def energy_density(c, H, s):
        squares, _V = eigen(left_strain(H))
        x = squares
        for d in ti.static(range(H.n)):
            x[d] = squares[d] / (1.0 + ti.sqrt(1.0 + squares[d]))
        return Snow.energy_of(c, x, Snow.hardness(c, s))

    @staticmethod
    @ti.func
    def dissipated_energy(c, H, s):
        return s.dissipated

    @staticmethod
    @ti.func
    def volume_ratio(c, H, s):
        return (1.0 + volume_strain(H)) * (1.0 + s.plastic_volume)

    @staticmethod
    @ti.func
    def out_of_plane_stress(c, H, s):
        strain = volume_strain(H)
        return Snow.hardness(c, s) * c.lam * strain * (1.0 + strain)


@ti.func
def compound(a, b):
    """(1 + a) (1 + b) - 1."""
    return a + b + a * b


@ti.func
def volume_of(x):
    """J - 1 of principal stretches 1 + x [dim]."""
    strain = x[0]
    for d in ti.static(range(1, x.n)):
        strain = compound(strain, x[d])
    return strain
