"""Rules for the velocity of a node at a wall with unit normal n, which points into the domain.

A rule is a class with

- `name`            its word in a scene
- `holds`           the wall also holds what moves along it
- `lets_go`         material may leave the wall
- `velocity(v, n)`  -> v [m/s]
"""

from typing import Literal, NamedTuple

from .separate import Separate
from .slip import Slip
from .sticky import Sticky

RULES = (Sticky, Slip, Separate)
RuleName = Literal["none", "sticky", "slip", "separate", "periodic"]


class Wall(NamedTuple):
    """A rule at one side of the domain: the lower or the upper end of an axis."""

    axis: int
    upper: bool
    rule: type
