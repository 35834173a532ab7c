"""Bases: see mpm_taichi/bases/__init__.py for what a basis gives."""

from .linear import Linear
from .quadratic_bspline import QuadraticBSpline

BASES = (Linear, QuadraticBSpline)
