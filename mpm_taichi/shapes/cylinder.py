"""The circular cylinder along an axis, whole or a sector of it."""

from math import pi
from typing import Literal

import numpy as np
from pydantic import Field, model_validator

from ..model import Model, Positive


class Cylinder(Model):
    """Points up to `radius` from the axis and half the length from the middle, at angles between
    two about the axis: counted from y to z about x, from z to x about y, from x to y about z."""

    type: Literal["cylinder"] = "cylinder"
    center: list[float] = Field(
        min_length=3, max_length=3, description="middle of the axis [m], three entries"
    )
    axis: Literal["x", "y", "z"] = Field(description="direction of the axis")
    radius: Positive = Field(description="radius [m]")
    length: Positive = Field(description="length along the axis [m]")
    from_angle: float = Field(default=0.0, description="where a sector begins [degrees]")
    to_angle: float = Field(default=360.0, description="where a sector ends [degrees]")

    @model_validator(mode="after")
    def _angles_in_order(self):
        if not 0 < self._degrees <= 360:
            raise ValueError(
                f"to_angle must be above from_angle, by 360 degrees at most "
                f"(got {self.from_angle:g} and {self.to_angle:g})"
            )
        return self

    @property
    def dimension(self) -> int:
        return 3

    @property
    def _degrees(self) -> float:
        return self.to_angle - self.from_angle

    @property
    def _axes(self) -> list[int]:
        """The axes of the plane, the first at 0 and the second at 90 degrees, and that across."""
        along = "xyz".index(self.axis)
        return [(along + 1) % 3, (along + 2) % 3, along]

    def bounds(self) -> tuple[np.ndarray, np.ndarray]:
        start, end = self.from_angle, self.to_angle
        turns = np.arange(np.ceil(start / 90), np.floor(end / 90) + 1) * 90
        angles = np.radians([start, *turns, end])
        reach = self.radius * np.stack([np.cos(angles), np.sin(angles)], axis=1)
        if self._degrees < 360:
            reach = np.concatenate([reach, np.zeros((1, 2))])
        low, high = np.empty((2, 3))
        low[self._axes] = *reach.min(axis=0), -0.5 * self.length
        high[self._axes] = *reach.max(axis=0), 0.5 * self.length
        return low + self.center, high + self.center

    def volume(self) -> float:
        """pi r^2 l, of which a sector has its part."""
        return self._degrees / 360 * pi * self.radius**2 * self.length

    def signed_distance(self, x: np.ndarray) -> np.ndarray:
        """Of the distances beyond the rim (or the nearer cut) and beyond the ends, combined as for
        the edges of a box."""
        a, b, along = ((x - self.center)[:, self._axes]).T
        q = np.stack([self._beyond_the_rim(a, b), np.abs(along) - 0.5 * self.length], axis=1)
        return np.linalg.norm(np.maximum(q, 0), axis=1) + np.minimum(q.max(axis=1), 0)

    def _beyond_the_rim(self, a, b):
        """Signed distance in the plane.  A sector is folded about its bisector: what is left has
        one cut, from the center to the rim."""
        beyond = np.hypot(a, b) - self.radius
        if self._degrees == 360:
            return beyond
        half = np.radians(0.5 * self._degrees)
        middle = np.radians(self.from_angle) + half
        along = a * np.cos(middle) + b * np.sin(middle)
        across = np.abs(b * np.cos(middle) - a * np.sin(middle))
        on_cut = np.clip(along * np.cos(half) + across * np.sin(half), 0, self.radius)
        off_cut = np.hypot(along - on_cut * np.cos(half), across - on_cut * np.sin(half))
        return np.maximum(beyond, off_cut * np.sign(across * np.cos(half) - along * np.sin(half)))

    def add_to_gmsh(self, gmsh) -> int:
        """Made along z, then turned: 120 degrees about (1, 1, 1) take z to x, x to y, y to z."""
        occ = gmsh.model.occ
        angle = np.radians(self._degrees)
        tag = occ.addCylinder(0, 0, -0.5 * self.length, 0, 0, self.length, self.radius, angle=angle)
        occ.rotate([(3, tag)], 0, 0, 0, 0, 0, 1, np.radians(self.from_angle))
        occ.rotate([(3, tag)], 0, 0, 0, 1, 1, 1, (self._axes[2] + 1) * 2 * pi / 3)
        occ.translate([(3, tag)], *self.center)
        return tag
