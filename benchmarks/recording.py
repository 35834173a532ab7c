"""What part of a run its recording takes: 10,000 particles, few steps between two outputs.

    python benchmarks/recording.py           # two minutes; --frames 100 for less

prints CPU milliseconds per output, of the steps and of each recorder, as medians over the outputs
(all are measured in turns, so that what else the computer does falls on all of them alike), and the
part of the run that the recorders take: snapshots alone, which is what player and films need; with
the rows of the history; with pictures."""

import argparse
import tempfile
from functools import partial
from pathlib import Path

import numpy as np
from stopwatch import spent

from mpm_taichi import Simulation, recorders
from mpm_taichi.scene import Body, Box, Domain, Lattice, NeoHookean, Output, Scene, Time

STEP = 1e-4  # s
EVERY = 10  # steps between two rows of the history


def scene(dim: int, steps: int, frames: int) -> Scene:
    """A block of rubber that falls on the floor; 12 steps of it are 0.1 of its vibration."""
    size, cells, spacing = [2.0, 1.0, 1.0], [128, 64], 1 / 128
    block = Box(min=[0.3, 0.02], max=[1.3, 0.62])
    if dim == 3:
        cells, spacing = [32, 16, 16], 1 / 32
        block = Box(min=[0.3, 0.05, 0.1], max=[1.0, 0.75, 0.75])
    lattice = Lattice(spacing=spacing)
    return Scene(
        version=1,
        domain=Domain(size=size[:dim], cells=cells, walls="slip"),
        time=Time(end=STEP * steps * frames, step=STEP),
        gravity=[0.0, -9.81, 0.0][:dim],
        materials={"rubber": NeoHookean(density=1000, youngs_modulus=1e5, poissons_ratio=0.3)},
        bodies=[Body(name="block", material="rubber", shape=block, particles=lattice)],
        output=Output(every=STEP * steps),
    )


def per_output(simulation, kinds) -> dict[str, float]:
    """CPU time [ms] of the steps and of each recorder from one output to the next."""
    times: dict[str, list[float]] = {"steps": [], **{name: [] for name in kinds}}
    while not simulation.is_done:
        now, landed = dict.fromkeys(times, 0.0), False
        while not landed:
            most = EVERY - simulation.step_count % EVERY
            cpu, _wall, landed = spent(partial(simulation.advance, most))
            now["steps"] += cpu
            for name, recorder in kinds.items():
                now[name] += spent(partial(recorder.record, simulation, landed)).cpu
        for name, seconds in now.items():
            times[name].append(1e3 * seconds)
    return {name: float(np.median(values[2:])) for name, values in times.items()}


def main() -> None:
    parser = argparse.ArgumentParser(description="the part of a run that recording takes")
    parser.add_argument("--frames", type=int, default=300)
    parser.add_argument("--steps", type=int, nargs="+", default=[12, 60])
    parser.add_argument("--threads", type=int, default=1)
    options = parser.parse_args()
    print("dim  particles  steps | ms per output: steps  snapshot  history  picture"
          " | of the run: snapshots  and history  and pictures")  # fmt: skip
    for dim in (2, 3):
        for steps in options.steps:
            its = scene(dim, steps, options.frames)
            simulation = Simulation(its, threads=options.threads)
            with tempfile.TemporaryDirectory() as folder:
                at = Path(folder)
                kinds = {
                    "snapshot": recorders.Snapshots(at / "snapshots", simulation),
                    "history": recorders.History(at / "history.csv", simulation, EVERY),
                    "picture": recorders.Images(at / "frames", simulation, its.output.images),
                }
                ms = per_output(simulation, kinds)
            total, parts = ms["steps"], []
            for name in kinds:
                total += ms[name]
                parts.append(100 * (1 - ms["steps"] / total))
            print(
                f"{dim}D {simulation.ranges[-1]:11} {steps:6} | {ms['steps']:20.1f} "
                f"{ms['snapshot']:9.2f} {ms['history']:8.2f} {ms['picture']:8.1f} | "
                f"{parts[0]:20.1f} % {parts[1]:9.1f} % {parts[2]:11.1f} %"
            )


if __name__ == "__main__":
    main()
