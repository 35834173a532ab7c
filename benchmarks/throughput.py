"""CPU time per particle-step, beside the textbook Taichi form in the same run.

    python benchmarks/throughput.py [--quick] [--dim 2 3] [--precision f32 f64] [--particles N]
                                    [--rounds N] [--json FILE]

One thread, neo-Hookean, a cube in shear, 2^dim particles per cell (3D: a million particles on 128^3
cells, 2D: 250,000 on 512^2).  Each form runs in processes of its own, in turns; CPU time of each
stage, the least of all steps and rounds.  The time of the first calls (compilation, no cache) is
reported apart."""

import argparse
import json
import os
import platform
import subprocess
import sys
import time
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
    cells = 2 ** int(np.ceil(np.log2(side + 8)))
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
    """The stages of one step, name -> function without arguments; and the number of particles."""
    from mpm_taichi.materials import NeoHookean

    x, v, V0, cells = block(dim, count, form)
    material = NeoHookean(type="neo_hookean", density=1000, youngs_modulus=1e5, poissons_ratio=0.3)
    dt = 0.1 / cells / material.wave_speed()
    if form.startswith("textbook"):
        from textbook import Textbook

        step = Textbook(x, v, V0, cells, material, dt)
        names = ("clear", "p2g", "grid_update", "g2p")
        return {name: getattr(step, name) for name in names}, len(x)

    from mpm_taichi import bases, transfers
    from mpm_taichi.kernels.clear import clear
    from mpm_taichi.kernels.g2p import g2p
    from mpm_taichi.kernels.grid_update import grid_update
    from mpm_taichi.kernels.p2g import p2g
    from mpm_taichi.kernels.sort import sort
    from mpm_taichi.kernels.update_stress import update_stress
    from mpm_taichi.particles import BodyPoints
    from mpm_taichi.solver import Solver

    word, transfer = form.split()
    basis = next(basis for basis in bases.BASES if basis.name == word)
    solver = Solver(
        [BodyPoints(material, x, v, V0)], (cells,) * dim, 1 / cells, basis,
        getattr(transfers, transfer.upper()), (), [0.0] * dim,
    )  # fmt: skip
    P, G, t = solver.particles, solver.grid, solver.transfer
    solver.start(dt)
    sort(P, G, basis)
    return {
        "clear": lambda: clear(G),
        "p2g": lambda: p2g(P, G, basis, t),
        "grid_update": lambda: grid_update(G, (), solver.gravity, dt),
        "g2p": lambda: g2p(P, G, basis, t),
        "update_stress": lambda: update_stress(P, P.groups[0], G, t, dt, dt),
        "sort": lambda: sort(P, G, basis),
    }, len(x)


def measure(dim, precision, count, form):
    """Least CPU time of each stage [ns per particle] and the time of the first calls [s]."""
    from mpm_taichi import runtime

    runtime.start("cpu", precision, 1, offline_cache=False)
    functions, n = stages(dim, count, form)
    times = {name: [] for name in functions}
    for _ in range(STEPS):
        for name, function in functions.items():
            before = time.process_time()
            function()
            times[name].append(time.process_time() - before)
    least = {name: min(values[1:]) / n * 1e9 for name, values in times.items()}
    first = sum(values[0] for values in times.values())
    return {"stages": least, "first_calls": first, "particles": n}


def child(*arguments):
    """`measure` in a process of its own: Taichi's fields and options are those of the process."""
    command = [sys.executable, __file__, "--child", *map(str, arguments)]
    result = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True)
    return json.loads(result.stdout.splitlines()[-1])


def least(rounds):
    """The least of each stage over rounds; the total leaves out the sort, which is not due each
    step."""
    best = {name: min(r["stages"][name] for r in rounds) for name in rounds[0]["stages"]}
    total = sum(ns for name, ns in best.items() if name != "sort")
    first = min(r["first_calls"] for r in rounds)
    return {"stages": best, "total": total, "first_calls": first}


def machine():
    name = platform.processor() or platform.machine()
    if Path("/proc/cpuinfo").exists():
        lines = Path("/proc/cpuinfo").read_text().splitlines()
        name = next((s.split(":")[1].strip() for s in lines if s.startswith("model name")), name)
    load = f", load {os.getloadavg()[0]:.1f}" if hasattr(os, "getloadavg") else ""
    return f"{name}, {os.cpu_count()} cores, Python {platform.python_version()}{load}"


def table(results):
    """One row per form: ns by stage, total, million particle-steps per second, ratios."""
    names = ["clear", "p2g", "grid_update", "g2p", "update_stress", "sort"]
    head = ["case", *names, "total", "Mp/s", "of sorted", "of random", "first calls"]
    rows = [head, ["---"] * len(head)]
    for case, forms in results.items():
        sorted_total, random_total = (forms[name]["total"] for name in TEXTBOOK)
        for form, best in forms.items():
            cells = [f"{best['stages'][n]:.1f}" if n in best["stages"] else "" for n in names]
            total = best["total"]
            rows.append([
                f"{case} {form}", *cells, f"{total:.1f}", f"{1e3 / total:.1f}",
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
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="3D f32 and MLS only, fewer particles")
    parser.add_argument("--dim", type=int, nargs="+", choices=(2, 3), default=[3, 2])
    parser.add_argument("--precision", nargs="+", choices=("f32", "f64"), default=["f32", "f64"])
    parser.add_argument("--particles", type=int, help="about this many")
    parser.add_argument("--rounds", type=int, default=2, help="processes of each form")
    parser.add_argument("--json", type=Path, help="write all numbers to this file")
    options = parser.parse_args()
    forms, count = FORMS, options.particles
    if options.quick:
        options.dim, options.precision, options.rounds = [3], ["f32"], 1
        forms, count = FORMS[:1], count or 200_000
    print(f"{machine()}; CPU ns per particle-step, one thread; sort: once, not in the total\n")
    results = {}
    for dim in options.dim:
        for precision in options.precision:
            arguments = dim, precision, count or DEFAULT_PARTICLES[dim]
            rounds = {form: [] for form in [*forms, *TEXTBOOK]}
            for _ in range(options.rounds):
                for form, measured in rounds.items():
                    measured.append(child(*arguments, form))
            results[f"{dim}D {precision}"] = {form: least(r) for form, r in rounds.items()}
    print(table(results))
    if options.json:
        content = {"machine": machine(), "rounds": options.rounds, "results": results}
        options.json.write_text(json.dumps(content, indent=2) + "\n")


if __name__ == "__main__":
    main()
