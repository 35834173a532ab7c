"""Fluid-implicit particle: Brackbill and Ruppel (1986); the transfer of Sulsky et al. (1994)."""

import taichi as ti

from .pic import PIC


class FLIP(PIC):
    """v_p += sum_i w_i (v_i - v_i^old), while x_p moves with sum_i w_i v_i."""

    increment = True

    @staticmethod
    @ti.func
    def velocity(v_flip, v_pic, alpha):
        return v_flip
