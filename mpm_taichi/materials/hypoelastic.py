"""Linear elasticity whose stress turns with the body: Truesdell (1955), J. Rational Mech. Anal. 4;
increments like those of Rashid (1993), Int. J. Numer. Methods Eng. 36."""

from typing import Literal

import taichi as ti

from .accumulated_strain import AccumulatedStrain
from .invariants import left_strain


class Hypoelastic(AccumulatedStrain):
    """eps <- R eps R^T + ln V with I + dt L = V R, both to third order in A = V^2 - I;
    sigma = 2 mu eps + lam tr(eps) I,  tau = J sigma,  psi = J/2 sigma : eps.

    Exact in rotation; in the limit of small steps the stress has Jaumann's rate.  No energy stands
    behind it, and closed paths of large strain do work: for stiff bodies, whose strains are
    small."""

    type: Literal["hypoelastic"] = "hypoelastic"

    @staticmethod
    @ti.func
    def update(c, H, L, dt, s):
        f = dt * L
        A = left_strain(f)
        B = A @ A
        inverse = -0.5 * A + 0.375 * B - 0.3125 * B @ A  # V^-1 - I
        turn = f + inverse + inverse @ f  # R - I
        eps = s.strain + turn @ s.strain
        s.strain = eps + eps @ turn.transpose() + 0.5 * A - 0.25 * B + ti.static(1 / 6) * B @ A
        return H, s, AccumulatedStrain.kirchhoff_stress(c, H, s)
