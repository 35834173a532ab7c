"""Rules for the velocity of a node at a wall with unit normal n, which points into the domain."""

from .separate import Separate
from .slip import Slip
from .sticky import Sticky

RULES = (Sticky, Slip, Separate)
