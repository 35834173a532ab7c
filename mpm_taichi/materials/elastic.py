"""What all isotropic elastic materials have: Young's modulus and Poisson's ratio."""

from math import sqrt

from pydantic import Field

from ..model import Positive
from .law import MaterialLaw


class Elastic(MaterialLaw):
    """Isotropic elasticity at small strain, the limit of every elastic law here."""

    youngs_modulus: Positive = Field(description="Young's modulus E [Pa]")
    poissons_ratio: float = Field(gt=-1, lt=0.5, description="Poisson's ratio nu [-]")

    def constants(self, cell_size: float) -> dict[str, float]:
        """Lame parameters mu and lam [Pa]."""
        E, nu = self.youngs_modulus, self.poissons_ratio
        return {"mu": E / (2 * (1 + nu)), "lam": E * nu / ((1 + nu) * (1 - 2 * nu))}

    def wave_speed(self) -> float:
        """sqrt((lam + 2 mu) / rho) [m/s]."""
        c = self.constants(1.0)
        return sqrt((c["lam"] + 2 * c["mu"]) / self.density)

    def dilatation_modulus(self, dim: int) -> float:
        """M_d = dim lam + 2 mu [Pa]: stiffness against the strain that a lone particle feels.
        Where lam < 0 it feels shear more."""
        c = self.constants(1.0)
        return dim * max(c["lam"], 0.0) + 2 * c["mu"]
