"""The commands `plot` and `compare`: histories of runs as curves."""

from collections.abc import Sequence
from importlib.util import find_spec
from itertools import count
from pathlib import Path

import numpy as np

from .errors import InputError
from .history_table import read_history
from .renderers.ledger import draw_ledger
from .renderers.panels import Curve, Panel, draw_panels
from .run_folder import read_report

ENERGIES = ("kinetic_energy", "elastic_energy", "dissipated_energy", "gravitational_energy")
GROUPS = {
    "energy": ("J", (*ENERGIES, "total_energy")),
    "momentum": ("kg m/s", ("momentum_x", "momentum_y", "momentum_z")),
    "time step": ("s", ("time_step",)),
}
"""Panels of `plot`: title -> unit and columns."""

AT_REST = 1e-3
"""Of the largest momentum that the kinetic energy allows: what is less looks like 0."""

NEAR = 5.0
"""A limit up to this many times the longest step is drawn; a farther one would press it to 0."""

Table = dict[str, np.ndarray]


def plot(run: Path, output: Path | None, overwrite: bool) -> int:
    """Draw energies, momentum and time step of a run into RUN/plot.png or `output`; of an audited
    one also where its energy has gone, into a picture beside it, ...-ledger.png."""
    _need_matplotlib("plot")
    picture = run / "plot.png" if output is None else output
    ledger = picture.with_name(f"{picture.stem}-ledger.png")
    _refuse(picture, overwrite)
    report, table = read_report(run), table_of(run)
    if "energy_residual" in table:
        _refuse(ledger, overwrite)
    panels = []
    for title, (unit, names) in GROUPS.items():
        drawn = [name for name in names if _is_shown(name, [table])]
        curves = [
            Curve(_words(name), table["time"], table[name], number)
            for number, name in enumerate(drawn)
        ]
        if curves:
            span = _least_momentum([table]) if title == "momentum" else 0.0
            levels = _limits_near(report, table) if title == "time step" else {}
            panels.append(Panel(title, unit, curves, span, levels))
    _draw(picture, f"{_name(run)}: {_described(report)}", panels, 1)
    if "energy_residual" in table:
        draw_ledger(ledger, table, _name(run))
        print(f"picture: {ledger}")
    _tell({str(run): table})
    return 0


def compare(runs: Sequence[Path], output: Path | None, overwrite: bool) -> int:
    """Draw each quantity of two or more runs over each other."""
    _need_matplotlib("compare")
    if output is not None:
        _refuse(output, overwrite)
    if len(runs) < 2:
        raise InputError("compare: name two runs or more")
    reports, tables = [read_report(run) for run in runs], [table_of(run) for run in runs]
    labels = [_name(run) for run in runs]
    if len(set(labels)) < len(labels):
        labels = [str(run) for run in runs]
    panels = []
    for title, (unit, names) in GROUPS.items():
        for name in names:
            if _is_shown(name, tables):
                curves = [
                    Curve(label, table["time"], table[name], number)
                    for number, (label, table) in enumerate(zip(labels, tables, strict=True))
                    if name in table
                ]
                span = _least_momentum(tables) if title == "momentum" else 0.0
                panels.append(Panel(_words(name), unit, curves, span))
    _draw(output or _next_picture(), "", panels, 2)
    for run, report in zip(runs, reports, strict=True):
        print(f"{run}: {_described(report)}")
    _tell(dict(zip(map(str, runs), tables, strict=True)))
    return 0


def table_of(run: Path) -> Table:
    """The history of a run with `total_energy`; the gravitational energy, whose 0 is anywhere,
    counted from the start.  What is no number is nan."""
    path = run / "history.csv"
    table = read_history(path)
    if len(table.get("time", ())) < 2:
        raise InputError(f"{path}: has no two rows yet, so there is nothing to draw")
    for name, values in table.items():
        if values.dtype == float:
            table[name] = np.where(np.isfinite(values), values, np.nan)
    if "gravitational_energy" in table:
        table["gravitational_energy"] = table["gravitational_energy"] - np.nan_to_num(
            table["gravitational_energy"][0]
        )
    energies = [table[name] for name in ENERGIES if name in table]
    if energies:
        table["total_energy"] = np.sum(energies, axis=0)
    if "time_step" in table:  # before the first step there is none
        table["time_step"] = np.where(table["time_step"] > 0, table["time_step"], np.nan)
    return table


def _limits_near(report: dict, table: Table) -> dict[str, float]:
    """The limits of the time step at the start [s], as run.json has them, that are near the steps
    taken: the shortest for each name."""
    longest = np.nan_to_num(table["time_step"]).max()
    shortest = {}
    for limit in report.get("time_step", {}).get("limits_at_start", []):
        if limit["seconds"] <= NEAR * longest:
            shortest.setdefault(limit["name"], limit)  # they are in the order of their length
    return {
        f"{name} limit\nat the start\n({limit['cause']})": limit["seconds"]
        for name, limit in shortest.items()
    }


def _words(name: str) -> str:
    """Of a column."""
    since = ",\nsince the start" if name == "gravitational_energy" else ""
    return name.replace("_", " ") + since


def _is_shown(name: str, tables: Sequence[Table]) -> bool:
    """Whether a run has it; an energy also has to be other than 0 somewhere."""
    columns = [table[name] for table in tables if name in table]
    return any(np.any(np.nan_to_num(column)) or "energy" not in name for column in columns)


def _least_momentum(tables: Sequence[Table]) -> float:
    """What the axis of a momentum shows at least [kg m/s], so that rounding errors are no hills."""
    most = 0.0
    for table in tables:
        if "kinetic_energy" in table and "mass" in table:
            energy = np.nan_to_num(table["kinetic_energy"])
            most = max(most, np.sqrt(2 * np.nan_to_num(table["mass"]) * energy).max())
    return AT_REST * most


def _tell(tables: dict[str, Table]) -> None:
    """What the picture does not show, and why."""
    wanted = [name for _, names in GROUPS.values() for name in names if name != "momentum_z"]
    for run, table in tables.items():
        missing = [name for name in wanted if name not in table]
        if missing:
            print(f"{run}: history.csv has no {', '.join(missing)}")
    still = [name for name in ENERGIES if any(name in table for table in tables.values())]
    still = [name.replace("_", " ") for name in still if not _is_shown(name, list(tables.values()))]
    if still:
        print(f"0 throughout, and not drawn: {', '.join(still)}")


def _described(report: dict) -> str:
    status, steps, time = (report.get(key) for key in ("status", "steps", "time"))
    return f"{status} after {steps} steps, t = {time:.4g} s" if time else f"{status}"


def _name(run: Path) -> str:
    return run.absolute().name


def _draw(picture: Path, title: str, panels: list[Panel], columns: int) -> None:
    if not panels:
        raise InputError("the history has none of the columns that are drawn")
    try:
        picture.parent.mkdir(parents=True, exist_ok=True)
        draw_panels(picture, title, panels, columns)
    except OSError as error:
        raise InputError(f"{picture}: cannot be written: {error}") from None
    print(f"picture: {picture}")


def _refuse(picture: Path, overwrite: bool) -> None:
    if picture.suffix != ".png":
        raise InputError(f"-o {picture}: the picture is a .png file")
    if picture.exists() and not overwrite:
        raise InputError(f"{picture}: is there already; name another one (-o), or add --overwrite")


def _next_picture() -> Path:
    numbered = (Path("runs") / f"compare-{number:03d}.png" for number in count(1))
    return next(path for path in numbered if not path.exists())


def _need_matplotlib(command: str) -> None:
    if find_spec("matplotlib") is None:
        raise InputError(f'{command} draws with matplotlib: pip install "matplotlib>=3.8"')
