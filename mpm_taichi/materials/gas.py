"""Ideal gas: von Neumann and Richtmyer (1950), J. Appl. Phys. 21, with the linear term of Landshoff
(1955) in the artificial viscosity; as in York, Sulsky and Schreyer (2000)."""

from math import sqrt
from typing import Any, Literal

import numpy as np
import taichi as ti
from pydantic import Field

from ..model import Positive
from .invariants import exp_less_one, isotropic, log_volume_ratio, volume_strain
from .law import MaterialLaw


class Gas(MaterialLaw):
    """p = (gamma - 1) U / J with the internal energy U per reference volume;  tau = - J (p + q) I;

        U <- U (J' / J)^(1 - gamma) - q dJ,    q = rho dx (c0 dx D^2 - c1 a D) where D = tr L < 0

    a is the speed of sound.  U is what the law stores: nothing is lost, and what q takes from the
    motion heats the gas.  F is kept as J^(1/dim) I."""

    type: Literal["gas"] = "gas"
    pressure: Positive = Field(description="at the start, where J = 1 [Pa]")
    heat_ratio: float = Field(default=1.4, gt=1, description="of specific heats, gamma [-]")
    quadratic_viscosity: float = Field(
        default=2.0, ge=0, description="c0 of the artificial viscosity [-]"
    )
    linear_viscosity: float = Field(
        default=1.0, ge=0, description="c1 of the artificial viscosity [-]"
    )

    def constants(self, cell_size: float) -> dict[str, float]:
        return {
            "density": self.density,
            "heat_ratio": self.heat_ratio,
            "quadratic": self.quadratic_viscosity * cell_size,
            "linear": self.linear_viscosity,
            "dx": cell_size,
        }

    def state(self, dim: int) -> dict[str, Any]:
        """energy: U [J/m^3]."""
        return {"energy": self.pressure / (self.heat_ratio - 1)}

    def start(self, H: np.ndarray) -> dict[str, np.ndarray]:
        """Brought to J without heat: U J^(gamma - 1) is that of J = 1."""
        J = np.linalg.det(H + np.eye(H.shape[1]))
        return {"energy": self.pressure / (self.heat_ratio - 1) * J ** (1 - self.heat_ratio)}

    def wave_speed(self) -> float:
        """sqrt(gamma p / rho) [m/s]."""
        return sqrt(self.heat_ratio * self.pressure / self.density)

    def dilatation_modulus(self, dim: int) -> float:
        return dim * self.heat_ratio * self.pressure

    @staticmethod
    @ti.func
    def update(c, H, L, dt, s):
        strain, D = volume_strain(H), L.trace()
        growth = log_volume_ratio(volume_strain(dt * L))
        q = 0.0
        if D < 0.0:
            a = ti.sqrt(c.heat_ratio * (c.heat_ratio - 1.0) * s.energy / c.density)
            q = c.density * c.dx * D * (c.quadratic * D - c.linear * a)  # J q
        s.energy *= 1.0 + exp_less_one((1.0 - c.heat_ratio) * growth)
        s.energy -= q * growth
        tau = ti.Matrix.zero(float, H.n, H.n)
        for d in ti.static(range(H.n)):
            tau[d, d] = -(c.heat_ratio - 1.0) * s.energy - q
        return isotropic(H, strain), s, tau

    @staticmethod
    @ti.func
    def moduli(c, H, s):
        """rho0 c^2 = gamma (gamma - 1) U, and as much more as the linear artificial viscosity makes
        an explicit step shorter: c -> c (c1 + sqrt(1 + c1^2)) (LS-DYNA theory manual, time step
        of solids); the quadratic one is below it wherever dt |grad v| is."""
        elastic = c.heat_ratio * (c.heat_ratio - 1.0) * s.energy
        faster = c.linear + ti.sqrt(1.0 + c.linear * c.linear)
        return faster * faster * elastic, H.n * elastic

    @staticmethod
    @ti.func
    def energy_density(c, H, s):
        return s.energy

    @staticmethod
    @ti.func
    def out_of_plane_stress(c, H, s):
        """Of the pressure."""
        return -(c.heat_ratio - 1.0) * s.energy
