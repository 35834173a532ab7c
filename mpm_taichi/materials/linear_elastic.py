"""Linear elasticity with accumulated small strain: Sulsky, Chen and Schreyer (1994)."""

from typing import Literal

import taichi as ti

from .accumulated_strain import AccumulatedStrain


class LinearElastic(AccumulatedStrain):
    """eps += dt sym(L);  sigma = 2 mu eps + lam tr(eps) I;  tau = J sigma;  psi = J/2 sigma : eps.

    The stress does not rotate with the body: for small strain and small rotation, and for the
    published two disks, which were computed so."""

    type: Literal["linear_elastic"] = "linear_elastic"

    @staticmethod
    @ti.func
    def update(c, H, L, dt, s):
        s.strain += (0.5 * dt) * (L + L.transpose())
        return H, s, AccumulatedStrain.kirchhoff_stress(c, H, s)
