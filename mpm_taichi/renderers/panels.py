"""Pictures of curves over time, panel by panel."""

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ..whole_files import beside
from .units import prefix

COLORS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#000000", "#56b4e9", "#e69f00")
"""Told apart by the color-blind too: Okabe and Ito (2008), Color Universal Design."""

DASHES = ("-", (0, (6, 2)), (0, (2, 1.5)), (0, (6, 1.5, 1.5, 1.5)))
WIDTHS = (2.6, 2.0, 1.6, 1.2)
"""Of the styles, so that a curve under another one shows."""


class Curve(NamedTuple):
    """A quantity over time [s]; curves of one `style` look alike in all panels."""

    label: str
    time: np.ndarray
    value: np.ndarray
    style: int


class Panel(NamedTuple):
    """Curves with a common unit.  `span`: what the axis shows at least on both sides of 0;
    `levels`: values to compare with, by their labels."""

    quantity: str
    unit: str
    curves: Sequence[Curve]
    span: float = 0.0
    levels: dict[str, float] = {}


def draw_panels(path: Path, title: str, panels: Sequence[Panel], columns: int) -> None:
    """A PNG file, which appears whole.  Where all panels have the same curves, one legend below
    them explains these."""
    from matplotlib.figure import Figure  # draws into a file; no display, no global state

    columns = min(columns, len(panels))
    rows = -(-len(panels) // columns)
    figure = Figure(figsize=(9.5 if columns == 1 else 12, 1 + 2.8 * rows), layout="constrained")
    if title:
        figure.suptitle(title, fontsize="large")
    grid = figure.subplots(rows, columns, squeeze=False)
    latest = max(curve.time.max() for panel in panels for curve in panel.curves)
    alike = len({tuple(curve.label for curve in panel.curves) for panel in panels}) == 1
    seconds, time_prefix = prefix(latest)
    for number, (axes, panel) in enumerate(zip(grid.flat, panels, strict=False)):
        _draw(axes, panel, seconds)
        axes.set_xlim(0, latest / seconds)
        if number + columns >= len(panels):
            axes.set_xlabel(f"time [{time_prefix}s]")
        if not alike:
            axes.legend(loc="center left", bbox_to_anchor=(1.005, 0.5), frameon=False)
    for axes in grid.flat[len(panels) :]:
        axes.set_axis_off()
    if alike:
        lines, labels = grid.flat[0].get_legend_handles_labels()
        figure.legend(lines, labels, loc="outside lower center", ncols=3, frameon=False)
    with beside(path) as part:
        figure.savefig(part, dpi=150, format="png")


def _draw(axes, panel: Panel, seconds: float) -> None:
    """The axis shows 0."""
    values = np.concatenate([curve.value for curve in panel.curves] + [list(panel.levels.values())])
    values = values[np.isfinite(values)]
    low = min(values.min(initial=0.0), -panel.span)
    high = max(values.max(initial=0.0), panel.span)
    compound = " " in panel.unit  # no prefix makes that a handy unit
    factor, unit_prefix = (1.0, "") if compound else prefix(max(-low, high))
    for curve in panel.curves:
        axes.plot(
            curve.time / seconds, curve.value / factor, label=curve.label,
            color=COLORS[curve.style % len(COLORS)], ls=DASHES[curve.style % len(DASHES)],
            lw=WIDTHS[curve.style % len(WIDTHS)],
        )  # fmt: skip
    for number, (label, level) in enumerate(panel.levels.items()):
        axes.axhline(level / factor, color="0.45", lw=1.1, ls=DASHES[number % 4], label=label)
    margin = 0.06 * (high - low) or 1.0
    axes.set_ylim((low - margin) / factor, (high + margin) / factor)
    axes.set_ylabel(f"{panel.quantity} [{unit_prefix}{panel.unit}]")
    axes.ticklabel_format(axis="y", useOffset=False, scilimits=(-3, 5))
    axes.grid(alpha=0.25)
