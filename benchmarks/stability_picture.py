"""A matrix of cases and schemes: each cell has a color and a word."""

from pathlib import Path

LOOK = {
    "pass": ("#b8dfc4", "pass"),
    "expected fail": ("#c9d8ec", "fails,\nas expected"),
    "reported": ("#ececec", "reported"),
    "fail": ("#f2b5a0", "FAIL"),
    "passes though it should fail": ("#f5e08a", "passes,\nshould fail"),
}
"""Of each status: color of the cell, word in it."""


def draw(path: Path, rows: list[dict]) -> None:
    """Where precisions or dimensions differ, the worst of them is shown with its precision."""
    from matplotlib.figure import Figure

    cases = list(dict.fromkeys((r["case"], r["title"]) for r in rows))
    schemes = list(dict.fromkeys(r["scheme"] for r in rows))
    figure = Figure(figsize=(2.6 + 1.15 * len(schemes), 1.6 + 0.55 * len(cases)))
    axes = figure.add_subplot()
    for y, (case, _) in enumerate(cases):
        for x, scheme in enumerate(schemes):
            mine = [r for r in rows if r["case"] == case and r["scheme"] == scheme]
            if not mine:
                axes.text(x, y, "-", ha="center", va="center", color="#999999")
                continue
            worst = max(mine, key=lambda r: list(LOOK).index(r["status"]))
            color, word = LOOK[worst["status"]]
            if len({r["status"] for r in mine}) > 1:
                word += f" {worst['precision']} {worst['dimension']}D"
            axes.add_patch(_cell(x, y, color))
            axes.text(x, y, word, ha="center", va="center", fontsize=8)
    axes.set_xlim(-0.5, len(schemes) - 0.5)
    axes.set_ylim(len(cases) - 0.5, -0.5)
    axes.set_xticks(range(len(schemes)), [s.replace(" ", "\n", 1) for s in schemes], fontsize=9)
    axes.set_yticks(range(len(cases)), [f"{name} {title}" for name, title in cases], fontsize=9)
    axes.xaxis.tick_top()
    axes.tick_params(length=0)
    for side in axes.spines.values():
        side.set_visible(False)
    figure.savefig(path, dpi=150, bbox_inches="tight")


def _cell(x, y, color):
    from matplotlib.patches import Rectangle

    return Rectangle((x - 0.47, y - 0.45), 0.94, 0.9, facecolor=color, edgecolor="#666666", lw=0.6)
