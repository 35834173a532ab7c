"""CPU time per particle-step, beside the textbook Taichi form in the same run.

    python benchmarks/throughput.py [--quick] [--dim 2 3] [--precision f32 f64] [--particles N]
                                    [--rounds N] [--json FILE]

One thread, neo-Hookean, a cube in shear, 2^dim particles per cell (3D: a million particles on 128^3
cells, 2D: 250,000 on 512^2), dt = 0.1 dx / c.  Each form runs in processes of its own, in turns;
CPU time of each stage, the least of all steps and rounds.  The total has the sort divided by the
steps from one sort to the next at the speed of this run.  What the first calls take longer
(compilation, no cache) is reported apart."""

import argparse
import json
import os
import platform
import subprocess
import sys
import time
from importlib.metadata import version
from pathlib import Path

import numpy as np

STEPS = 8
DEFAULT_PARTICLES = {2: 250_000, 3: 1_000_000}
FORMS = ["quadratic mls", "quadratic apic", "quadratic flip", "linear flip"]
TEXTBOOK = ["textbook sorted", "textbook random"]


def block(dim, count, form):
    """x, v, V0, cells: random points in a block in the middle of the box; for hat functions a
    jittered lattice, since random points leave nodes of almost no mass."""
    rng = np.random.default_rng(0)
    side = round((count / 2**dim) ** (1 / dim))
    cells = 2 ** int(np.ceil(np.log2(2 * side + 8)))
    corner = (cells - side) // 2
    if form.startswith("linear"):
        lattice = np.indices((2 * side,) * dim).reshape(dim, -1).T
        x = corner + 0.5 * (lattice + 0.5 + 0.2 * (rng.random(lattice.shape) - 0.5))
    else:
        x = corner + side * rng.random((2**dim * side**dim, dim))
    if form == "textbook sorted":
        first = np.floor(x - 0.5).astype(int)
        x = x[np.lexsort(first.T[::-1])]
    x = x / cells
    v = np.zeros_like(x)
    v[:, 0] = 0.1 + 2.0 * (x[:, 1] - 0.5)
    return x, v, np.full(len(x), (0.5 / cells) ** dim), cells


def stages(dim, count, form):
    """The stages of one step, name -> function without arguments; the number of particles; the
    seconds of the first stress update and sort; and the steps from one sort to the next."""
    from mpm_taichi.materials import NeoHookean

    x, v, V0, cells = block(dim, count, form)
    material = NeoHookean(type="neo_hookean", density=1000, youngs_modulus=1e5, poissons_ratio=0.3)
    dt = 0.1 / cells / material.wave_speed()
    if form.startswith("textbook"):
        from textbook import Textbook

        step = Textbook(x, v, V0, cells, material, dt)
        names = ("clear", "p2g", "grid_update", "g2p")
        return {name: getattr(step, name) for name in names}, len(x), 0.0, lambda: 1.0

    from mpm_taichi import bases, transfers
    from mpm_taichi.boundaries import Separate, Wall
    from mpm_taichi.kernels.clear import clear
    from mpm_taichi.kernels.g2p import g2p
    from mpm_taichi.kernels.grid_update import grid_update
    from mpm_taichi.kernels.p2g import p2g
    from mpm_taichi.kernels.sort import sort
    from mpm_taichi.kernels.update_stress import update_stress
    from mpm_taichi.particles import BodyPoints
    from mpm_taichi.solver import Solver

    word, transfer = form.split()
    walls = tuple(Wall(axis, upper, Separate) for axis in range(dim) for upper in (False, True))
    basis = next(basis for basis in bases.BASES if basis.name == word)
    solver = Solver(
        [BodyPoints(material, x, v, V0)], (cells,) * dim, 1 / cells, basis,
        getattr(transfers, transfer.upper()), walls, [0.0] * dim,
    )  # fmt: skip
    P, G, t = solver.particles, solver.grid, solver.transfer
    before = time.process_time()
    solver.start(dt)
    sort(P, G, basis)
    began = time.process_time() - before
    functions = {
        "clear": lambda: clear(G),
        "p2g": lambda: p2g(P, G, basis, t),
        "grid_update": lambda: grid_update(G, walls, solver.gravity, dt),
        "g2p": lambda: g2p(P, G, basis, t),
        "update_stress": lambda: update_stress(P, P.groups[0], G, t, dt, dt),
        "sort": lambda: sort(P, G, basis),
    }
    return functions, len(x), began, lambda: 1 / (dt * cells * G.speed_squared[None] ** 0.5)


def measure(dim, precision, count, form):
    """Least CPU time of each stage [ns per particle], what the first calls take longer [s]."""
    from mpm_taichi import runtime

    runtime.start("cpu", precision, 1, offline_cache=False)
    functions, n, began, steps_per_sort = stages(dim, count, form)
    times = {name: [] for name in functions}
    for _ in range(STEPS):
        for name, function in functions.items():
            before = time.process_time()
            function()
            times[name].append(time.process_time() - before)
    least = {name: min(values[1:]) / n * 1e9 for name, values in times.items()}
    again = sum(least.get(name, 0.0) for name in ("update_stress", "sort")) * n / 1e9
    first = sum(values[0] - min(values[1:]) for values in times.values()) + max(0.0, began - again)
    return {
        "stages": least, "first_calls": first, "particles": n, "steps_per_sort": steps_per_sort(),
    }  # fmt: skip


def child(*arguments):
    """`measure` in a process of its own: Taichi's fields and options are those of the process."""
    command = [sys.executable, __file__, "--child", *map(str, arguments)]
    result = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True)
    return json.loads(result.stdout.splitlines()[-1])


def least(rounds):
    """The least of each stage over rounds; the total with the share of the sort in a step."""
    best = {name: min(r["stages"][name] for r in rounds) for name in rounds[0]["stages"]}
    steps = rounds[0]["steps_per_sort"]
    total = sum(ns / steps if name == "sort" else ns for name, ns in best.items())
    first = min(r["first_calls"] for r in rounds)
    return {
        "stages": best, "total": total, "first_calls": first, "steps_per_sort": steps,
        "particles": rounds[0]["particles"],
    }  # fmt: skip


def machine():
    name = platform.processor() or platform.machine()
    if Path("/proc/cpuinfo").exists():
        lines = Path("/proc/cpuinfo").read_text().splitlines()
        name = next((s.split(":")[1].strip() for s in lines if s.startswith("model name")), name)
    load = f", load {os.getloadavg()[0]:.1f}" if hasattr(os, "getloadavg") else ""
    python, taichi = platform.python_version(), version("taichi")
    return f"{name}, {os.cpu_count()} cores, Python {python}, Taichi {taichi}{load}"


def table(results):
    """One row per form: ns by stage, total, million particle-steps per second, ratios."""
    names = ["clear", "p2g", "grid_update", "g2p", "update_stress", "sort"]
    head = ["case", *names, "sort per step", "total", "Mp/s"]
    head += ["of sorted", "of random", "first calls"]
    rows = [head, ["---"] * len(head)]
    for case, forms in results.items():
        sorted_total, random_total = (forms[name]["total"] for name in TEXTBOOK)
        for form, best in forms.items():
            cells = [f"{best['stages'][n]:.1f}" if n in best["stages"] else "" for n in names]
            total = best["total"]
            share = best["stages"].get("sort", 0.0) / best["steps_per_sort"]
            rows.append([
                f"{case} {form}", *cells, f"{share:.1f}" if share else "",
                f"{total:.1f}", f"{1e3 / total:.1f}",
                f"{total / sorted_total:.3f}", f"{total / random_total:.3f}",
                f"{best['first_calls']:.1f} s",
            ])  # fmt: skip
    widths = [max(len(row[k]) for row in rows) for k in range(len(head))]
    return "\n".join(
        "| " + " | ".join(c.ljust(w) for c, w in zip(row, widths, strict=True)) + " |"
        for row in rows
    )


def main():
    if sys.argv[1:2] == ["--child"]:
        dim, precision, count, form = sys.argv[2:6]
        print(json.dumps(measure(int(dim), precision, int(count), form)))
        return
    parser = argparse.ArgumentParser(description="CPU time per particle-step")
    parser.add_argument("--quick", action="store_true", help="only MLS; 3D, f32, 200,000, 1 round")
    parser.add_argument("--dim", type=int, nargs="+", choices=(2, 3))
    parser.add_argument("--precision", nargs="+", choices=("f32", "f64"))
    parser.add_argument("--particles", type=int, help="about this many")
    parser.add_argument("--rounds", type=int, help="processes of each form")
    parser.add_argument("--json", type=Path, help="write all numbers to this file")
    options = parser.parse_args()
    quick = options.quick
    forms = FORMS[:1] if quick else FORMS
    dims = options.dim or ([3] if quick else [3, 2])
    precisions = options.precision or (["f32"] if quick else ["f32", "f64"])
    rounds = options.rounds or (1 if quick else 2)
    about = machine()
    print(f"{about}; CPU ns per particle-step, one thread\n")
    results = {}
    for dim in dims:
        for precision in precisions:
            count = options.particles or (200_000 if quick else DEFAULT_PARTICLES[dim])
            measured = {form: [] for form in [*forms, *TEXTBOOK]}
            for _ in range(rounds):
                for form in measured:
                    measured[form].append(child(dim, precision, count, form))
            results[f"{dim}D {precision}"] = {form: least(r) for form, r in measured.items()}
    print(table(results))
    if options.json:
        content = {"machine": about, "rounds": rounds, "results": results}
        options.json.write_text(json.dumps(content, indent=2) + "\n")


if __name__ == "__main__":
    main()
