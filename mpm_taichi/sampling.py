"""Sampling: how a body becomes material points.

A sampler is a frozen model (what a scene gives) with

- `needs_shape`  whether the body must have a shape, or must have none
- `points(shape, cell_size, dimension)`  -> Points: positions [m] and volumes [m^dim], always in the
  same order.  What cannot be sampled is an InputError
"""

from typing import Annotated, ClassVar, Literal

import numpy as np
from pydantic import Field, model_validator

from .errors import InputError
from .meshes import GmshMesh, MeshFile
from .model import Model, Positive
from .points import Points
from .shapes import Shape

__all__ = ["SAMPLERS", "GmshMesh", "Lattice", "MeshFile", "Points", "Sampling"]

LARGEST_LATTICE = 2**31 - 1
BLOCK = 2**20


class Lattice(Model):
    """The points (k + 1/2) h, k integer, strictly inside the shape; V0 = h^dim for each.

    The lattice is anchored at the origin of the domain.  A point on the surface, to rounding, is
    outside, so that both sides of a symmetric body are alike."""

    type: Literal["lattice"] = "lattice"
    spacing: Positive | None = Field(
        default=None, description="distance h of neighboring points [m]"
    )
    per_cell: int | None = Field(
        default=None,
        ge=1,
        le=1000,
        description="points per cell and axis: h = cell size / per_cell",
    )

    needs_shape: ClassVar[bool] = True

    @model_validator(mode="after")
    def _one_spacing(self):
        if (self.spacing is None) == (self.per_cell is None):
            given = "neither" if self.spacing is None else "both"
            raise ValueError(f"a lattice needs one of spacing and per_cell (got {given})")
        return self

    def distance(self, cell_size: float) -> float:
        """h [m]."""
        if self.per_cell is not None:
            return cell_size / self.per_cell
        assert self.spacing is not None
        return self.spacing

    def points(self, shape: Shape, cell_size: float, dimension: int) -> Points:
        h = self.distance(cell_size)
        low, high = shape.bounds()
        with np.errstate(over="ignore"):
            first, end = np.floor(low / h), np.ceil(high / h)
            candidates = float(np.prod(end - first))
        if not candidates <= LARGEST_LATTICE:
            raise InputError(
                f"a lattice of spacing {h:g} has {candidates:.2g} points around the {shape.type}; "
                f"{LARGEST_LATTICE:.2g} are possible: take a larger spacing"
            )
        counts = (end - first).astype(np.int64)
        blocks: list[np.ndarray] = [np.empty((0, dimension))]
        for start in range(0, int(counts.prod()), BLOCK):
            numbers = np.arange(start, min(start + BLOCK, int(counts.prod())))
            x = (first + np.stack(np.unravel_index(numbers, counts), axis=1) + 0.5) * h
            blocks.append(x[shape.signed_distance(x) < -1e-9 * h])
        x = np.concatenate(blocks)
        if len(x) == 0:
            raise InputError(
                f"a lattice of spacing {h:g} has no point inside the {shape.type}: "
                f"take a smaller spacing (a quarter of the thickness, say)"
            )
        return Points(x, np.full(len(x), h**dimension))


SAMPLERS = (Lattice, GmshMesh, MeshFile)
Sampling = Annotated[Lattice | GmshMesh | MeshFile, Field(discriminator="type")]
