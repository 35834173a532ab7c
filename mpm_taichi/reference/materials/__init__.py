"""Materials: see mpm_taichi/materials/__init__.py for what a law gives."""

from .linear_elastic import LinearElastic
from .neo_hookean import NeoHookean

MATERIALS = (LinearElastic, NeoHookean)
