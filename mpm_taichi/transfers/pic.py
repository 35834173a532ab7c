"""Particle-in-cell: Harlow (1964)."""

from math import sqrt

import taichi as ti


class PIC:
    """v_p = sum_i w_i v_i: each step averages the velocity twice, so motion on the scale of a cell
    is lost within a few steps."""

    affine = False
    moments = False
    gradient = True
    increment = False
    filtered = False

    @staticmethod
    def isolated_limit(basis, half) -> float | None:
        """sqrt(2 / H)."""
        steepness = basis.steepness(half)
        return sqrt(2 / steepness) if steepness else None

    @staticmethod
    @ti.func
    def velocity(v_flip, v_pic, alpha):
        return v_pic

    @staticmethod
    @ti.func
    def gradients(B, S, D_inverse):
        return 0.0 * S, S
