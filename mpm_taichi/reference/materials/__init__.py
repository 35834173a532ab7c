"""Materials: see mpm_taichi/materials/__init__.py for what a law gives."""

from .fixed_corotated import FixedCorotated
from .linear_elastic import LinearElastic
from .neo_hookean import NeoHookean

MATERIALS = (LinearElastic, NeoHookean, FixedCorotated)
