"""Shapes: the regions that bodies fill at the start.

A shape is a frozen model (what a scene gives, lengths in m) with

- `dimension`           2 or 3
- `bounds()`            -> low, high: corners of the smallest box around it [m], float64 [dim]
- `volume()`            exact area (2D) or volume (3D) [m^dim]
- `signed_distance(x)`  [m], float64 [n] for points x [n, dim]: exact, negative inside
- `add_to_gmsh(gmsh)`   -> tag of the entity of full dimension that it adds to the current model
"""

from typing import Annotated

from pydantic import Field

from .ball import Ball
from .box import Box
from .cylinder import Cylinder
from .ring import Ring

SHAPES = (Ball, Box, Cylinder, Ring)
Shape = Annotated[Ball | Box | Cylinder | Ring, Field(discriminator="type")]
