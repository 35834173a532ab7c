"""Where things are in a window of a given size."""

from typing import NamedTuple

PANEL = 300
"""Columns of the widgets, on the right."""

CHART = 250
"""Rows of the chart below them."""

LOG = 300
"""Rows of the log, below the stage."""

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
    stage: Box
    panel: Box
    chart: Box
    log: Box


def layout_of(width: int, height: int, shows_log: bool) -> Layout:
    """Whatever the size, each box has room; in a tiny window they overlap."""
    width, height = max(width, 2 * LEAST), max(height, 2 * LEAST)
    panel = min(PANEL, width - LEAST)
    chart = min(CHART, height - LEAST)
    log = min(LOG, height - LEAST) if shows_log else 0
    stage = Box(0, 0, width - panel, height - log)
    return Layout(
        width,
        height,
        stage,
        Box(stage.width, 0, panel, height - chart),
        Box(stage.width, height - chart, panel, chart),
        Box(0, stage.height, stage.width, log),
    )
