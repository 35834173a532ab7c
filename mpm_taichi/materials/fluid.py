"""Weakly compressible fluid: Tait's equation, Batchelor (1967), section 1.8; Monaghan (1994), J.
Comput. Phys. 110; with Newton's viscosity."""

from math import sqrt
from typing import Any, Literal

import taichi as ti
from pydantic import Field

from ..model import Positive
from .invariants import exp_less_one, isotropic, log_volume_ratio, volume_strain
from .law import MaterialLaw


class Fluid(MaterialLaw):
    """p = K / gamma (J^-gamma - 1), at least - p_t;  tau = J (- p I + 2 eta dev sym L).

    J follows det(I + dt L) up to where p = - p_t.  There the fluid tears: J leaves out the gaps
    that open, and what closes them meets pressure at once.  Remembered, they would grow in spray
    without bound (J = 100) and swallow water when it falls back: an eighth of a dam break in 3 s.

    F is kept as J^(1/dim) I, so that shear leaves no trace.  The viscous stress is that of the rate
    L, whatever dt is.  K is the bulk modulus and sqrt(K / rho) the speed of sound; a tenth of the
    true one and ten times the largest speed are enough."""

    counters = {"cut_off": "tension of a fluid cut off, particles"}

    type: Literal["fluid"] = "fluid"
    bulk_modulus: Positive = Field(description="K at J = 1 [Pa]")
    exponent: float = Field(default=7.0, gt=1, description="gamma [-]")
    viscosity: float = Field(default=0.0, ge=0, description="of shear, eta [Pa s]")
    tension: float = Field(default=0.0, ge=0, description="largest tension p_t [Pa]")

    def constants(self, cell_size: float) -> dict[str, float]:
        K, gamma = self.bulk_modulus, self.exponent
        # J - 1 where p = - p_t; Tait's own tension stays below K / gamma
        tears = 1 - self.tension * gamma / K > 0
        torn = (1 - self.tension * gamma / K) ** (-1 / gamma) - 1 if tears else 1e30
        return {
            "bulk_modulus": K,
            "exponent": gamma,
            "viscosity": self.viscosity,
            "tension": self.tension,
            "torn": torn,
        }

    def state(self, dim: int) -> dict[str, Any]:
        """dissipated: energy per reference volume [J/m^3]; cut_off: steps in which it tore."""
        return {"dissipated": 0.0, "cut_off": 0.0}

    def wave_speed(self) -> float:
        """sqrt(K / rho) [m/s]."""
        return sqrt(self.bulk_modulus / self.density)

    def dilatation_modulus(self, dim: int) -> float:
        return dim * self.bulk_modulus

    def stiffening(self, dim: int) -> tuple[float, float]:
        """As J^(1 - gamma) where it is compressed; as J at most, the suction on a lone particle,
        where it expands."""
        return sqrt(dim), self.exponent - 1

    def shear_viscosity(self) -> float:
        return self.viscosity

    @staticmethod
    @ti.func
    def pressure(c, strain):
        """p [Pa] at J - 1 = strain."""
        return c.bulk_modulus / c.exponent * exp_less_one(-c.exponent * log_volume_ratio(strain))

    @staticmethod
    @ti.func
    def update(c, H, L, dt, s):
        strain = volume_strain(H)
        if strain > c.torn:
            s.cut_off += 1.0
            s.dissipated += c.tension * (strain - c.torn)
            strain = c.torn
        slower = L.trace() / 3.0
        D = 0.5 * (L + L.transpose())
        for d in ti.static(range(H.n)):
            D[d, d] -= slower
        squares = D.norm_sqr()
        if ti.static(H.n == 2):
            squares += slower * slower
        tau = (2.0 * c.viscosity * (1.0 + strain)) * D
        s.dissipated += dt * 2.0 * c.viscosity * (1.0 + strain) * squares
        for d in ti.static(range(H.n)):
            tau[d, d] -= (1.0 + strain) * Fluid.pressure(c, strain)
        return isotropic(H, strain), s, tau

    @staticmethod
    @ti.func
    def moduli(c, H, s):
        """rho0 c^2 = K J^(1 - gamma); for a lone particle the pressure comes off, J p per axis."""
        strain = volume_strain(H)
        power = 1.0 + exp_less_one((1.0 - c.exponent) * log_volume_ratio(strain))
        pressure = (power - 1.0 - strain) / c.exponent
        return c.bulk_modulus * power, H.n * c.bulk_modulus * (power - pressure)

    @staticmethod
    @ti.func
    def energy_density(c, H, s):
        """int p d(-J) from J = 1."""
        strain = volume_strain(H)
        series = 1.0
        for k in ti.static(range(9, 2, -1)):
            series = 1.0 - strain * (c.exponent + k - 2.0) / k * series
        stored = 0.5 * strain * strain * series
        if ti.abs(strain) > 0.02:  # else its two terms would leave few digits
            power = exp_less_one((1.0 - c.exponent) * log_volume_ratio(strain))
            stored = (power / (c.exponent - 1.0) + strain) / c.exponent
        return c.bulk_modulus * stored

    @staticmethod
    @ti.func
    def dissipated_energy(c, H, s):
        return s.dissipated

    @staticmethod
    @ti.func
    def out_of_plane_stress(c, H, s):
        """Of the pressure."""
        strain = volume_strain(H)
        return -(1.0 + strain) * Fluid.pressure(c, strain)
