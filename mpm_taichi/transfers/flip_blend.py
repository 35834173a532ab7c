"""FLIP with a little PIC: Zhu and Bridson (2005), with the part given by a time."""

import taichi as ti

from .flip import FLIP


class FLIPBlend(FLIP):
    """v_p = alpha v_FLIP + (1 - alpha) v_PIC: velocity that the nodes do not see decays as alpha^n
    in n steps.  alpha = exp(-dt / relaxation time) makes that independent of dt."""

    @staticmethod
    @ti.func
    def velocity(v_flip, v_pic, alpha):
        return v_pic + alpha * (v_flip - v_pic)
