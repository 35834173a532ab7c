"""Sand: Drucker-Prager plasticity without dilation, Klar, Gast, Pradhana, Fu, Schroeder, Jiang and
Teran (2016), Drucker-Prager elastoplasticity for sand animation; volume correction of Tampubolon et
al. (2017), Multi-species simulation of porous sand and water mixtures, section 4.3.4."""

from math import cos, inf, radians, sin, sqrt, tan
from typing import Any, Literal

import taichi as ti
from pydantic import Field

from .flowing import Flowing
from .hencky import Hencky
from .invariants import exp_less_one


class DruckerPrager(Flowing):
    """f = |dev tau| - A p - B <= 0 with p = - tr tau / 3.  Shear flows at constant volume, no
    dilation, until f = 0.  Where tr e >= B / (A K) grains lose touch: the stress is zero, and the
    volume that opens, g = ln J - tr e, has to close before there is pressure again.  Without the
    volume correction g is forgotten: sand swells each time that it opens.

    The cone meets the Mohr-Coulomb pyramid with cohesion C in triaxial compression or where sand
    that dilates by the cone's own normal would flow in plane strain:

        compression   A = m sin phi,   B = m C cos phi,   m = 2 sqrt(6) / (3 - sin phi)
        plane_strain  A = m tan phi,   B = m C,   m = 3 sqrt(2) / sqrt(9 + 12 tan^2 phi)"""

    type: Literal["drucker_prager"] = "drucker_prager"
    friction_angle: float = Field(ge=0, lt=90, description="of internal friction, phi [degrees]")
    cohesion: float = Field(default=0.0, ge=0, description="strength without pressure, C [Pa]")
    cone: Literal["compression", "plane_strain"] = Field(
        default="compression",
        description="meets Mohr-Coulomb in triaxial compression or in plane strain",
    )
    volume_correction: bool = Field(
        default=True, description="opened volume has to close before there is pressure again"
    )

    def slope_and_strength(self) -> tuple[float, float]:
        """A [-] and B [Pa]."""
        phi, C = radians(self.friction_angle), self.cohesion
        if self.cone == "plane_strain":
            part = 3 * sqrt(2) / sqrt(9 + 12 * tan(phi) ** 2)
            return part * tan(phi), part * C
        part = 2 * sqrt(6) / (3 - sin(phi))
        return part * sin(phi), part * C * cos(phi)

    def constants(self, cell_size: float) -> dict[str, float]:
        elastic = super().constants(cell_size)
        slope, strength = self.slope_and_strength()
        bulk = elastic["lam"] + 2 * elastic["mu"] / 3
        tear = strength / (slope * bulk) if slope > 0 else (inf if strength > 0 else 0.0)
        return elastic | {
            "slope": slope,
            "strength": strength,
            "tear": min(tear, 1e30),  # a number in f32 too
            "correction": float(self.volume_correction),
        }

    def state(self, dim: int) -> dict[str, Any]:
        """opened: g [-]; plastic_strain: sum of sqrt(2/3) |change of dev e| [-]; dissipated: energy
        per reference volume [J/m^3]."""
        own = {"opened": 0.0, "plastic_strain": 0.0, "dissipated": 0.0}
        return own | super().state(dim)

    @staticmethod
    @ti.func
    def update(c, H, L, dt, s):
        e, e_zz, trial = Flowing.strain(H, s)
        D, D_zz, size = Flowing.deviator(e, e_zz, trial)
        closing = c.correction * s.opened
        volume, part, flows = trial + closing, 1.0, False  # of the new strain, as is `part` D
        largest = (c.strength - c.slope * (c.lam + 2.0 / 3.0 * c.mu) * volume) / (2.0 * c.mu)
        if volume >= (c.tear if s.opened == 0.0 else 0.0):
            s.opened += trial
            volume, part, flows = 0.0, 0.0, True
        elif size > largest or closing > 0.0:
            s.opened -= closing
            flows = True
            if size > largest:
                part = largest / size
            s.plastic_strain += ti.static(sqrt(2 / 3)) * (1.0 - part) * size
        if flows:
            # What flows does so under the stress that is left, not under that of the trial.
            s.dissipated += 2.0 * c.mu * part * (1.0 - part) * size * size
            s.dissipated += (c.lam + 2.0 / 3.0 * c.mu) * volume * (trial - volume)
            swelling = (volume - trial) / 3.0
            change = (part - 1.0) * D
            for d in ti.static(range(H.n)):
                change[d, d] += swelling
            H, s = Flowing.flowed(H, s, change, (part - 1.0) * D_zz + swelling)
            e += change
        return H, s, Hencky.stress(c, e, volume)

    @staticmethod
    @ti.func
    def moduli(c, H, s):
        """Flow without dilation is stiffer than no flow where sand expands and is sheared back:
        volume v and shear q along dev tau give A K v q instead of 2 mu q^2."""
        wave, lone = Flowing.moduli(c, H, s)
        extra = (c.slope * (c.lam + 2.0 / 3.0 * c.mu)) ** 2 / (8.0 * c.mu)
        return wave + extra, lone + H.n * extra

    @staticmethod
    @ti.func
    def volume_ratio(c, H, s):
        return Flowing.volume_ratio(c, H, s) * (1.0 + exp_less_one(s.opened))

    @staticmethod
    @ti.func
    def dissipated_energy(c, H, s):
        return s.dissipated

    @staticmethod
    @ti.func
    def plastic_strain(c, H, s):
        return s.plastic_strain
