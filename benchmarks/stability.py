"""The suite of hard cases: which scheme stays stable and right where codes break?

    python benchmarks/stability.py [CASES ...] [--precision f32 f64] [--dim 2 3]
        [--scheme "quadratic mls" ...] [--quick] [--seed N] [--json FILE] [--picture FILE]
        [--debug] [--no-fast-math]

Cases: benchmarks/hard_cases/, each with its exact answer and the source of its bounds.  Of each row
the status: `pass`, `fail`, `expected fail`, `passes though it should fail`, or `reported` (no
bound is claimed); each figure with its bound, a mark ! where it breaks it; counts of what was
clamped or cut off.  Offsets and orientations are drawn, and printed; the worst counts.  Exit code 1
if a row fails, or passes though it should fail.

With --debug Taichi checks the bounds of each access to a field and, where one is outside, ends the
program with the line of the kernel; with --no-fast-math it computes as written.  It compiles anew
for either and keeps what it compiled apart, in the same cache.

JSON: machine, versions, date, seconds, rows: {case, title, scheme, basis, transfer, stress_update,
precision, dimension, status, figures [{name, value, bound, at_least, holds}], clamps {words:
count}, stopped (what the run said, or null), drawn, seconds (with compiling)}."""

import argparse
import json
import os
import random
import sys
import time
from itertools import product
from pathlib import Path

from experiments import EVERY
from hard_cases import CASES, Draw, Figure, Found
from tables import markdown
from throughput import machine

from mpm_taichi.errors import RunError
from mpm_taichi.report import versions

HEAD = ("case", "scheme", "prec.", "dim", "status", "figures (! breaks its bound)", "clamps")
BAD = ("fail", "passes though it should fail")


def row(case, scheme, dimension: int, seed: int, quick: bool) -> dict:
    """One scheme on one case."""
    began, draw, stopped = time.time(), Draw(seed, quick, dimension), None
    try:
        found = case.measure(scheme, draw)
    except RunError as error:
        found, stopped = Found([Figure("finishes", 0, 1, at_least=True)]), str(error)
    return {
        "case": case.name, "title": case.title, "scheme": str(scheme), "basis": scheme.basis,
        "transfer": scheme.transfer, "stress_update": scheme.order,
        "precision": scheme.precision, "dimension": dimension,
        "status": case.status(scheme, found),
        "figures": [
            f._asdict() | {"holds": bool(f.holds), "value": float(f.value)} for f in found.figures
        ],
        "told": "; ".join(map(str, found.figures)), "clamps": found.clamps, "stopped": stopped,
        "drawn": draw.said, "seconds": time.time() - began,
    }  # fmt: skip


def table(rows: list[dict]) -> str:
    return markdown(HEAD, [
        [
            f"{r['case']} {r['title']}", r["scheme"], r["precision"], f"{r['dimension']}D",
            r["status"], r["told"], str(sum(r["clamps"].values())),
        ]
        for r in rows
    ])  # fmt: skip


def save(file: Path, rows: list[dict], began: float) -> None:
    content = {
        "machine": machine(), "versions": versions(),
        "date": time.strftime("%Y-%m-%d %H:%M:%S%z"), "seconds": time.time() - began,
        "rows": rows,
    }  # fmt: skip
    file.write_text(json.dumps(content, indent=1) + "\n")


def plan(options):
    """Case, scheme and dimension of each row."""
    for name in options.cases or CASES:
        case = CASES[name]
        short = options.quick and not options.scheme
        for scheme in case.quick if short else case.schemes:
            if options.scheme and str(scheme) not in options.scheme:
                continue
            for precision, dimension in product(
                options.precision or (("f64",) if options.quick else ("f64", "f32")),
                options.dim or ((2,) if options.quick else (2, 3)),
            ):
                if precision in case.precisions and dimension in case.dimensions:
                    yield case, scheme._replace(precision=precision), dimension


def parse(arguments=None):
    parser = argparse.ArgumentParser(description="hard cases, for every scheme")
    parser.add_argument("cases", nargs="*", metavar="CASES", help=f"of {' '.join(CASES)}")
    parser.add_argument("--precision", nargs="+", choices=("f32", "f64"))
    parser.add_argument("--dim", nargs="+", type=int, choices=(2, 3), help="of those of a case")
    parser.add_argument(
        "--scheme", nargs="+", choices=sorted({str(s) for s in EVERY}), metavar="SCHEME",
        help='as "cubic mls" or "linear flip musl"; of those that a case has',
    )  # fmt: skip
    parser.add_argument(
        "--quick", action="store_true", help="less of each, of few schemes, 2D, f64"
    )
    parser.add_argument("--seed", type=int, help="of what is drawn; default: drawn too")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write all numbers, row by row")
    parser.add_argument("--picture", type=Path, metavar="FILE", help="draw cases x schemes")
    parser.add_argument("--debug", action="store_true", help="check the bounds of all accesses")
    parser.add_argument("--no-fast-math", action="store_true", help="compute as written")
    options = parser.parse_args(arguments)
    unknown = [name for name in options.cases if name not in CASES]
    if unknown:
        parser.error(f"{', '.join(unknown)}: no such case; there are {' '.join(CASES)}")
    return options


def main(arguments=None) -> int:
    options, began = parse(arguments), time.time()
    if options.debug:  # what Taichi reads each time that it starts
        os.environ["TI_DEBUG"] = "1"
    if options.no_fast_math:
        os.environ["TI_FAST_MATH"] = "0"
    seed = random.SystemRandom().randrange(2**31) if options.seed is None else options.seed
    rows = []
    for case, scheme, dimension in plan(options):
        rows.append(row(case, scheme, dimension, seed, options.quick))
        said = f"{case.name} {scheme.with_precision} {dimension}D"
        done = f"{time.time() - began:5.0f} s: {said}: {rows[-1]['status']}"
        if rows[-1]["status"] in BAD:
            done += f": {rows[-1]['told']}"
        print(done, file=sys.stderr, flush=True)
        if options.json:
            save(options.json, rows, began)
    print(table(rows))
    for drawn in dict.fromkeys(f"{r['case']} {r['dimension']}D: {r['drawn']}" for r in rows):
        print(drawn)
    for r in rows:
        if r["stopped"]:
            said = f"{r['case']} {r['scheme']} {r['precision']} {r['dimension']}D"
            print(f"{said} stopped: {r['stopped']}")
    if options.picture:
        from stability_picture import draw

        draw(options.picture, rows)
    return int(any(r["status"] in BAD for r in rows))


if __name__ == "__main__":
    sys.exit(main())
