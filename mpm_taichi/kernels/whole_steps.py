"""Several steps without a return to the host.

Few particles on a CPU take them in one launch and on one thread: a launch and its hand-off to the
threads cost some 50 microseconds, and a step has eight, more than all the work of a thousand
particles.  On a GPU a step is one launch, and the host queues several without reading anything back
between them: each reading would wait until the device has nothing more to do."""

from math import ceil

import numpy as np
import taichi as ti

from ..runtime import Array, Template, widest_float
from ..stages import stage
from ..time_step import Pace, Stiffness
from .clock import COMPRESSION, LOOKS, ON, in_reach
from .tally import NoTally
from .whole_step import take_step

MOST_TOGETHER = 64
"""Steps at most."""


@ti.kernel
def take_steps(
    particles: Template, grid: Template, basis: Template, transfer: Template, walls: Template,
    gravity: Template, body_force: Template, flip: Array, pace: Array, densities: Array,
    seen: Array, tally: Template, most: int, clock: Array, log: Array,
):  # fmt: skip
    ti.loop_config(serialize=True)
    for _ in range(most):
        if clock[ON] > 0.0:
            take_step(
                particles, grid, basis, transfer, walls, gravity, body_force, flip, pace,
                densities, seen, tally, clock, log, 1,
            )  # fmt: skip


@ti.kernel
def queue_step(
    particles: Template, grid: Template, basis: Template, transfer: Template, walls: Template,
    gravity: Template, body_force: Template, flip: Template, pace: Template, clock: Template,
    log: Template,
):  # fmt: skip
    take_step(
        particles, grid, basis, transfer, walls, gravity, body_force, flip, pace, None, None,
        NoTally, clock, log, int(clock[ON]),
    )  # fmt: skip


class Desk:
    """What a step that is queued on a GPU reads and writes of the clock and the rule."""

    def __init__(self, flip_part):
        real = widest_float()
        self.clock, self.pace = ti.field(real, COMPRESSION + 1), ti.field(real, len(Pace._fields))
        self.flip, self.log = ti.field(real, 2), ti.field(real, (MOST_TOGETHER, 2))
        self.flip.from_numpy(in_reach(flip_part))


def likely_steps(clock, grid, most) -> int:
    """Of `most`: those before an output or a sort, as they look now.  Further ones in the queue
    would find nothing to do, and too few only make one more queue."""
    to_output = round((clock.target - clock.time) / clock.dt)
    moved = clock.dt * clock.motion.speed / grid.dx
    to_sort = ceil((1 - clock.drift) / moved) if moved > 1 / most else most
    return max(1, min(most, to_output, to_sort))


@stage
def queued_steps(
    particles, grid, basis, transfer, walls, gravity, body_force, desk, clock, most
):  # fmt: skip
    """As `whole_steps` on a GPU, where no step is queued that is not likely to be taken."""
    desk.clock.from_numpy(clock.numbers())
    desk.pace.from_numpy(in_reach(clock.pace))
    for _ in range(likely_steps(clock, grid, most)):
        queue_step(
            particles, grid, basis, transfer, walls, gravity, body_force, desk.flip, desk.pace,
            desk.clock, desk.log,
        )  # fmt: skip
    clock.take_up(desk.clock.to_numpy(), desk.log.to_numpy().astype(float))


@stage
def whole_steps(
    particles, grid, basis, transfer, walls, gravity, body_force, flip_part, clock, most,
    tally=NoTally,
):  # fmt: skip
    """Up to `most` steps from `clock`, fewer where it stops (kernels/clock.py).  On return the
    clock says how far that was."""
    numbers, pace, log = clock.numbers(), in_reach(clock.pace), np.zeros((most, 2))
    seen = np.zeros((len(particles.groups), 4))
    densities = np.array([group.material.density for group in particles.groups], float)
    take_steps(
        particles, grid, basis, transfer, walls, gravity, body_force, np.array(flip_part, float),
        pace, densities, seen, tally, most, numbers, log,
    )  # fmt: skip
    clock.take_up(numbers, log)
    clock.stiffness = {}
    if numbers[LOOKS]:
        clock.pace = Pace(*pace.tolist())
        clock.stiffness = {
            group.material: Stiffness(wave, int(wave_particle), lone, int(lone_particle))
            for group, (wave, wave_particle, lone, lone_particle) in zip(
                particles.groups, seen.tolist(), strict=True
            )
        }
