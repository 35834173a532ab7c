"""The ball; in 2D a disk."""

from math import pi
from typing import Literal

import numpy as np
from pydantic import Field

from ..model import Model, Positive, Vector


class Ball(Model):
    """|x - center| < radius."""

    type: Literal["ball"] = "ball"
    center: Vector = Field(description="center [m]")
    radius: Positive = Field(description="radius [m]")

    @property
    def dimension(self) -> int:
        return len(self.center)

    def bounds(self) -> tuple[np.ndarray, np.ndarray]:
        center = np.array(self.center)
        return center - self.radius, center + self.radius

    def volume(self) -> float:
        """pi r^2 in 2D, 4/3 pi r^3 in 3D."""
        return (pi if self.dimension == 2 else 4 / 3 * pi) * self.radius**self.dimension

    def signed_distance(self, x: np.ndarray) -> np.ndarray:
        """|x - center| - radius."""
        return np.linalg.norm(x - np.array(self.center), axis=1) - self.radius

    def add_to_gmsh(self, gmsh) -> int:
        if self.dimension == 2:
            return gmsh.model.occ.addDisk(*self.center, 0, self.radius, self.radius)
        return gmsh.model.occ.addSphere(*self.center, self.radius)
