"""CPU and wall time per particle-step, beside the textbook Taichi form and Taichi's own example in
the same run, and how long one waits for the first pictures.

    python benchmarks/throughput.py [--quick] [--dim 2 3] [--precision f32 f64] [--particles N]
                                    [--threads 1 2 ...] [--forms "quadratic mls" ...]
                                    [--laws] [--curves [--large]] [--rounds N] [--json FILE]

Neo-Hookean, a block in shear, 2^dim particles per cell (3D: a million particles on 128^3 cells, 2D:
250,000 on 512^2), dt = 0.1 dx / c.  Each form has a process of its own; these run in turns.  Times
are the least of all steps and rounds, with the median as a measure of the noise; totals have the
sort divided by the steps from one sort to the next at the speed of this run.  The first step is
timed from the start of its process, with imports, seeding and compilation, no cache."""

import argparse
import json
import os
import platform
import sys
from importlib.metadata import version
from itertools import product
from pathlib import Path
from statistics import median

import curves
import first_frame
import laws
from interleaved import in_turns
from limits import copy_bandwidth, instruction_limit, memory_limit
from tables import markdown
from workload import FORMS, PEERS, TEXTBOOK, pair

DEFAULT_PARTICLES = {2: 250_000, 3: 1_000_000}
LAW_PARTICLES = 200_000
STAGES = ("clear", "p2g", "grid_update", "g2p", "residual", "update_stress", "whole step", "sort")


def machine():
    name = platform.processor() or platform.machine()
    if Path("/proc/cpuinfo").exists():
        lines = Path("/proc/cpuinfo").read_text().splitlines()
        name = next((s.split(":")[1].strip() for s in lines if s.startswith("model name")), name)
    python, taichi = platform.python_version(), version("taichi")
    return f"{name}, {os.cpu_count()} cores, Python {python}, Taichi {taichi}{load()}"


def load():
    return f", load {os.getloadavg()[0]:.1f}" if hasattr(os, "getloadavg") else ""


def step_of(stages, steps_per_sort):
    """The time of a step: that of its stages, and its share of a sort."""
    return sum(ns / steps_per_sort if name == "sort" else ns for name, ns in stages.items())


def best(turns, clock):
    """Of all turns on a clock, `cpu` or `wall`: least and median of each stage, and of a step."""
    samples = {name: [ns for turn in turns for ns in turn[clock][name]] for name in turns[0][clock]}
    found = {}
    for key, of in (("", min), ("median_", median)):
        stages = {name: of(values) for name, values in samples.items()}
        found[f"{key}stages"] = stages
        found[f"{key}total"] = step_of(stages, turns[0]["steps_per_sort"])
    return found


def balance(workers):
    """Least over most CPU time of the workers: 1 where the work is shared evenly."""
    return min(workers) / max(workers) if workers and max(workers) > 0 else None


def result(child):
    """What one process has found: CPU times at the top, wall times under `wall`."""
    turns = child.turns
    workers = min((turn["workers"] for turn in turns), key=sum)
    return child.about | best(turns, "cpu") | {
        "wall": best(turns, "wall"), "steps_per_sort": turns[0]["steps_per_sort"],
        "workers": workers, "balance": balance(workers),
        "clock_ghz": max((turn["clock_ghz"] for turn in turns if turn["clock_ghz"]), default=None),
    }  # fmt: skip


def measured(dim, precision, count, forms, threads, rounds):
    """case -> form -> `result`, a case for each number of threads, all in turns."""
    specs = [
        {
            "kind": "stages", "dim": dim, "precision": precision, "particles": count,
            "form": form, "threads": workers,
        }
        for form, workers in product([*forms, *TEXTBOOK, *PEERS], threads)
    ]  # fmt: skip
    found = {}
    for child in in_turns(specs, rounds):
        workers = child.spec["threads"]
        case = f"{dim}D {precision}" + (f" {workers} threads" if workers > 1 else "")
        found.setdefault(case, {})[child.spec["form"]] = child.spec | result(child)
    return found


def add_shares(results, bandwidth):
    """To results on one thread: the limits [ns per particle-step] and the shares reached of them.
    bandwidth [GB/s]; the clock is the highest of all processes.  Returns that [GHz]."""
    rows = [row for forms in results.values() for row in forms.values() if row["threads"] == 1]
    ghz = max((row["clock_ghz"] for row in rows if row["clock_ghz"]), default=None)
    for row in rows:
        limits = {"memory": memory_limit(row["dim"], row["precision"], bandwidth)}
        if ghz:
            limits["float4"] = instruction_limit(row["dim"], ghz)
        row["limits"] = limits
        row["shares"] = {name: ns / row["total"] for name, ns in limits.items()}
    return ghz


def stage_table(results):
    """One thread: CPU ns per particle-step by stage, total and its median."""
    rows = {f"{case} {form}": row for case, f in results.items() for form, row in f.items()}
    rows = {name: row for name, row in rows.items() if row["threads"] == 1}
    names = [name for name in STAGES if any(name in row["stages"] for row in rows.values())]
    lines = []
    for name, row in rows.items():
        sort = row["stages"].get("sort", 0.0) / row["steps_per_sort"]
        lines.append([
            name, *(f"{row['stages'][n]:.1f}" if n in row["stages"] else "" for n in names),
            f"{sort:.1f}" if sort else "", f"{row['total']:.1f}", f"{row['median_total']:.1f}",
        ])  # fmt: skip
    return markdown(["case", *names, "sort per step", "total", "median"], lines)


def rate_table(results):
    """One thread: million particle-steps per second, ratios, shares of limits, memory, start."""
    head = ["case", "Mp/s", "of sorted", "of random", "memory limit", "float4 limit"]
    lines = []
    for case, forms in results.items():
        for form, row in forms.items():
            if row["threads"] == 1:
                shares = [row["shares"].get(name) for name in ("memory", "float4")]
                lines.append([
                    f"{case} {form}", f"{1e3 / row['total']:.1f}",
                    *(f"{row['total'] / forms[name]['total']:.3f}" for name in TEXTBOOK),
                    *(f"{100 * share:.1f} %" if share else "" for share in shares),
                    f"{row['bytes_per_particle']:.0f}", f"{row['bytes_per_node']:.0f}",
                    f"{row['first_step_seconds']:.1f} s", f"{row['first_step_cpu']:.1f} s",
                ])  # fmt: skip
    return markdown([*head, "B/particle", "B/node", "first step", "CPU"], lines)


def thread_table(results):
    """Several threads: wall ns per particle-step beside one thread, and who did the work."""
    head = ["case", "wall", "median", "of one thread", "CPU", "CPU of one", "CPU of workers"]
    lines = []
    for forms in results.values():
        for form, row in forms.items():
            if row["threads"] > 1:
                one = results[f"{row['dim']}D {row['precision']}"][form]
                wall, even = row["wall"], row["balance"]
                lines.append([
                    f"{row['dim']}D {row['precision']} {form}, {row['threads']} threads",
                    f"{wall['total']:.1f}", f"{wall['median_total']:.1f}",
                    f"{wall['total'] / one['wall']['total']:.3f}", f"{row['total']:.1f}",
                    f"{one['total']:.1f}", " + ".join(f"{ns:.1f}" for ns in row["workers"]),
                    "" if even is None else f"{even:.2f}",
                ])  # fmt: skip
    return markdown([*head, "balance"], lines)


def parse(arguments=None):
    parser = argparse.ArgumentParser(description="time per particle-step")
    parser.add_argument("--quick", action="store_true", help="only MLS; 3D, f32, 200,000, 1 round")
    parser.add_argument("--dim", type=int, nargs="+", choices=(2, 3))
    parser.add_argument("--precision", nargs="+", choices=("f32", "f64"))
    parser.add_argument("--particles", type=int, help="about this many; in curves at most")
    parser.add_argument("--threads", type=int, nargs="+", default=[1], help="beside one")
    parser.add_argument("--forms", nargs="+", metavar="'BASIS TRANSFER'", help="instead of four")
    parser.add_argument(
        "--curves", action="store_true",
        help="also whole steps of the first form, for 1e3 to 1e6 particles and for 1, 8 and 64 "
        "times as many cells in 3D",
    )  # fmt: skip
    parser.add_argument(
        "--laws", action="store_true", help="also each law beside neo-Hookean, in the first form"
    )
    parser.add_argument("--large", action="store_true", help="with --curves: 1e7 particles too")
    parser.add_argument("--rounds", type=int, help="turns of each form")
    parser.add_argument("--json", type=Path, help="write all numbers to this file")
    options = parser.parse_args(arguments)
    for name in ("particles", "rounds"):
        value = getattr(options, name)
        if value is not None and value < 1:
            parser.error(f"--{name}: must be at least 1 (got {value})")
    if min(options.threads) < 1:
        parser.error(f"--threads: must be at least 1 (got {min(options.threads)})")
    for form in options.forms or ():
        try:
            pair(form)
        except ValueError as fault:
            parser.error(f"--forms: {fault}")
    if options.large and not options.curves:
        parser.error("--large: goes with --curves")
    quick = options.quick
    options.forms = options.forms or list(FORMS[:1] if quick else FORMS)
    options.dim = options.dim or ([3] if quick else [3, 2])
    options.precision = options.precision or (["f32"] if quick else ["f32", "f64"])
    options.rounds = options.rounds or (1 if quick else 2)
    options.threads = sorted({1, *options.threads})
    return options


def main():
    options = parse()
    rounds, threads, forms = options.rounds, options.threads, options.forms
    cases = list(product(options.dim, options.precision))
    about = machine()
    print(f"{about}; ns per particle-step", flush=True)
    results, bandwidth = {}, copy_bandwidth()
    for dim, precision in cases:
        count = options.particles or (200_000 if options.quick else DEFAULT_PARTICLES[dim])
        results |= measured(dim, precision, count, forms, threads, rounds)
        bandwidth = max(bandwidth, copy_bandwidth())
    ghz = add_shares(results, bandwidth)
    content = {
        "machine": about, "rounds": rounds, "bandwidth_gb_s": bandwidth, "clock_ghz": ghz,
        "results": results,
    }  # fmt: skip
    print("\nCPU time by stage, one thread\n", stage_table(results), sep="\n")
    clock = f"{ghz:.2f} GHz (measured)" if ghz else "a clock that is not known"
    print(f"\nOne thread; limits of quadratic MLS at {bandwidth:.1f} GB/s (a copy) and {clock}\n")
    print(rate_table(results), flush=True)
    if threads[1:]:
        print("\nThreads\n", thread_table(results), sep="\n", flush=True)
    if not options.quick:
        content["small"] = curves.small_scene(FORMS[0], options.precision, rounds)
        print("\nA small scene, one thread, wall microseconds per step\n")
        print(curves.small_table(content["small"]), flush=True)
        content["first_frame"] = first_frame.measured(rounds)
        print("\nFirst pictures of shipped scenes, from the start of the process\n")
        print(first_frame.table(content["first_frame"]), flush=True)
    if options.curves:
        content["curves"] = [
            row
            for dim, precision in cases
            for row in curves.measured(
                dim, precision, forms[0], threads, rounds, options.particles, options.large
            )
        ]
        print("\nWhole steps, ns per particle-step\n", curves.table(content["curves"]), sep="\n")
    if options.laws:
        content["laws"] = [
            row
            for dim, precision in cases
            for row in laws.measured(
                dim, precision, options.particles or LAW_PARTICLES, forms[0], rounds
            )
        ]
        print("\nLaws, CPU ns per particle-step without the sort\n")
        print(laws.table(content["laws"]), flush=True)
    print(f"\nDone{load()}")
    if options.json:
        options.json.write_text(json.dumps(content, indent=2) + "\n")


if __name__ == "__main__":
    sys.exit(main())
