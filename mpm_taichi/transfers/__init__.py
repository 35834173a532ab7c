"""Transfers: what a particle scatters to the nodes and what it takes back.

To node i at r = x_i - x_p a particle gives the mass w_i m, the momentum w_i (m v + A r) and the
impulse T dw_i of its stress, T = - dt V0 tau.  Which of these a transfer has, and how it reads what
the nodes return, is all that a transfer says:

- `affine`     it scatters A
- `moments`    it gathers the moments B = sum_i w_i v_i r^T [m^2/s]
- `gradient`   it scatters T dw_i and gathers S = sum_i v_i dw_i^T [1/s]
- `increment`  it also gathers the change of the nodal velocity, sum_i w_i (v_i - v_i^old) [m/s]
- `filtered`   what the nodes do not see of the velocity is taken away (kernels/residual.py)
- `isolated_limit(basis, half)`  largest dt sqrt(M_d / rho) / dx of a lone particle under USL, where
  M_d = d lam + 2 mu (numerics.md 4.1) and half is its half width [cells]; None where there is none
  above zero
- `affine_momentum(m, C, T, D_inverse)`  A [kg/s], linear in (m, D_inverse)
- `velocity(v_flip, v_pic, alpha)`       the new velocity of the particle [m/s], alpha being the
  part of FLIP where there is a choice
- `gradients(B, S, D_inverse)`           C and L [1/s]
"""

from math import exp
from typing import Annotated, Literal, NamedTuple

from pydantic import Field

from ..model import Model, Positive
from .apic import APIC
from .flip import FLIP
from .flip_blend import FLIPBlend
from .mls import MLS
from .pic import PIC
from .tpic import TPIC
from .xpic import XPIC

TRANSFERS = (PIC, FLIP, FLIPBlend, XPIC, APIC, TPIC, MLS)


class FlipPart(NamedTuple):
    """alpha = ratio exp(- rate dt), the FLIP part of a step of length dt [s]; rate [1/s]."""

    ratio: float = 1.0
    rate: float = 0.0

    def __call__(self, dt: float) -> float:
        return self.ratio * exp(-self.rate * dt)


class PICChoice(Model):
    """Smooth and very dissipative."""

    type: Literal["pic"] = "pic"

    @property
    def transfer(self):
        return PIC


class FLIPChoice(Model):
    """Keeps energy, and noise unless a little PIC is blended in."""

    type: Literal["flip"] = "flip"
    relaxation_time: Positive | None = Field(
        default=None,
        description="time [s] in which PIC takes all but 1/e of the noise: the FLIP part of a step "
        "is exp(-dt / relaxation_time); default: pure FLIP",
    )
    ratio: float | None = Field(
        default=None,
        ge=0,
        le=1,
        description="FLIP part of each step, whatever its length, as many papers give it",
    )

    @property
    def transfer(self):
        return FLIP if self.relaxation_time is None and self.ratio is None else FLIPBlend

    @property
    def flip_part(self) -> FlipPart:
        if self.relaxation_time is not None:
            return FlipPart(rate=1 / self.relaxation_time)
        return FlipPart() if self.ratio is None else FlipPart(self.ratio)


class XPICChoice(Model):
    """Keeps energy and drops noise, for the cost of order - 1 more transfers a step."""

    type: Literal["xpic"] = "xpic"
    order: int = Field(default=2, ge=1, le=20, description="m: 1 is PIC, higher is nearer to FLIP")

    @property
    def transfer(self):
        return XPIC


class APICChoice(Model):
    """Keeps linear and angular momentum."""

    type: Literal["apic"] = "apic"
    force: Literal["mls", "gradient"] = Field(
        default="mls",
        description="stress as part of the affine momentum (MLS-MPM), or along grad w",
    )

    @property
    def transfer(self):
        return MLS if self.force == "mls" else APIC


class TPICChoice(Model):
    """As smooth as APIC, and for every basis."""

    type: Literal["tpic"] = "tpic"

    @property
    def transfer(self):
        return TPIC


Transfer = Annotated[
    PICChoice | FLIPChoice | XPICChoice | APICChoice | TPICChoice, Field(discriminator="type")
]
