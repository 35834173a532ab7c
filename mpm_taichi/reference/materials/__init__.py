"""Materials: see mpm_taichi/materials/__init__.py for what a law gives."""

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
