"""Pictures without a display, Vulkan or GPU: `draw` makes one, `write_png` stores it."""

from .picture import Frame, draw
from .png import write_png

__all__ = ["Frame", "draw", "write_png"]
