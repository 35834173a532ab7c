"""Metal: von Mises plasticity with linear hardening in logarithmic strain, return to the yield
surface by Simo (1992), Comput. Methods Appl. Mech. Eng. 99, section 3; de Souza Neto, Peric and
Owen (2008), Computational Methods for Plasticity, boxes 7.3 and 14.3."""

from math import sqrt
from typing import Any, Literal

import taichi as ti
from pydantic import Field

from ..model import Positive
from .flowing import Flowing
from .hencky import Hencky


class VonMises(Flowing):
    """f = q - (Y + h k) <= 0 with q = sqrt(3/2) |dev tau| = sqrt(6) mu |dev e|; k is the equivalent
    plastic strain.  The flow is along dev e and keeps the volume: where the trial strain has f > 0

        dk = f / (3 mu + h),   e <- e - sqrt(3/2) dk dev e / |dev e|

    Lost is Y k + h k^2 / 2, all plastic work: what hardening stores is not given back."""

    type: Literal["von_mises"] = "von_mises"
    yield_stress: Positive = Field(description="yield stress Y [Pa], of the Kirchhoff stress")
    hardening: float = Field(
        default=0.0, ge=0, description="rise of the yield stress with plastic strain h [Pa]"
    )

    def constants(self, cell_size: float) -> dict[str, float]:
        return super().constants(cell_size) | {
            "yield_stress": self.yield_stress,
            "hardening": self.hardening,
        }

    def state(self, dim: int) -> dict[str, Any]:
        """plastic_strain: k [-]."""
        return {"plastic_strain": 0.0, **super().state(dim)}

    @staticmethod
    @ti.func
    def update(c, H, L, dt, s):
        e, e_zz, volume = Flowing.strain(H, s)
        D, D_zz, size = Flowing.deviator(e, e_zz, volume)
        excess = ti.static(sqrt(6)) * c.mu * size
        excess -= c.yield_stress + c.hardening * s.plastic_strain
        if excess > 0.0:
            flow = excess / (3.0 * c.mu + c.hardening)
            s.plastic_strain += flow
            part = -ti.static(sqrt(1.5)) * flow / size
            H, s = Flowing.flowed(H, s, part * D, part * D_zz)
            e += part * D
        return H, s, Hencky.stress(c, e, volume)

    @staticmethod
    @ti.func
    def dissipated_energy(c, H, s):
        return (c.yield_stress + 0.5 * c.hardening * s.plastic_strain) * s.plastic_strain

    @staticmethod
    @ti.func
    def plastic_strain(c, H, s):
        return s.plastic_strain
