"""Where things are in a window of a given size."""

from typing import NamedTuple

PANEL = 300
"""Columns of the widgets, on the right."""

CHART = 250
"""Rows of the chart below them."""

NOTES = 320
"""Rows of what is told in numbers, below the canvas."""

LEAST = 64


class Box(NamedTuple):
    """Pixels, from the upper left corner of the window."""

    left: int
    top: int
    width: int
    height: int

    def holds(self, column: float, row: float) -> bool:
        across, down = column - self.left, row - self.top
        return 0 <= across < self.width and 0 <= down < self.height


class Layout(NamedTuple):
    width: int
    height: int
    canvas: Box
    panel: Box
    chart: Box
    notes: Box


def layout_of(width: int, height: int, has_notes: bool) -> Layout:
    """Whatever the size, each box has room; in a tiny window they overlap."""
    width, height = max(width, 2 * LEAST), max(height, 2 * LEAST)
    panel = min(PANEL, width - LEAST)
    chart = min(CHART, height - LEAST)
    notes = min(NOTES, height - LEAST) if has_notes else 0
    canvas = Box(0, 0, width - panel, height - notes)
    return Layout(
        width,
        height,
        canvas,
        Box(canvas.width, 0, panel, height - chart),
        Box(canvas.width, height - chart, panel, chart),
        Box(0, canvas.height, canvas.width, notes),
    )
