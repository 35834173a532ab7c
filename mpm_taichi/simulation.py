"""A run: clock, time step, schedules, recorders.  Recorders only read a Simulation."""

from collections.abc import Iterator
from functools import cached_property
from typing import Any

import numpy as np

from . import runtime, stages
from .at_outputs import as_recorder
from .bodies import body_points, first_motion, half_width
from .cautions import cautions
from .errors import InputError, RunError
from .kernels.clock import Clock
from .kernels.sums import sums
from .kernels.whole_steps import MOST_TOGETHER
from .ledger import begin_ledger, ledger
from .lookout import Lookout
from .memory import planned_memory, refuse_too_much
from .notebook import picture
from .scene import Scene
from .schedules import EverySeconds, even_step
from .seeding import expected_counts, seed
from .snapshot import Snapshot, take_snapshot
from .solver import Solver
from .threads import threads as worthwhile
from .time_step import TimeStep
from .trouble import gone_wrong

PARTICLE_STEPS = {"cpu": 100_000, "gpu": 10_000_000}
"""Without a return to Python, some 10 ms: a signal waits for their end."""

CLOCK = ("time", "step_count", "output_count", "dt", "last_dt", "first_dt", "is_started")
"""Of a Simulation, in a checkpoint."""


class Simulation:
    """A scene, seeded and ready to run.  Starting one ends any other in the same process, since
    Taichi has one set of fields.

    `threads` workers on a CPU; by default what the size of the scene is worth.  The result does
    not depend on it, to the last bit.  Few particles take whole steps on one of them, and on a GPU
    all do.

    `reduction` shortens all steps."""

    def __init__(
        self, scene: Scene, device="cpu", precision=None, threads=None, reduction: float = 1.0
    ):
        self.scene, self.device, self.threads_asked = scene, device, threads
        self.precision = precision or scene.method.precision or runtime.default_precision(device)
        if scene.output.audit and device != "cpu":
            raise InputError(f"output.audit: is for --device cpu (got {device}); leave it out")
        runtime.stop()
        refuse_too_much(scene, expected_counts(scene), device, self.precision)
        points, self.seeding = seed(scene)
        counts = [len(p.x) for p in points]
        refuse_too_much(scene, counts, device, self.precision)
        self.memory = planned_memory(scene, counts, self.precision)
        self.ranges = np.cumsum([0, *counts])
        self.threads = worthwhile(threads, device, int(self.ranges[-1]))
        runtime.start(device, self.precision, self.threads, int(self.ranges[-1]))
        self._ends = runtime.ends
        stages.reset()
        bodies = [body_points(scene, index, p.x, p.V0) for index, p in enumerate(points)]
        self.initial_position = np.concatenate([body.undeformed for body in bodies])
        method = scene.method
        given = None if scene.time.step == "auto" else scene.time.step
        motion = first_motion(bodies)
        self.time_step = TimeStep(
            scene, given, scene.time.safety, half_width(bodies, scene), motion, scene.time.enforce
        )
        self.time_step.reduction = reduction
        try:
            self._solver = Solver(
                bodies, scene.domain.cells, scene.cell_size, method.basis_class,
                method.transfer_class, scene.domain.rules, scene.gravity_vector,
                mass_cutoff=method.mass_cutoff, periodic=scene.domain.periodic,
                stress_update=method.stress_update, filter_order=method.filter_order,
                flip_part=method.flip_part, body_force=scene.field(scene.body_force),
                audited=scene.output.audit, whole=True, threads=self.threads,
                atomic=device != "cpu",
            )  # fmt: skip
        except (RuntimeError, MemoryError):  # Taichi's allocator says no more than that
            raise InputError(
                f"{self.ranges[-1]} particles and {' x '.join(map(str, scene.domain.cells))} cells "
                "do not fit into memory: take fewer, larger cells (domain.cells) or fewer particles"
            ) from None
        self.at_start = {
            "mass": self._rounded(body.material.density * body.V0 for body in bodies),
            "initial_volume": self._rounded(body.V0 for body in bodies),
        }
        self.lightest = float(self.at_start["mass"].min())
        self.start_mass = float(self.at_start["mass"].sum())
        self.outputs = EverySeconds(scene.output_interval, scene.time.end)
        self.time, self.step_count, self.output_count = 0.0, 0, 0
        self._look()
        self.limits_at_start = self.time_step.limits(motion)
        self.limit = self.limits_at_start[0]
        self.time_step.refuse(self.limit)
        self.last_dt = 0.0
        self.dt = self._fitting(self.time_step.begin(), self.time)
        self.first_dt = self.dt
        self.lookout = Lookout(self, self._bring_in)
        self.is_started = False  # recorders have seen the start
        self.is_amid_step = False
        self.stop_asked = False  # `advance` returns after the step or launch that it is at
        self.start_volume = sum(
            float(body.V0 @ np.linalg.det(np.eye(scene.dimension) + body.displacement_gradient))
            for body in bodies
        )
        self.solver.start(self.dt)
        if scene.output.audit:
            begin_ledger(self.solver, self.sums)

    def _rounded(self, values):
        """Of all bodies one after the other, in the precision of the run, as float64."""
        return np.concatenate(list(values)).astype(runtime.real_type()).astype(float)

    def _fitting(self, longest, time):
        """A step from `time` on that lands on the next output."""
        number = self.output_count + (time >= self.next_output)
        if number >= self.outputs.count:
            return longest
        return even_step(self.outputs.time(number + 1) - time, longest)

    @property
    def solver(self) -> Solver:
        """RunError once another simulation has taken its fields: to touch them would end the
        process."""
        if runtime.ends != self._ends:
            raise RunError(
                "this Simulation has ended: another was started in the same process, and Taichi "
                "has one set of fields. Read what you need of one before you start the next"
            )
        return self._solver

    @property
    def next_output(self) -> float:
        """Time of the next output [s]."""
        return self.outputs.time(self.output_count + 1)

    @property
    def end(self) -> float:
        """[s]"""
        return self.scene.time.end

    @property
    def is_done(self) -> bool:
        return self.output_count >= self.outputs.count

    def step(self) -> bool:
        """One time step.  Returns whether it has landed on an output."""
        return self.advance(1)

    def advance(self, most: int = MOST_TOGETHER) -> bool:
        """Up to `most` time steps, fewer where an output is due.  Returns whether they have landed
        on one."""
        if self.is_amid_step:
            raise RunError("this Simulation is amid a step: take its other stages first")
        take = self._take_whole_steps if self.solver.is_whole else self._take_step
        before, landing = self.step_count, False
        while not landing and self.step_count - before < most:
            landing = take(most - (self.step_count - before))
            self._settle(landing)
            if self.stop_asked:
                break
        return landing

    def stages(self) -> Iterator[str]:
        """One time step, with a pause after each of its stages, which it names.  The particles are
        as the stage has left them; the clock moves at the end, and nothing else can until then."""
        landing, self.is_amid_step = self._lands, True
        for name in self._stages():
            self._forget_moment()
            yield name
        self.is_amid_step = False
        self._settle(landing)

    def _settle(self, landing):
        """After a step or a launch of several."""
        self._forget_moment()
        self.lookout.after_step()
        if landing:
            self.lookout.at_output()
        self.output_count += landing

    def _forget_moment(self):
        self.__dict__.pop("snapshot", None)
        self.__dict__.pop("sums", None)
        self.__dict__.pop("ledger", None)

    def _bring_in(self, deletes):
        """Particles outside the domain."""
        self.solver.bring_in(deletes, 0.5 * self.lightest)
        self._forget_masses()

    def _forget_masses(self):
        for name in ("_constant", "body_mass"):
            self.__dict__.pop(name, None)

    @property
    def _lands(self) -> bool:
        """Whether the next step ends at an output."""
        return self.time + 1.5 * self.dt > self.next_output

    def _take_step(self, _most) -> bool:
        landing = self._lands
        for _ in self._stages():
            pass
        return landing

    def _stages(self) -> Iterator[str]:
        self.lookout.before_step()
        dt = self.dt
        time = self.next_output if self._lands else self.time + dt
        dt_next = self._fitting(self.time_step.choose(), time)
        yield from self.solver.stages(self.time, dt, dt_next)
        self.time_step.move(dt, self.solver.motion)
        self.dt = dt_next
        self._note_steps(time, [dt], [self.time_step.code])

    def _take_whole_steps(self, most) -> bool:
        self.lookout.before_step()
        more = self.output_count + 1 < self.outputs.count
        rule = self.time_step
        clock = Clock(
            self.time, self.dt, self.next_output,
            self.outputs.time(self.output_count + 2) if more else 0.0,
            rule.last, rule.motion, self.solver.drift, rule.pace, rule.growth_left,
        )  # fmt: skip
        kind = "cpu" if self.device == "cpu" else "gpu"
        patience = max(1, PARTICLE_STEPS[kind] // self.ranges[-1])
        together = min(most, MOST_TOGETHER, patience, self.lookout.patience)
        self.solver.take_whole_steps(clock, int(together))
        self.dt = clock.dt
        rule.take_up(clock)
        self._note_steps(clock.time, clock.lengths.tolist(), clock.bounds.tolist())
        landing = clock.time == self.next_output
        if not clock.is_good:
            self._fitting(clock.last, clock.time)  # says what is wrong with it
        return landing

    def _note_steps(self, time, lengths, bounds):
        self.time, self.step_count, self.last_dt = time, self.step_count + len(lengths), lengths[-1]
        self.time_step.note(lengths, bounds)
        if self.time_step.is_nameless:
            self.time_step.name(self.solver.named_motion(self.last_dt))
        if self.time_step.is_look_due:
            self._look()

    def _look(self):
        """At the stiffness that all particles have now."""
        self.time_step.see(self.solver.stiffness())

    def run(self, recorders=()) -> None:
        """Step to the end.  Each recorder sees the start, every output and every step; one that has
        `every_steps` at least those that it divides, or none between outputs if it is None.

        A plain function serves as a recorder: it is called with the simulation at the start and at
        every output."""
        recorders = [as_recorder(one) for one in recorders]
        if not self.is_started:
            self.is_started = True
            for recorder in recorders:
                recorder.record(self, is_output=True)
        while not self.is_done:
            landed = self.advance(self._steps_to_next_record(recorders))
            for recorder in recorders:
                recorder.record(self, is_output=landed)

    def state(self) -> dict[str, Any]:
        """The numbers of a checkpoint; its fields are `solver.stored`."""
        clock = {name: getattr(self, name) for name in CLOCK}
        parts = {"time_step": self.time_step, "lookout": self.lookout, "solver": self.solver}
        return clock | {name: part.state() for name, part in parts.items()}

    def restore(self, state: dict[str, Any], arrays: dict[str, np.ndarray]) -> None:
        """Go on from a checkpoint of the same scene, version and precision."""
        for name in CLOCK:
            setattr(self, name, state[name])
        self.is_amid_step = False
        self.time_step.restore(state["time_step"])
        self.lookout.restore(state["lookout"])
        self.solver.restore(state["solver"], arrays)
        self._forget_moment()
        self._forget_masses()
        self.lookout.at_particles()

    def shorten_steps(self, reduction: float) -> None:
        """From the second one on: the impulse of the first is with the particles already."""
        self.time_step.reduction = reduction

    def _steps_to_next_record(self, recorders):
        if self.step_count == 0:  # the first step compiles
            return 1
        wanted = {getattr(recorder, "every_steps", 1) or MOST_TOGETHER for recorder in recorders}
        return min((every - self.step_count % every for every in wanted), default=MOST_TOGETHER)

    def frames(self):
        """Step to the end, pausing at each output: `for sim in simulation.frames()`."""
        yield self
        while not self.is_done:
            if self.advance():
                yield self

    @cached_property
    def _constant(self) -> dict[str, np.ndarray]:
        """What does not change, but where particles are deleted: nothing is left of those."""
        if self.scene.domain.outside != "delete" or not self.solver.particles.brought_in[None]:
            return self.at_start
        m, V0 = map(self.solver.particles.to_numpy, ("m", "V0"))
        gone = m < 0.5 * self.lightest
        m[gone], V0[gone] = 0.0, 0.0
        return {"mass": m, "initial_volume": V0}

    @property
    def is_deleted(self) -> np.ndarray:
        """[n], whether the particle has left the domain and was taken out."""
        return self._constant["mass"] == 0

    @cached_property
    def snapshot(self) -> Snapshot:
        """The particles now; computed once a step at most."""
        with np.errstate(all="ignore"):  # what is no number is told below, in words
            snapshot = take_snapshot(self.solver, self._constant, self.time, self.step_count)
        finite = np.isfinite(snapshot.position) & np.isfinite(snapshot.velocity)
        finite = finite.all(axis=1) & np.isfinite(snapshot.energy_density)
        if not finite.all():
            raise gone_wrong(self, int(np.flatnonzero(~finite)[0]))
        return snapshot

    @cached_property
    def sums(self) -> dict[str, np.ndarray]:
        """Of each body now (kernels/sums.py); computed once a step at most, for a small part of the
        cost of a snapshot."""
        solver = self.solver
        with np.errstate(all="ignore"):
            found = sums(solver.particles, solver.grid, solver.basis, solver.transfer, self.ranges)
        if not all(np.isfinite(values).all() for values in found.values()):
            _ = self.snapshot  # names the particle that is no number
        return found

    @cached_property
    def ledger(self) -> dict[str, float]:
        """What the audit has counted since the start (ledger.py); nothing where it is off."""
        return ledger(self.solver, self.sums) if self.scene.output.audit else {}

    def warnings(self) -> dict[str, int]:
        """What a reader of the results should know, with counts."""
        return cautions(self)

    def describe_particle(self, number: int) -> str:
        """Particle by its place in the scene: number, body, material."""
        body = int(np.searchsorted(self.ranges, number, side="right")) - 1
        spec = self.scene.bodies[body]
        return f"particle {number} (body {spec.name}, material {spec.material})"

    def _repr_png_(self) -> bytes | None:
        """What a notebook shows of it: its picture now."""
        return picture(self)

    @cached_property
    def body_mass(self) -> np.ndarray:
        """Mass of each body [kg], shape [bodies], without what was deleted."""
        return np.add.reduceat(self._constant["mass"], self.ranges[:-1])

    @cached_property
    def body_of_particle(self) -> np.ndarray:
        """Index of the body of each particle, shape [n]."""
        return np.repeat(np.arange(len(self.scene.bodies)), np.diff(self.ranges))
