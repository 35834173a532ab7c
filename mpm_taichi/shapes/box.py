"""The box along the axes; in 2D a rectangle."""

from math import prod
from typing import Literal

import numpy as np
from pydantic import Field, model_validator

from ..model import Model, Vector


class Box(Model):
    """min < x < max along each axis."""

    type: Literal["box"] = "box"
    min: Vector = Field(description="corner of the lowest coordinates [m]")
    max: Vector = Field(description="corner of the highest coordinates [m]")

    @model_validator(mode="after")
    def _corners_in_order(self):
        if len(self.min) != len(self.max):
            raise ValueError(
                f"min and max must have equally many coordinates "
                f"(got {len(self.min)} and {len(self.max)})"
            )
        for axis, low, high in zip("xyz", self.min, self.max, strict=False):
            if low >= high:
                raise ValueError(f"min must be below max along {axis} (got {low:g} and {high:g})")
        return self

    @property
    def dimension(self) -> int:
        return len(self.min)

    def bounds(self) -> tuple[np.ndarray, np.ndarray]:
        return np.array(self.min), np.array(self.max)

    def volume(self) -> float:
        """The product of the edges."""
        return prod(high - low for low, high in zip(self.min, self.max, strict=True))

    def signed_distance(self, x: np.ndarray) -> np.ndarray:
        """|max(q, 0)| + min(max_d q_d, 0), where q_d is the distance beyond the faces of axis d."""
        low, high = self.bounds()
        q = np.maximum(low - x, x - high)
        return np.linalg.norm(np.maximum(q, 0), axis=1) + np.minimum(q.max(axis=1), 0)

    def add_to_gmsh(self, gmsh) -> int:
        edges = [high - low for low, high in zip(self.min, self.max, strict=True)]
        if self.dimension == 2:
            return gmsh.model.occ.addRectangle(*self.min, 0, *edges)
        return gmsh.model.occ.addBox(*self.min, *edges)
