"""What is looked for between steps, and how often."""

from collections.abc import Callable
from typing import Any

from .errors import MotionError
from .kernels.guard import guard
from .kernels.slivers import EVERY_STEPS
from .trouble import gone_outside, gone_wrong

GUARD_STEPS = 32
"""At most, between two looks at the numbers of all particles, which so cost 1 % of the run."""

COLLAPSE = 1e-6
"""An automatic step shorter than this part of the first one ends the run."""

STORED = ("slivers", "sliver_look", "parting")
"""Of a Lookout, in a checkpoint."""


class Lookout:
    """Looks for particles outside the domain, numbers that are none, nodes too light for the step
    and particles that are about to part.  It changes nothing but where the scene says what becomes
    of particles outside; `bring_in(deletes)` does that.

    `slivers` counts the nodes too light that were seen, `parting` the particles about to lose their
    neighbors, most at an output."""

    def __init__(self, simulation, bring_in: Callable[[bool], None]):
        self.simulation, self.bring_in = simulation, bring_in
        self.guard_steps, self.guarded = GUARD_STEPS, 0
        self.slivers, self.sliver_look = 0, 0  # their count, and the step of the next look
        self.parting = 0

    @property
    def patience(self) -> int:
        """Steps until the next look."""
        if not self.simulation.time_step.fears_slivers:
            return self.guard_steps
        return min(self.guard_steps, self.sliver_look - self.simulation.step_count)

    def before_step(self) -> None:
        """Only then, since it leaves what it sums up at the nodes."""
        simulation = self.simulation
        if simulation.step_count >= self.sliver_look and simulation.time_step.fears_slivers:
            self.slivers += simulation.solver.slivers(simulation.dt)
            self.sliver_look = simulation.step_count + EVERY_STEPS

    def after_step(self) -> None:
        """MotionError where a particle is lost or the step has collapsed, and, looked for now and
        then, where numbers are none."""
        simulation = self.simulation
        particles = simulation.solver.particles
        if particles.lost[None] < particles.count:
            self._settle_outside()
        if simulation.time_step.given is None and simulation.dt < COLLAPSE * simulation.first_dt:
            raise MotionError(
                f"t = {simulation.time:.6g} s, step {simulation.step_count}: the time step has "
                f"fallen from {simulation.first_dt:.3g} to {simulation.dt:.3g} s: the run has "
                "blown up"
            )
        if simulation.step_count - self.guarded >= self.guard_steps:
            self.at_particles()

    def at_output(self) -> None:
        self.at_particles()
        self.parting = max(self.parting, self.simulation.solver.particles.parting[None])

    def at_particles(self) -> None:
        """MotionError where a particle's numbers are none, or no longer those of matter."""
        self.guarded = self.simulation.step_count
        particles = self.simulation.solver.particles
        guard(particles)
        bad = particles.bad[None]
        if bad < particles.count:
            raise gone_wrong(self.simulation, bad)

    def _settle_outside(self):
        """What the scene says of particles outside its domain."""
        rule = self.simulation.scene.domain.outside
        if rule == "stop":
            raise gone_outside(self.simulation)
        self.at_particles()  # a position that is no number is nowhere
        self.bring_in(rule == "delete")

    def state(self) -> dict[str, Any]:
        return {name: getattr(self, name) for name in STORED}

    def restore(self, state: dict[str, Any]) -> None:
        for name in STORED:
            setattr(self, name, state[name])
