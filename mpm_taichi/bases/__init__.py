"""Bases: the functions w_i(x) that carry quantities between particles and nodes.

A basis is a tensor product of 1-D functions.  Its class gives

- `name`            its word in a scene
- `support`         nodes per axis that a particle touches
- `inverse_moment`  D^-1 [1/dx^2] of D = sum_i w_i (x_i - x)(x_i - x)^T; None where D varies
- `steepness`       the largest sum_i (dw_i)^2 / w_i [1/dx^2] of one axis, or None where unbounded
- `bulk_limit`      largest c dt / dx of a filled body, worst transfer (numerics.md 4.3)
- `first(xi)`       first node of the stencil at the grid coordinate xi = x / dx
- `weights(a)`      w[k, d] of stencil node k along axis d, a = xi - first(xi)
- `slopes(a)`       the derivatives dw[k, d] of the same, per cell
"""

from typing import Literal

from .linear import Linear
from .quadratic_bspline import QuadraticBSpline

BASES = (Linear, QuadraticBSpline)
BasisName = Literal["linear", "quadratic"]
