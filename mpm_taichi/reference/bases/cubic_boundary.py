"""Cubic B-splines modified at walls: Steffen, Kirby and Berzins (2008)."""

from .cubic_bspline import CubicBSpline


class CubicBoundary(CubicBSpline):
    """Without ghost nodes, as in `quadratic_boundary.py`: the functions of de Vaucorbeil, Nguyen,
    Sinaie and Wu (2020), Advances in Applied Mechanics 53, types 1 to 4."""

    name = "cubic_boundary"
    modified = True
    inverse_moment = None
    moment_vanishes = True

    @staticmethod
    def steepness(half) -> float | None:
        return None
