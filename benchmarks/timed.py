"""A process that times one form: told what in its argument, it answers with a line of JSON when it
is ready, and with another for each empty line on stdin."""

import json
import os
import sys
import time

import numpy as np
from allocation import allocated, fields_of
from clocks import clock_ghz, of_workers
from stopwatch import spent
from taichi_example import TaichiExample
from textbook import Textbook
from workload import MATERIAL, block, our_solver, step_length

from mpm_taichi import runtime
from mpm_taichi.kernels.clear import clear
from mpm_taichi.kernels.clock import Clock
from mpm_taichi.kernels.g2p import g2p
from mpm_taichi.kernels.grid_update import grid_update
from mpm_taichi.kernels.p2g import p2g
from mpm_taichi.kernels.residual import take_residual
from mpm_taichi.kernels.sort import sort
from mpm_taichi.time_step import HUGE, Motion, Pace

SORTS, STEPS = 3, 3  # of a turn, and steps before each sort
TOGETHER = 64  # steps in a launch
SCENES = 8  # times that many steps of a small scene in a turn
SECONDS = 1.0  # of steps in a turn


class Stages:
    """Stages of a step, one by one."""

    def __init__(self, dim, precision, particles, form, threads, law=None):
        self.threads, self.law = threads, law
        runtime.start("cpu", precision, threads, particles, offline_cache=False)
        others = {"textbook": self._textbook, "mpm3d": self._taichi_example}
        others.get(form.split()[0], self._ours)(dim, particles, form)
        for function in self.stages.values():
            function()

    def _textbook(self, dim, count, form):
        x, v, V0, cells = block(dim, count, form)
        step = Textbook(x, v, V0, cells, MATERIAL, step_length(cells))
        self.stages = {name: getattr(step, name) for name in ("clear", "p2g", "grid_update", "g2p")}
        self.sort, self.steps_per_sort = None, lambda: 1.0
        self.particles, self.nodes = len(x), cells**dim
        self.particle_fields = [step.x, step.v, step.C, step.F]
        self.node_fields = [step.grid_v, step.grid_m]

    def _taichi_example(self, dim, count, form):
        x, v, _V0, cells = block(dim, count, form)
        step = TaichiExample(x, v, cells, MATERIAL, step_length(cells))
        self.stages = {"whole step": step.substep}
        self.sort, self.steps_per_sort = None, lambda: 1.0
        self.particles, self.nodes = len(x), cells**dim
        self.particle_fields, self.node_fields = step.particle_fields, step.node_fields

    def _ours(self, dim, count, form):
        solver, dt = our_solver(dim, count, form, self.threads, law=self.law)
        P, G, basis, t = solver.particles, solver.grid, solver.basis, solver.transfer
        solver.start(dt)
        sort(P, G, basis)
        self.stages = {
            "clear": lambda: clear(G),
            "p2g": lambda: p2g(P, G, basis, t),
            "grid_update": lambda: grid_update(G, solver.walls, solver.gravity, dt),
            "g2p": lambda: g2p(P, G, basis, t),
        }
        if t.filtered:
            self.stages["residual"] = lambda: take_residual(
                P, G, basis, t, solver.walls, solver.gravity, solver.filter_order
            )
        self.stages["update_stress"] = lambda: solver.update(dt, dt)
        self.sort = lambda: sort(P, G, basis)
        self.steps_per_sort = lambda: G.dx / (dt * G.speed_squared[None] ** 0.5)
        self.particles, self.nodes = P.count, int(np.prod([n + 1 for n in G.cells]))
        self.particle_fields, self.node_fields = fields_of(P), fields_of(G)

    def about(self):
        return {
            "particles": self.particles,
            "bytes_per_particle": allocated(self.particle_fields) / self.particles,
            "bytes_per_node": allocated(self.node_fields) / self.nodes,
        }

    def turn(self):
        """CPU and wall time of each stage, each time [ns per particle]; CPU time of the workers in
        all stages but the sort [ns per particle-step], most first."""
        names = [*self.stages, *(["sort"] if self.sort else [])]
        cpu, wall = ({name: [] for name in names} for _ in range(2))
        workers = {}

        def take(name, function):
            took = spent(function)
            cpu[name].append(took.cpu / self.particles * 1e9)
            wall[name].append(took.wall / self.particles * 1e9)

        for _ in range(SORTS):
            before = of_workers()
            for _ in range(STEPS):
                for name, function in self.stages.items():
                    take(name, function)
            for thread, seconds in of_workers().items():
                more = seconds - before.get(thread, 0.0)
                workers[thread] = workers.get(thread, 0.0) + more
            if self.sort:
                take("sort", self.sort)
        ns = 1e9 / (SORTS * STEPS * self.particles)
        busiest = sorted(workers.values(), reverse=True)[: self.threads]
        return {
            "cpu": cpu, "wall": wall, "workers": [ns * seconds for seconds in busiest],
            "steps_per_sort": self.steps_per_sort(), "clock_ghz": clock_ghz(),
        }  # fmt: skip


class Steps:
    """Whole steps, as `Solver.step` takes them."""

    def __init__(self, dim, precision, particles, form, threads, room):
        runtime.start("cpu", precision, threads, particles, offline_cache=False)
        self.solver, self.dt = our_solver(dim, particles, form, threads, room)
        self.solver.start(self.dt)
        self._step()

    def _step(self):
        self.solver.step(0.0, self.dt, self.dt)

    def about(self):
        return {"particles": self.solver.particles.count, "cells": list(self.solver.grid.cells)}

    def _steps_to_sort(self):
        """The steps from one sort to the next, or where that would take long some of them."""
        steps, began = 0, time.perf_counter()
        while self.solver.drift < 0.99 and (steps < 3 or time.perf_counter() - began < SECONDS):
            self._step()
            steps += 1
        return steps

    def turn(self):
        """CPU and wall time [ns per particle-step] of steps and of their share of a sort."""
        solver, drift = self.solver, self.solver.drift
        stepped = spent(self._steps_to_sort)
        part, steps = (solver.drift - drift) / 0.99, stepped.result
        solver.drift = np.inf
        sorted_in = spent(solver.sort_if_due)
        ns = 1e9 / (steps * solver.particles.count)
        return {
            "cpu": ns * (stepped.cpu + part * sorted_in.cpu),
            "wall": ns * (stepped.wall + part * sorted_in.wall),
            "sort": ns * part * sorted_in.cpu,
            "steps_per_sort": steps / part,
        }


class SmallScene:
    """A step of few particles on one thread: whole steps in a launch, and stage by stage."""

    def __init__(self, dim, precision, particles, form):
        runtime.start("cpu", precision, 1, particles, offline_cache=False)
        self.by_stage, self.dt = our_solver(dim, particles, form)
        given = Pace(
            self.dt, safety=1, acoustic=HUGE, wave_speed=1, constant=HUGE, travel=HUGE,
            deformation=HUGE, growth=1,
        )  # fmt: skip
        self.whole, _ = our_solver(dim, particles, form, whole=True)
        if not self.whole.is_whole:
            raise ValueError(f"{form}, {particles} particles: no whole steps in one launch")
        self.clock = Clock(0.0, self.dt, 1e6 * self.dt, 0.0, self.dt, Motion(), np.inf, given)
        for solver in (self.by_stage, self.whole):
            solver.start(self.dt)
        for function in (self._whole, self._by_stage):
            function()

    def _whole(self):
        self.whole.take_whole_steps(self.clock, TOGETHER)
        return len(self.clock.lengths)

    def _by_stage(self):
        for _ in range(TOGETHER):
            self.by_stage.step(0.0, self.dt, self.dt)
        return TOGETHER

    def about(self):
        return {"particles": self.whole.particles.count}

    def turn(self):
        """CPU and wall time of a step [microseconds], each time."""
        found = {}
        for name, function in (("whole", self._whole), ("by_stage", self._by_stage)):
            times = []
            for _ in range(SCENES):
                cpu, wall, steps = spent(function)
                times.append([1e6 * cpu / steps, 1e6 * wall / steps])
            found[name] = {"cpu": [c for c, _ in times], "wall": [w for _, w in times]}
        return found


KINDS = {"stages": Stages, "steps": Steps, "small": SmallScene}


def main():
    answers = os.fdopen(os.dup(1), "w")  # what a library prints must not get among them
    os.dup2(2, 1)
    given = json.loads(sys.argv[1])
    kind, began = KINDS[given.pop("kind")], given.pop("began")
    work = kind(**given)
    first = {"first_step_seconds": time.time() - began, "first_step_cpu": time.process_time()}
    about = first | work.about()
    print(json.dumps(about), file=answers, flush=True)
    for _ in sys.stdin:
        print(json.dumps(work.turn()), file=answers, flush=True)


if __name__ == "__main__":
    main()
