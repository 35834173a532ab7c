"""Hooke's law on small strain that is added up step by step: what linear laws share."""

from math import sqrt
from typing import Any

import numpy as np
import taichi as ti

from .elastic import Elastic
from .invariants import volume_strain


class AccumulatedStrain(Elastic):
    """sigma = 2 mu eps + lam tr(eps) I;  tau = J sigma;  psi = J/2 sigma : eps."""

    def state(self, dim: int) -> dict[str, Any]:
        """The accumulated strain eps [-]."""
        return {"strain": [[0.0] * dim for _ in range(dim)]}

    def start(self, H: np.ndarray) -> dict[str, np.ndarray]:
        return {"strain": 0.5 * (H + H.swapaxes(1, 2))}

    def stiffening(self, dim: int) -> tuple[float, float]:
        """As J; and the stress grows from 0, by dim times the modulus per strain at most."""
        return sqrt(dim) + dim, 0.0

    @staticmethod
    @ti.func
    def cauchy_stress(c, strain):
        sigma = 2.0 * c.mu * strain
        for d in ti.static(range(strain.n)):
            sigma[d, d] += c.lam * strain.trace()
        return sigma

    @staticmethod
    @ti.func
    def kirchhoff_stress(c, H, s):
        return (1.0 + volume_strain(H)) * AccumulatedStrain.cauchy_stress(c, s.strain)

    @staticmethod
    @ti.func
    def moduli(c, H, s):
        """Those of small strain and the stress itself, which turns with a body or does not."""
        J, tau = 1.0 + volume_strain(H), AccumulatedStrain.kirchhoff_stress(c, H, s)
        size = ti.sqrt(tau.norm_sqr())
        wave, lone = c.lam + 2.0 * c.mu, H.n * ti.max(c.lam, 0.0) + 2.0 * c.mu
        return J * wave + size, J * lone + ti.static(sqrt(H.n)) * size

    @staticmethod
    @ti.func
    def energy_density(c, H, s):
        sigma = AccumulatedStrain.cauchy_stress(c, s.strain)
        return 0.5 * (1.0 + volume_strain(H)) * (sigma * s.strain).sum()

    @staticmethod
    @ti.func
    def out_of_plane_stress(c, H, s):
        return (1.0 + volume_strain(H)) * c.lam * s.strain.trace()
