"""What all laws have: a density, a history, and answers that most laws share."""

from math import sqrt
from typing import Any, ClassVar

import numpy as np
import taichi as ti
from pydantic import Field

from ..model import Model, Positive
from .invariants import volume_strain


class MaterialLaw(Model):
    """A law without history, whose deformation is all stored: nothing flows, nothing is lost.

    `counters` names the histories that count how often something was cut off, each with what that
    is; `invertible` says that the law answers to det F <= 0 too."""

    counters: ClassVar[dict[str, str]] = {}
    invertible: ClassVar[bool] = False

    density: Positive = Field(description="mass per volume at the start [kg/m^3]")

    def state(self, dim: int) -> dict[str, Any]:
        return {}

    def start(self, H: np.ndarray) -> dict[str, np.ndarray]:
        """The history variables of particles that start with H [n, dim, dim]."""
        return {
            name: np.broadcast_to(value, (len(H), *np.shape(value))).astype(float)
            for name, value in self.state(H.shape[1]).items()
        }

    def stiffening(self, dim: int) -> tuple[float, float]:
        """By what part its moduli may grow: the larger of the first number times a small strain
        (Frobenius norm) and the second times its compression - div u.  Here as J^2 does, which
        grows by 2 sqrt(dim) per strain where it grows fastest."""
        return 2 * sqrt(dim), 0.0

    def shear_viscosity(self) -> float:
        """eta [Pa s], which limits the time step."""
        return 0.0

    @staticmethod
    @ti.func
    def volume_ratio(c, H, s):
        return 1.0 + volume_strain(H)

    @staticmethod
    @ti.func
    def dissipated_energy(c, H, s):
        return 0.0

    @staticmethod
    @ti.func
    def plastic_strain(c, H, s):
        return 0.0
