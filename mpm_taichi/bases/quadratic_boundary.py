"""Quadratic B-splines modified at walls: Steffen, Kirby and Berzins (2008)."""

from .quadratic_bspline import QuadraticBSpline


class QuadraticBoundary(QuadraticBSpline):
    """Without ghost nodes: beside a wall the function of the node behind it goes to the two nodes
    before it, w_0 += 2 w_-1 and w_1 -= w_-1, as if v_-1 = 2 v_0 - v_1.

    At the wall too sum w_i = 1, sum w_i x_i = x and w_i >= 0; but D vanishes on the wall, and
    the gradients of the node next to it stay where its weight goes to 0, as with hat functions."""

    name = "quadratic_boundary"
    modified = True
    inverse_moment = None
    moment_vanishes = True

    @staticmethod
    def steepness(half) -> float | None:
        return None
