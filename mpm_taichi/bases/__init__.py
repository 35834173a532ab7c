"""Bases: the functions w_i(x) that carry quantities between particles and nodes.

A basis is a tensor product of 1-D functions.  Its class gives

- `name`            its word in a scene
- `support`         nodes per axis that a particle touches
- `extended`        a particle is a cube of half width l [cells]; others take it as a point
- `modified`        no weight goes behind a wall (kernels/stencil.py); others have ghost nodes there
- `inverse_moment`  D^-1 [1/dx^2] of D = sum_i w_i (x_i - x)(x_i - x)^T; None where D varies
- `moment_vanishes` D has zeros, so nothing may be divided by it
- `bulk_limit`      largest c dt / dx of a filled body, worst transfer (numerics.md 4.3)
- `steepness(l)`    the largest sum_i (dw_i)^2 / w_i [1/dx^2] of one axis, or None where unbounded
- `first(xi)`       first node of the stencil at the grid coordinate xi = x / dx
- `weights(a, l)`   w[k, d] of stencil node k along axis d, a = xi - first(xi)
- `slopes(a, l)`    the derivatives dw[k, d] of the same, per cell
"""

from typing import Literal

from .cubic_boundary import CubicBoundary
from .cubic_bspline import CubicBSpline
from .gimp import GIMP
from .linear import Linear
from .quadratic_boundary import QuadraticBoundary
from .quadratic_bspline import QuadraticBSpline

BASES = (Linear, GIMP, QuadraticBSpline, CubicBSpline, QuadraticBoundary, CubicBoundary)
BasisName = Literal["linear", "gimp", "quadratic", "cubic", "quadratic_boundary", "cubic_boundary"]
