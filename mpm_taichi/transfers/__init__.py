"""Transfers: what a particle scatters to the nodes and what it takes back.

To node i at r = x_i - x_p a particle gives the mass w_i m, the momentum w_i (m v + A r) and the
impulse T dw_i of its stress, T = - dt V0 tau.  Which of these a transfer has, and how it reads what
the nodes return, is all that a transfer says:

- `affine`     it scatters A and gathers the moments B = sum_i w_i v_i r^T [m^2/s]
- `gradient`   it scatters T dw_i and gathers L = sum_i v_i dw_i^T [1/s]
- `increment`  it also gathers the change of the nodal velocity, sum_i w_i (v_i - v_i^old) [m/s]
- `isolated_limit(basis)`  largest dt sqrt(M_d / rho) / dx of a lone particle under USL, where
  M_d = d lam + 2 mu (numerics.md 4.1); None where there is none above zero
- `affine_momentum(m, C, T, D_inverse)`  A [kg/s], linear in (m, D_inverse)
- `velocity(v_flip, v_pic)`              the new velocity of the particle [m/s]
- `gradients(B, S, D_inverse)`           C and L [1/s], S being the gathered sum v_i dw_i^T
"""

from typing import Annotated, Literal

from pydantic import Field

from ..model import Model
from .apic import APIC
from .flip import FLIP
from .mls import MLS
from .pic import PIC

TRANSFERS = (PIC, FLIP, APIC, MLS)


class PICChoice(Model):
    """Smooth and very dissipative."""

    type: Literal["pic"]

    @property
    def transfer(self):
        return PIC


class FLIPChoice(Model):
    """Keeps energy, and noise."""

    type: Literal["flip"]

    @property
    def transfer(self):
        return FLIP


class APICChoice(Model):
    """Keeps linear and angular momentum."""

    type: Literal["apic"]
    force: Literal["mls", "gradient"] = Field(
        "mls", description="stress as part of the affine momentum (MLS-MPM), or along grad w"
    )

    @property
    def transfer(self):
        return MLS if self.force == "mls" else APIC


Transfer = Annotated[PICChoice | FLIPChoice | APICChoice, Field(discriminator="type")]
