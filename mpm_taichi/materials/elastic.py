"""What all isotropic elastic materials have: density, Young's modulus, Poisson's ratio."""

from math import sqrt

import numpy as np
from pydantic import Field

from ..model import Model, Positive


class Elastic(Model):
    """Isotropic elasticity at small strain, the limit of every elastic law here."""

    density: Positive = Field(description="mass per volume at the start [kg/m^3]")
    youngs_modulus: Positive = Field(description="Young's modulus E [Pa]")
    poissons_ratio: float = Field(gt=-1, lt=0.5, description="Poisson's ratio nu [-]")

    def constants(self, cell_size: float) -> dict[str, float]:
        """Lame parameters mu and lam [Pa]."""
        E, nu = self.youngs_modulus, self.poissons_ratio
        return {"mu": E / (2 * (1 + nu)), "lam": E * nu / ((1 + nu) * (1 - 2 * nu))}

    def state(self, dim: int) -> dict[str, list]:
        return {}

    def start(self, H: np.ndarray) -> dict[str, np.ndarray]:
        """The history variables of particles that start with H [n, dim, dim]."""
        return {
            name: np.broadcast_to(value, (len(H), *np.shape(value))).astype(float)
            for name, value in self.state(H.shape[1]).items()
        }

    def wave_speed(self) -> float:
        """sqrt((lam + 2 mu) / rho) [m/s]."""
        c = self.constants(1.0)
        return sqrt((c["lam"] + 2 * c["mu"]) / self.density)

    def dilatation_modulus(self, dim: int) -> float:
        """M_d = dim lam + 2 mu [Pa]: stiffness against the strain that a lone particle feels."""
        c = self.constants(1.0)
        return dim * c["lam"] + 2 * c["mu"]
