"""The command `advise`: which schemes and resolutions were shown to reach an error, and how far a
scene is from those on which they were.

What is known is the table of `benchmarks/speed_vs_error.py`, which says what its entries mean.  A
scene is never changed, and no error is promised for it."""

import json
from importlib.resources import files

from .traits import Traits, traits

MOST_SHOWN = 6
"""Schemes listed for one validation scene."""

CROSSES = 0.25
"""Way of a particle [cells] from which on it may change its cell: 2 per cell and axis sit as far
from its edges."""


def shipped() -> dict:
    """The table that the package ships."""
    path = files("mpm_taichi") / "evidence" / "speed_vs_error.json"
    return json.loads(path.read_text(encoding="utf-8"))


def advise(scene, quantity: str, error: float, table: dict) -> str:
    """Advice in words, from a `table`.  `error` is a part of 1, of the largest exact field."""
    mine = traits(scene)
    known = {name: _traits(content) for name, content in table["experiments"].items()}
    order = sorted(known, key=lambda name: len(differences(mine, known[name])))
    lines = [
        f"error of the {quantity} of at most {_percent(error)}: what reached it on scenes with an "
        "exact solution, cheapest first",
        "cost: CPU time of the steps, over the least that reached it on the same scene; "
        f"measured {table['date'][:10]} ({table['machine']}, one thread, {table['commit']})",
        "",
        f"this scene: {describe(mine)}",
    ]
    for name in order:
        content = table["experiments"][name]
        rows = [row for row in table["rows"] if row["experiment"] == name]
        lines += ["", f"{name}: {content['what']}: {describe(known[name])}"]
        lines += [f"  unlike this scene: {text}" for text in differences(mine, known[name])]
        lines += _reached(rows, quantity, error)
    warnings = list(_warnings(scene, mine, known, table["rows"], quantity, error))
    return "\n".join([*lines, "", *warnings])


def differences(mine: Traits, other: Traits) -> list[str]:
    """What makes a scene harder than another, or of another kind."""
    found = []
    if mine.motion >= CROSSES > other.motion:
        found.append("there, particles stay in their cells")
    if mine.strain > 2 * other.strain:
        found.append(f"strained {mine.strain / other.strain:.2g} times as much")
    if others := sorted(set(mine.laws) - set(other.laws)):
        found.append(f"law {', '.join(others)}")
    if mine.dimension > other.dimension:
        found.append(f"{mine.dimension}D, not {other.dimension}D")
    if mine.per_axis < 0.75 * other.per_axis:
        found.append(f"fewer particles per cell and axis, {mine.per_axis:.2g} for "
                     f"{other.per_axis:.2g}")  # fmt: skip
    if mine.walls and not other.walls:
        found.append("walls")
    if mine.bodies > other.bodies:
        found.append(f"{mine.bodies} bodies, which may touch")
    return found


def describe(kind: Traits) -> str:
    """In one line."""
    about = "" if kind.known else "about "
    most = "" if kind.known else "at most "
    return (
        f"{kind.dimension}D, {', '.join(kind.laws)}, {kind.per_axis:.2g} particles per cell and "
        f"axis, {kind.across:.3g} cells across, {most}{kind.motion:.2g} cells of motion, "
        f"strain {about}{kind.strain:.2g}, {'walls' if kind.walls else 'no walls'}"
    )


def _traits(content) -> Traits:
    given = content["traits"]
    return Traits(**given | {"laws": tuple(given["laws"])})


def _reached(rows, quantity, error) -> list[str]:
    """The cheapest run of each scheme that reached the error."""
    good: dict[tuple, dict] = {}
    for row in sorted(filter(_finished, rows), key=lambda row: row["cpu_seconds"]):
        if row["errors"].get(quantity, error + 1) <= error:
            good.setdefault((row["scheme"], row["precision"]), row)
    if not good:
        return [f"  no evidence: {_nearest(rows, quantity)}"]
    least = next(iter(good.values()))["cpu_seconds"]
    lines = ["  cost   error     cells across  scheme"]
    for row in list(good.values())[:MOST_SHOWN]:
        cost = row["cpu_seconds"] / least
        shown = _percent(row["errors"][quantity])
        note = ", which got worse with smaller cells" if _unsteady(row, rows, quantity) else ""
        lines.append(
            f"  {cost:<6.3g} {shown:<9} {row['across']:<13.4g} "
            f"{row['scheme']}, {row['precision']}{note}"
        )
    if len(good) > MOST_SHOWN:
        lines.append(f"  and {len(good) - MOST_SHOWN} that cost more")
    others: dict[tuple, list[dict]] = {}
    for row in rows:
        key = row["scheme"], row["precision"]
        if key not in good:
            others.setdefault(key, []).append(row)
    if others:
        said = ", ".join(
            f"{' '.join(key)} ({_least(runs, quantity)})" for key, runs in others.items()
        )
        lines.append(f"  did not reach it: {said}")
    return lines


def _nearest(rows, quantity) -> str:
    if not any(map(_finished, rows)):
        return "every run failed"
    done = [row for row in filter(_finished, rows) if quantity in row["errors"]]
    if not done:
        return f"no run has a number for the {quantity}"
    best = min(done, key=lambda row: row["errors"][quantity])
    return (
        f"nothing reached it; the least error is {_percent(best['errors'][quantity])}, of "
        f"{best['scheme']} with {best['across']:.4g} cells across"
    )


def _least(rows, quantity) -> str:
    """Error of the best of some runs, and on how fine a grid it was."""
    done = [row for row in filter(_finished, rows) if quantity in row["errors"]]
    if not done:
        return "failed"
    best = min(done, key=lambda row: row["errors"][quantity])
    return f"{_percent(best['errors'][quantity])} with {best['across']:.3g}"


def _unsteady(row, rows, quantity) -> bool:
    """Whether the scheme has a larger error, or none, at some finer resolution."""
    finer = [r for r in rows if _same(row, r) and r["level"] > row["level"]]
    return any(
        not _finished(r) or r["errors"][quantity] > 1.1 * row["errors"][quantity] for r in finer
    )


def _warnings(scene, mine, known, rows, quantity, error):
    """Sentences on where the evidence ends."""
    if mine.motion >= CROSSES:
        yield (
            "warning: particles of this scene may change cells, and the linear basis is not shown "
            f"to converge there{_linear(rows, quantity)}"
        )
    elif scene.method.basis == "linear":
        yield "the linear basis holds as long as particles stay in their cells, as they do here"
    laws = {law for kind in known.values() for law in kind.laws}
    for law in sorted(set(mine.laws) - laws):
        yield f"warning: no validation scene has the law {law} ({', '.join(sorted(laws))} alone)"
    largest = max(kind.strain for kind in known.values())
    if mine.strain > largest:
        yield (
            f"warning: the strain, about {mine.strain:.2g}, is beyond that of all validation "
            f"scenes ({largest:.2g} at most)"
        )
    if mine.bodies > 1:
        yield "warning: no validation scene has bodies that touch"
    if mine.dimension > max(kind.dimension for kind in known.values()):
        yield f"warning: no validation scene is {mine.dimension}D"
    if not any(r["errors"].get(quantity, error + 1) <= error for r in filter(_finished, rows)):
        yield f"no evidence: nothing reached {_percent(error)} in the {quantity} on any scene"
    yield "nothing is promised for this scene: `converge` tells what its own error is"


def _linear(rows, quantity) -> str:
    """How the linear basis fared on the bar that rides."""
    found = []
    mine = [
        r for r in rows if r["experiment"] == "free_bar_riding" and r["scheme"] == "linear flip"
    ]
    for row in sorted(mine, key=lambda row: row["level"]):
        said = _percent(row["errors"][quantity]) if _finished(row) else "failed"
        found.append(f"{said} with {row['across']:.4g}")
    return f": on free_bar_riding {', '.join(found)} cells across" if found else ""


def _finished(row) -> bool:
    return row["failure"] is None


def _same(row, other) -> bool:
    return all(row[key] == other[key] for key in ("experiment", "scheme", "precision"))


def _percent(part: float) -> str:
    return f"{100 * part:.2g} %"
