"""Linear elasticity with accumulated small strain: Sulsky, Chen and Schreyer (1994)."""

from .accumulated_strain import AccumulatedStrain


class LinearElastic(AccumulatedStrain):
    """eps += dt sym(L);  sigma = 2 mu eps + lam tr(eps) I;  tau = J sigma."""

    @staticmethod
    def update(c, H, L, dt, s):
        s.strain = s.strain + 0.5 * dt * (L + L.T)
        return H, s, AccumulatedStrain.kirchhoff_stress(c, H, s)
