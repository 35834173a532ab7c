"""CPU and wall time of a run against its error, for every scheme, on scenes with an exact solution.

    python benchmarks/speed_vs_error.py [--quick | --full] [--scene free_bar ...]
        [--scheme "quadratic mls" ...] [--rounds N] [--json FILE] [--pictures DIR]

Error: largest over the outputs, relative to the largest exact field; of a bar that rides, to that
of the bar at rest.  dt / dx is that of the scene, the same for all schemes and resolutions: a
scheme that could take longer steps is not given them.  Particles keep their number per cell.

Time: of the stepping alone, one thread; no compiling, no output, no error.  Each run is a process
of its own.  Two at a time they compile, then one at a time they step, in turns A B A B, a tenth of
the run in each (--rounds).  Time = steps times the median of the turns; the interval is from the
second to the last but one (10 turns: 97.9 % for the median), of fewer than six from the first to
the last.  "start" are CPU seconds of compiling, setting up and the first steps; kernels go to a
cache of this run, so bars at rest compile, and those that ride load.

Marks: P nobody is at once cheaper and more accurate (displacement); F failed, with its sentence;
W error above 0.9 of that with cells of twice the size; X known to fail here.

JSON: machine, versions, commit, date, load (of 1 minute, at start and end), threads, rounds, size,
omitted, seconds (of all); experiments: name -> {scene, changes, what, traits (of
mpm_taichi/traits.py)}; rows: {experiment, scheme, basis, transfer, stress_update, precision,
method (section of a scene), level, cells, across (cells along the shortest edge of the body),
particles, steps, dt, courant (c dt / dx), limit, limit_seconds (at the start), errors
{displacement, velocity, stress, energy: parts of 1}, cpu_seconds, wall_seconds (null where it
failed), cpu_interval, wall_interval, turns, coverage (of the intervals), compile_seconds ("start"),
first_calls_seconds (wall), failure, expected (why it is known to fail), worse (W), pareto
(quantities for which it is on the front)}."""

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

from experiments import EVERY, EXPERIMENTS, OMITTED, Scheme
from stepping import SCENES
from throughput import machine
from turns import measure
from verdicts import QUANTITIES, judge

from mpm_taichi import load_scene
from mpm_taichi.report import versions
from mpm_taichi.traits import traits

QUICK = ("linear flip f64", "quadratic mls f64")


def table(rows: list[dict]) -> str:
    head = ["scheme", "prec.", "cells", *(f"{q} %" for q in QUANTITIES)]
    head += ["CPU s", "wall s", "interval", "steps", "start s", "mark"]
    lines = []
    for name in dict.fromkeys(row["experiment"] for row in rows):
        mine = [row for row in rows if row["experiment"] == name]
        about = next((row for row in mine if "courant" in row), None)
        fixed = f"; c dt / dx = {about['courant']:.3g}" if about else ""
        lines += ["", f"{name}: {EXPERIMENTS[name].what}{fixed}", ""]
        body = [cells(row) for row in mine]
        widths = [max(len(row[k]) for row in [head, *body]) for k in range(len(head))]
        failures = ["", "", *(row["failure"] or "" for row in mine)]
        for row, failure in zip([head, ["-" * w for w in widths], *body], failures, strict=True):
            line = " | ".join(cell.ljust(w) for cell, w in zip(row, widths, strict=True))
            lines.append(f"| {line} | {failure}".rstrip())
    return "\n".join(lines)


def cells(row: dict) -> list[str]:
    """Of one line of the table."""

    def number(value):
        return "" if value is None else f"{value:.3g}"

    errors = [row["errors"].get(q) for q in QUANTITIES]
    wall = row["wall_interval"]
    marks = {
        "P": "displacement" in row["pareto"], "F": row["failure"], "W": row["worse"],
        "X": row["expected"],
    }  # fmt: skip
    return [
        row["scheme"], row["precision"], " x ".join(map(str, row.get("cells", "-"))),
        *(number(error and 100 * error) for error in errors),
        number(row["cpu_seconds"]), number(row["wall_seconds"]),
        "" if wall is None else f"{wall[0]:.3g} to {wall[1]:.3g}",
        str(row["steps"]), number(row.get("compile_seconds")),
        " ".join(mark for mark, given in marks.items() if given),
    ]  # fmt: skip


def commit() -> str | None:
    found = subprocess.run(
        ["git", "describe", "--always", "--dirty"],
        cwd=Path(__file__).parent, capture_output=True, text=True,
    )  # fmt: skip
    return found.stdout.strip() or None


def load() -> float | None:
    return round(os.getloadavg()[0], 2) if hasattr(os, "getloadavg") else None


def rounded(value) -> Any:
    """Five digits: what is measured has no more."""
    if isinstance(value, float):
        return float(f"{value:.5g}")
    if isinstance(value, dict):
        return {key: rounded(entry) for key, entry in value.items()}
    return [rounded(entry) for entry in value] if isinstance(value, list | tuple) else value


def write(path: Path, content: dict) -> None:
    """JSON with a row on each line."""
    content = rounded(content)
    rows = ",\n".join(json.dumps(row) for row in content.pop("rows"))
    text = json.dumps(content, indent=1).removesuffix("\n}")
    path.write_text(f'{text},\n "rows": [\n{rows}\n]}}\n')


def about(name: str) -> dict:
    """Of an experiment, with what kind of scene it is."""
    scene, changes, *_ = experiment = EXPERIMENTS[name]
    kind = traits(load_scene(SCENES / f"{scene}.yaml", changes))
    return {
        "scene": f"{scene}.yaml", "changes": list(changes), "what": experiment.what,
        "traits": kind._asdict(),
    }  # fmt: skip


def plan(options) -> dict[str, list[list[Scheme]]]:
    """Experiment -> schemes to run at each resolution."""
    wanted = {}
    scenes = options.scene or (("free_bar", "free_bar_riding") if options.quick else None)
    names = options.scheme or (QUICK if options.quick else None)
    for name, experiment in EXPERIMENTS.items():
        if scenes and experiment.scene not in scenes:
            continue
        levels = experiment.levels
        if options.full:
            levels = (EVERY,) * (len(levels) + 1)
        elif options.scheme:
            levels = (EVERY,) * len(levels)
        wanted[name] = [
            [s for s in level if names is None or str(s) in names or s.with_precision in names]
            for level in (levels[:2] if options.quick else levels)
        ]
    return wanted


def parse(arguments=None):
    scenes = sorted({experiment.scene for experiment in EXPERIMENTS.values()})
    names = sorted({str(scheme) for scheme in EVERY} | {s.with_precision for s in EVERY})
    parser = argparse.ArgumentParser(description="CPU time against error, for every scheme")
    size = parser.add_mutually_exclusive_group()
    size.add_argument("--quick", action="store_true", help="2 schemes, 2 resolutions, bars")
    size.add_argument("--full", action="store_true", help="all schemes, and one resolution more")
    parser.add_argument("--scene", nargs="+", choices=scenes)
    parser.add_argument(
        "--scheme", nargs="+", choices=names, metavar="SCHEME",
        help='as "cubic mls" or "linear flip musl f32"; without precision: both',
    )  # fmt: skip
    parser.add_argument("--rounds", type=int, default=10, help="turns of each run; default: 10")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write all numbers to this file")
    parser.add_argument("--pictures", type=Path, metavar="DIR", help="draw into this folder")
    options = parser.parse_args(arguments)
    if options.rounds < 1:
        parser.error("--rounds: at least 1")
    return options


def main():
    options, began = parse(), time.time()
    wanted = plan(options)
    content = {
        "machine": machine(), "versions": versions(), "commit": commit(),
        "date": time.strftime("%Y-%m-%d %H:%M:%S%z"), "load": [load()], "threads": 1,
        "rounds": options.rounds,
        "size": "quick" if options.quick else "full" if options.full else "default",
        "omitted": [] if options.full else list(OMITTED),
        "experiments": {name: about(name) for name in wanted},
    }  # fmt: skip
    children = []
    with tempfile.TemporaryDirectory() as cache:
        for level in range(max(map(len, wanted.values()))):
            for name, levels in wanted.items():
                if level < len(levels):
                    children += measure(name, level, levels[level], options.rounds, cache)
                    done = f"{time.time() - began:5.0f} s: {name}, resolution {level + 1} done"
                    print(done, file=sys.stderr, flush=True)
    names, known = list(EXPERIMENTS), [scheme.with_precision for scheme in EVERY]
    rows = sorted(judge(children), key=lambda row: (
        names.index(row["experiment"]), known.index(f"{row['scheme']} {row['precision']}"),
        row["level"],
    ))  # fmt: skip
    for row in rows:
        kind = content["experiments"][row["experiment"]]["traits"]
        row["across"] = kind["across"] * 2 ** row["level"]
    content |= {"seconds": time.time() - began, "rows": rows}
    content["load"].append(load())
    print(f"{content['machine']} to {content['load'][1]}, one thread, {content['commit']}")
    print(table(rows))
    for text in content["omitted"]:
        print(f"left out: {text}")
    if options.json:
        write(options.json, content)
    if options.pictures:
        from speed_vs_error_pictures import draw

        draw(options.pictures, rows)


if __name__ == "__main__":
    main()
