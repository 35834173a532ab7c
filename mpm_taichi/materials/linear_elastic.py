"""Linear elasticity with accumulated small strain: Sulsky, Chen and Schreyer (1994)."""

from typing import Literal

import numpy as np
import taichi as ti

from .elastic import Elastic
from .invariants import volume_strain


class LinearElastic(Elastic):
    """eps += dt sym(L);  sigma = 2 mu eps + lam tr(eps) I;  tau = J sigma;  psi = J/2 sigma : eps.

    The stress does not rotate with the body: for small strain and small rotation, and for the
    published two disks, which were computed so."""

    type: Literal["linear_elastic"]

    def state(self, dim: int) -> dict[str, list]:
        """The accumulated strain eps [-]."""
        return {"strain": [[0.0] * dim for _ in range(dim)]}

    def start(self, H: np.ndarray) -> dict[str, np.ndarray]:
        return {"strain": 0.5 * (H + H.swapaxes(1, 2))}

    @staticmethod
    @ti.func
    def cauchy_stress(c, strain):
        sigma = 2.0 * c.mu * strain
        for d in ti.static(range(strain.n)):
            sigma[d, d] += c.lam * strain.trace()
        return sigma

    @staticmethod
    @ti.func
    def update(c, H, L, dt, s):
        s.strain += (0.5 * dt) * (L + L.transpose())
        tau = (1.0 + volume_strain(H)) * LinearElastic.cauchy_stress(c, s.strain)
        return H, s, tau

    @staticmethod
    @ti.func
    def energy_density(c, H, s):
        sigma = LinearElastic.cauchy_stress(c, s.strain)
        return 0.5 * (1.0 + volume_strain(H)) * (sigma * s.strain).sum()

    @staticmethod
    @ti.func
    def out_of_plane_stress(c, H, s):
        return (1.0 + volume_strain(H)) * c.lam * s.strain.trace()
