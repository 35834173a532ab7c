"""Affine particle-in-cell: Jiang, Schroeder, Selle, Teran and Stomakhin (2015)."""

from math import sqrt

import taichi as ti


class APIC:
    """v_p = sum_i w_i v_i and C = B D^-1; the force acts along grad w and L = sum_i v_i grad w_i^T.
    Keeps angular momentum where the stencil is whole."""

    affine = True
    moments = True
    gradient = True
    increment = False
    filtered = False

    @staticmethod
    def isolated_limit(basis, half) -> float | None:
        """sqrt(2 / (H - D^-1 / 2)); where D varies without its second term, which is safe."""
        return sqrt(2 / (basis.steepness(half) - (basis.inverse_moment or 0.0) / 2))

    @staticmethod
    @ti.func
    def affine_momentum(m, C, T, D_inverse):
        return m * C

    @staticmethod
    @ti.func
    def velocity(v_flip, v_pic, alpha):
        return v_pic

    @staticmethod
    @ti.func
    def gradients(B, S, D_inverse):
        return D_inverse * B, S
