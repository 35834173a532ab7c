"""Log-log picture of a convergence study."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from ..whole_files import beside


def draw_convergence(
    path: Path, title: str, axis: str, curves: Mapping[str, tuple[Sequence, Sequence]]
) -> None:
    """Error against cell size dx [m], a curve (dx, error) for each quantity, of which one has a
    point at least, and the slopes of orders 1 and 2.  Errors of 0 are left out."""
    from matplotlib.figure import Figure  # draws into a file; no display, no global state

    figure = Figure(figsize=(7, 5), layout="constrained")
    axes = figure.add_subplot(xscale="log", yscale="log", title=title)
    for (name, (dx, error)), marker in zip(curves.items(), "os^vD<>Pp*hXd" * 8, strict=False):
        shown = np.array(error, float) > 0
        axes.plot(np.array(dx)[shown], np.array(error)[shown], f"{marker}-", label=name)
    sizes = np.unique([x for dx, _ in curves.values() for x in dx])
    largest = max(y for _, error in curves.values() for y in error)
    for order, style in ((1, ":"), (2, "--")):
        line = largest * (sizes / sizes[-1]) ** order
        axes.plot(sizes, line, style, color="0.5", label=f"order {order}")
    axes.legend()
    axes.set_xticks(sizes, labels=[f"{dx:.3g}" for dx in sizes])
    axes.set_xticks([], minor=True)
    axes.set_xlabel("cell size dx [m]")
    axes.set_ylabel(axis)
    axes.grid(which="both", alpha=0.25)
    with beside(path) as part:
        figure.savefig(part, dpi=150, format="png")
