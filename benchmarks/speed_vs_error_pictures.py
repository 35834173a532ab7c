"""Pictures of speed against error: color is the basis, marker the transfer, line the stress order,
a hollow marker f32; a broad gray line the Pareto front; a cross at the upper edge a failure."""

from pathlib import Path
from typing import Any

COLORS = {
    "linear": "#d55e00", "gimp": "#e69f00", "quadratic": "#0072b2", "cubic": "#009e73",
    "quadratic_boundary": "#56b4e9", "cubic_boundary": "#cc79a7",
}  # fmt: skip
"""Okabe and Ito: distinct for the color-blind too."""

MARKERS = {
    "pic": "v", "flip": "o", "flip 0.99": "^", "xpic 2": "P", "xpic 5": "p", "apic": "D",
    "tpic": "*", "mls": "s",
}  # fmt: skip
STYLES = {"usl": "-", "musl": "--", "usf": ":"}
PANELS = {
    "speed_vs_error_bar": ("free_bar", "free_bar_riding"),
    "speed_vs_error_small_strain": ("manufactured_1d",),
    "speed_vs_error_square": ("manufactured_2d",),
    "speed_vs_error_vortex": ("vortex 2 x 2", "vortex 5 x 5"),
}
TITLES = {
    "free_bar": "Bar at rest in the grid", "free_bar_riding": "The same bar, crossing cells",
    "manufactured_1d": "Bar between walls, strain 3e-4",
    "manufactured_2d": "Square between walls, strain 0.16",
    "vortex 2 x 2": "Wrung ring, 2 x 2 particles per cell",
    "vortex 5 x 5": "Wrung ring, 5 x 5 particles per cell",
}  # fmt: skip
WORST = 3.0
"""Largest error shown: what is above has failed."""


def draw(folder: Path, rows: list[dict]) -> None:
    """A picture for each scene, what is at rest beside what moves."""
    from matplotlib.figure import Figure

    folder.mkdir(parents=True, exist_ok=True)
    for name, experiments in PANELS.items():
        shown = [e for e in experiments if any(row["experiment"] == e for row in rows)]
        if not shown:
            continue
        figure = Figure(figsize=(2.6 + 4.7 * len(shown), 5.4), layout="constrained")
        panels = figure.subplots(1, len(shown), sharex=True, sharey=True, squeeze=False)[0]
        mine = [row for row in rows if row["experiment"] in shown]
        for axes, experiment in zip(panels, shown, strict=True):
            _panel(axes, [row for row in mine if row["experiment"] == experiment])
            axes.set_title(TITLES[experiment])
            axes.set_xlabel("CPU time of the steps [s], one thread")
        panels[0].set_ylabel("error of the displacement [%], largest over time")
        figure.legend(handles=_legend(mine), loc="outside right center", frameon=False)
        figure.savefig(folder / f"{name}.png", dpi=100, pil_kwargs={"optimize": True})


def _panel(axes, rows):
    from matplotlib.ticker import LogLocator, NullFormatter

    axes.set(xscale="log", yscale="log")
    for axis, ticks in ((axes.xaxis, (1, 2, 5)), (axes.yaxis, (1, 3))):
        axis.set_major_locator(LogLocator(subs=ticks))
        axis.set_major_formatter(lambda value, _: f"{value:.3g}")
        axis.set_minor_formatter(NullFormatter())
    lines = dict.fromkeys((row["scheme"], row["precision"]) for row in rows)
    for scheme, precision in lines:
        mine = [row for row in rows if (row["scheme"], row["precision"]) == (scheme, precision)]
        good = [row for row in mine if _is_shown(row)]
        axes.plot(
            [row["cpu_seconds"] for row in good],
            [100 * row["errors"]["displacement"] for row in good],
            **_look(mine[0]), markersize=6, linewidth=1.2,
        )  # fmt: skip
    front = sorted(
        (r["cpu_seconds"], 100 * r["errors"]["displacement"]) for r in rows if _on_front(r)
    )
    axes.plot([x for x, _ in front], [y for _, y in front], color="0.8", linewidth=8, zorder=0)
    _failures(axes, [row for row in rows if not _is_shown(row)])
    axes.grid(which="major", alpha=0.3)
    axes.axhline(1, color="0.4", linewidth=0.8)


def _failures(axes, rows):
    """Side by side along the upper edge, by cells and basis."""
    rows = sorted(rows, key=lambda row: (row["level"], list(COLORS).index(row["basis"])))
    for place, row in enumerate(rows):
        axes.plot(
            (place + 1) / (len(rows) + 1), 0.975, transform=axes.transAxes, clip_on=False,
            **_look(row) | {"marker": "x"}, markersize=8, markeredgewidth=2,
        )  # fmt: skip
    if rows:
        axes.annotate(
            f"{len(rows)} failed", (0.5, 0.955), xycoords="axes fraction", va="top", ha="center",
            fontsize=8,
        )  # fmt: skip


def _is_shown(row) -> bool:
    return row["failure"] is None and row["errors"]["displacement"] <= WORST


def _on_front(row) -> bool:
    return _is_shown(row) and "displacement" in row["pareto"]


def _look(row) -> dict[str, Any]:
    color = COLORS[row["basis"]]
    return {
        "color": color, "marker": MARKERS[row["transfer"]],
        "linestyle": STYLES[row["stress_update"]],
        "markerfacecolor": "white" if row["precision"] == "f32" else color,
    }  # fmt: skip


def _legend(rows) -> list:
    """What occurs, each look once."""
    from matplotlib.lines import Line2D

    def entry(label, **look: Any):
        line = Line2D([], [], label=label, color="0.3")
        line.set(**look)
        return line

    def those(key, looks):
        return [(word, look) for word, look in looks.items() if any(r[key] == word for r in rows)]

    handles = [entry(f"{b} basis", color=c, linewidth=4) for b, c in those("basis", COLORS)]
    handles += [
        entry(t, marker=m, linestyle="none", markersize=7) for t, m in those("transfer", MARKERS)
    ]
    orders = those("stress_update", STYLES)
    if len(orders) > 1:
        handles += [entry(order, linestyle=style) for order, style in orders]
    if any(row["precision"] == "f32" for row in rows):
        handles.append(entry("f32", marker="o", linestyle="none", markerfacecolor="white"))
    if not all(map(_is_shown, rows)):
        handles.append(entry("failed", marker="x", linestyle="none", markeredgewidth=2))
    return [*handles, entry("Pareto front", color="0.8", linewidth=8)]
