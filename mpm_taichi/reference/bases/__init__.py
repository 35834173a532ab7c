"""Bases: see mpm_taichi/bases/__init__.py for what a basis gives."""

from .cubic_boundary import CubicBoundary
from .cubic_bspline import CubicBSpline
from .gimp import GIMP
from .linear import Linear
from .quadratic_boundary import QuadraticBoundary
from .quadratic_bspline import QuadraticBSpline

BASES = (Linear, GIMP, QuadraticBSpline, CubicBSpline, QuadraticBoundary, CubicBoundary)
