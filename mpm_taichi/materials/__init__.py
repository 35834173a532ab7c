"""Materials: the law that turns deformation into stress.

A material is a frozen model (what a scene gives, with units) and device functions on the class:

- `constants(cell_size)`  numbers that the device functions read as `c.name`
- `state(dim)`            history variables, name -> value at the start (empty: the law has none)
- `start(H)`              its values [n, ...] for particles that start with H [n, dim, dim]
- `counters`              those of the history that count what was cut off, name -> what that is
- `wave_speed()`          of pressure waves in the undeformed material [m/s]
- `dilatation_modulus(dim)`  M_d = dim lam + 2 mu [Pa], of a lone particle's time-step limit
- `shear_viscosity()`     eta [Pa s]
- `stiffening(dim)`       by what part its moduli may grow: per strain, and per compression
- `update(c, H, L, dt, s)`  -> H, s, tau [Pa], with H = F - I already advanced by dt, L the velocity
  gradient [1/s] and s the state; a law that flows returns the H of what is stored elastically.
  With L = 0 and dt = 0 it only evaluates the stress
- `moduli(c, H, s)`  -> upper bounds of what its stiffness is now [Pa]: of rho0 c^2, c the speed of
  waves in all directions, and of M_d, the largest tau : L per |L|^2 that a small strain of rate L
  adds in unit time.  At rest those of `wave_speed` and `dilatation_modulus`, of sand
  and of gas with artificial viscosity a little more
- `energy_density(c, H, s)`  stored energy per reference volume [J/m^3]
- `dissipated_energy(c, H, s)`  per reference volume, since the start [J/m^3]
- `volume_ratio(c, H, s)`  J, volume by volume at the start [-]
- `plastic_strain(c, H, s)`  equivalent plastic strain [-]
- `out_of_plane_stress(c, H, s)`  tau_zz in plane strain [Pa]

Strain measures come from H without cancellation: b - I = H + H^T + H H^T, J - 1 from invariants.
"""

from typing import Annotated

from pydantic import Field

from .drucker_prager import DruckerPrager
from .fixed_corotated import FixedCorotated
from .fluid import Fluid
from .gas import Gas
from .hencky import Hencky
from .hypoelastic import Hypoelastic
from .linear_elastic import LinearElastic
from .neo_hookean import NeoHookean
from .snow import Snow
from .von_mises import VonMises

MATERIALS = (
    LinearElastic, Hypoelastic, NeoHookean, FixedCorotated, Hencky,
    VonMises, DruckerPrager, Snow, Fluid, Gas,
)  # fmt: skip
Material = Annotated[
    LinearElastic
    | Hypoelastic
    | NeoHookean
    | FixedCorotated
    | Hencky
    | VonMises
    | DruckerPrager
    | Snow
    | Fluid
    | Gas,
    Field(discriminator="type"),
]
