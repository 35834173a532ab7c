"""One run of a scene in turns, as a process that its parent tells when to go on.

Many wait, one steps: so that all are measured under the same conditions, and each is compiled once.
On stdin comes a JSON line that says what to run, then an empty line for each turn; each is answered
by a JSON line on stdout.

The clock runs during `Simulation.step` alone, one thread: not in the first steps, which compile,
and not while the error is recorded, at each output."""

import json
import os
import sys
import time
from pathlib import Path

from stopwatch import spent

WARM_UP = 3
SCENES = Path(__file__).parents[1] / "scenes"


class Stepping:
    """A scene with changes, cells of 2^-level the size; the first steps are done, and
    `rounds` turns take it to its end."""

    def __init__(self, scene, changes, level, precision, rounds):
        began = time.process_time()
        from mpm_taichi import Simulation, load_scene, stages
        from mpm_taichi.recorders import Errors
        from mpm_taichi.refinement import refined

        given = load_scene(SCENES / f"{scene}.yaml", changes)
        loaded = time.process_time()
        self.simulation = Simulation(refined(given, level), precision=precision, threads=1)
        made = time.process_time()
        self.errors = Errors(None, self.simulation, sys.maxsize)
        self.errors.record(self.simulation, is_output=True)
        self.rounds, self.turns = rounds, 0
        before = time.process_time()
        self._step_until(lambda: self.simulation.step_count >= WARM_UP)
        self.compile_seconds = (made - loaded) + time.process_time() - before
        self.first_calls = sum(stages.first_calls.values())
        self.imports = loaded - began
        self.start = self.simulation.time

    def about(self) -> dict:
        """What will be run, and what it took to get ready: CPU seconds of setting up, compiling and
        the first steps; wall seconds of the first calls of all stages."""
        simulation = self.simulation
        domain, materials = simulation.scene.domain, simulation.scene.materials.values()
        c = max(material.wave_speed() for material in materials)
        dt = simulation.last_dt
        return {
            "cells": list(domain.cells),
            "particles": int(simulation.ranges[-1]),
            "dt": dt,
            "courant": c * dt / simulation.scene.cell_size,
            "limit": simulation.limit.name,
            "limit_seconds": simulation.limit.seconds,
            "compile_seconds": self.compile_seconds,
            "first_calls_seconds": self.first_calls,
        }

    def turn(self) -> dict:
        """The next part of the run: CPU and wall seconds per step."""
        from mpm_taichi.errors import RunError

        self.turns += 1
        simulation = self.simulation
        until = self.start + (simulation.end - self.start) * self.turns / self.rounds
        first = simulation.step_count
        last = self.turns >= self.rounds
        try:
            cpu, wall = self._step_until(lambda: not last and simulation.time >= until)
        except RunError as failure:
            sentence = str(failure).splitlines()[0].split(". ")[0]
            return {"failure": sentence, "steps": simulation.step_count}
        taken = max(1, simulation.step_count - first)
        answer = {"cpu": cpu / taken, "wall": wall / taken, "steps": simulation.step_count}
        return answer | ({"errors": self.errors.summary()} if last else {})

    def _step_until(self, enough) -> tuple[float, float]:
        """CPU and wall seconds of steps; errors are recorded with the clock stopped."""
        simulation, cpu, wall = self.simulation, 0.0, 0.0
        while not (simulation.is_done or enough()):
            step = spent(simulation.advance)
            cpu += step.cpu
            wall += step.wall
            if step.result:
                self.errors.record(simulation, is_output=True)
        return cpu, wall


def main():
    from mpm_taichi.errors import InputError, RunError

    answers = os.fdopen(os.dup(1), "w")  # what a library prints must not get among them
    os.dup2(2, 1)

    def answer(content):
        print(json.dumps(content), file=answers, flush=True)

    try:
        run = Stepping(**json.loads(sys.stdin.readline()))
    except InputError as fault:
        sys.exit(str(fault))
    except RunError as failure:
        answer({"failure": str(failure).splitlines()[0].split(". ")[0], "steps": 0})
        return
    answer(run.about())
    for _ in sys.stdin:
        answer(run.turn())


if __name__ == "__main__":
    main()
