"""The region between two concentric circles."""

from math import pi
from typing import Literal

import numpy as np
from pydantic import Field, model_validator

from ..model import Model, Positive


class Ring(Model):
    """Points whose distance from a center lies between two radii, in 2D."""

    type: Literal["ring"] = "ring"
    center: list[float] = Field(min_length=2, max_length=2, description="center [m], two entries")
    inner_radius: Positive = Field(description="radius of the hole [m]")
    outer_radius: Positive = Field(description="radius of the rim [m]")

    @model_validator(mode="after")
    def _has_a_width(self):
        if self.inner_radius >= self.outer_radius:
            raise ValueError(
                f"inner_radius must be less than outer_radius, {self.outer_radius:g} "
                f"(got {self.inner_radius:g})"
            )
        return self

    @property
    def dimension(self) -> int:
        return 2

    def bounds(self) -> tuple[np.ndarray, np.ndarray]:
        """Corners of the smallest box around it [m]."""
        center = np.array(self.center, float)
        return center - self.outer_radius, center + self.outer_radius

    def volume(self) -> float:
        """pi (R^2 - r^2) [m^2]."""
        return pi * (self.outer_radius**2 - self.inner_radius**2)

    def signed_distance(self, x: np.ndarray) -> np.ndarray:
        """max(|x - center| - R, r - |x - center|) [m]."""
        distance = np.linalg.norm(x - self.center, axis=1)
        return np.maximum(distance - self.outer_radius, self.inner_radius - distance)

    def add_to_gmsh(self, gmsh) -> int:
        """A disk with a smaller one cut out; returns the tag of the surface."""
        outer, inner = (
            gmsh.model.occ.addDisk(*self.center, 0, radius, radius)
            for radius in (self.outer_radius, self.inner_radius)
        )
        [(_, tag)], _ = gmsh.model.occ.cut([(2, outer)], [(2, inner)])
        return tag
