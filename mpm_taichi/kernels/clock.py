"""The clock of steps that the device takes by itself: where it is, when it stops, what it has told.

Its times count from the `origin` of a launch where it has 32 bits, and so do not round with the
length of the run."""

from dataclasses import dataclass, field
from math import inf

import numpy as np
import taichi as ti

from ..materials import Material
from ..runtime import Template
from ..schedules import MOST
from ..time_step import MOST_GROWTH, Motion, Pace, Stiffness
from .stiffness import look_again
from .time_step import NARROW_HUGE, growth_of_moduli, is_narrow, wide

(
    ORIGIN, TIME, DT, TARGET, AFTER, LAST, DRIFT, LEFT, LOOKS, TAKEN, ON, GOOD, SPEED, RATE,
    COMPRESSION,
) = range(15)  # fmt: skip

LENGTH, BOUND = range(2)
"""Columns of the log, a row for each step."""


@dataclass
class Clock:
    """Where a run is, and how far it may go: `time` [s], the length `dt` [s] of the next step, the
    longest that the rule allowed `last`; `target` and `after`, the times of the next two outputs
    (after: 0 if there is none); the `motion` of the last step; the `drift` [cells] of particles
    since they were sorted, and the growth of their moduli that is left until these are looked at.
    `pace` is the rule, which follows what is seen, and `stiffness` what this launch has seen last
    of each material; empty where it did not look.

    `lengths` [s] are those of the steps taken, `bounds` (of mpm_taichi/time_step.py) what bound the
    one after each; `is_good`: the next is a number, not too short."""

    time: float
    dt: float
    target: float
    after: float
    last: float
    motion: Motion
    drift: float
    pace: Pace
    growth_left: float = inf
    stiffness: dict[Material, Stiffness] = field(default_factory=dict)
    lengths: np.ndarray = field(default_factory=lambda: np.zeros(0))
    bounds: np.ndarray = field(default_factory=lambda: np.zeros(0, np.int32))
    is_good: bool = True

    @property
    def origin(self) -> float:
        """[s], from which the device counts."""
        return self.time if is_narrow() else 0.0

    def numbers(self) -> np.ndarray:
        """For the device."""
        origin = self.origin
        return in_reach([
            origin, self.time - origin, self.dt, self.target - origin,
            self.after - origin if self.after else 0.0, self.last, self.drift, self.growth_left,
            0, 0, 1, 1, self.motion.speed, self.motion.rate, self.motion.compression,
        ])  # fmt: skip

    def take_up(self, numbers, log) -> None:
        """What the device has made of them, and its log."""
        landed = numbers[TIME] == numbers[TARGET]
        self.time = self.target if landed else self.origin + float(numbers[TIME])
        self.dt, self.last = map(float, numbers[[DT, LAST]])
        speed, rate, compression = map(float, numbers[[SPEED, RATE, COMPRESSION]])
        self.motion = Motion(speed, rate, compression)
        self.drift, self.growth_left = map(float, numbers[[DRIFT, LEFT]])
        self.is_good, taken = bool(numbers[GOOD]), int(numbers[TAKEN])
        self.lengths, self.bounds = log[:taken, LENGTH], log[:taken, BOUND].astype(np.int32)


def in_reach(numbers) -> np.ndarray:
    """In the floats of the device."""
    if is_narrow():
        return np.clip(numbers, -NARROW_HUGE, NARROW_HUGE).astype(np.float32)
    return np.array(numbers, float)


@ti.func
def is_landing(clock: Template):
    """Whether the next step ends at an output."""
    return clock[TIME] + 1.5 * clock[DT] > clock[TARGET]


@ti.func
def turn(
    clock: Template, log: Template, pace: Template, end, goal, longest, bound, dt_next,
    particles: Template, grid: Template, densities: Template, seen: Template,
):  # fmt: skip
    """After a step to the time `end`, where the next output is due at `goal`.  The clock stops at
    an output, where a sort is due, a particle is lost, the next step is no number or, on a GPU,
    the stiffness has to be looked at."""
    dt, landing, row = clock[DT], is_landing(clock), int(clock[TAKEN])
    log[row, LENGTH], log[row, BOUND] = dt, wide(bound)
    clock[TAKEN] = wide(row + 1)
    clock[TIME], clock[DT], clock[LAST] = end, dt_next, longest
    clock[SPEED] = ti.sqrt(wide(grid.speed_squared[None]))
    clock[RATE] = ti.sqrt(wide(grid.rate_squared[None]))
    clock[COMPRESSION] = wide(grid.compression[None])
    clock[DRIFT] = clock[DRIFT] + dt * clock[SPEED] * grid.constants[None].inv_dx
    clock[LEFT] = clock[LEFT] - dt * growth_of_moduli(pace, clock[RATE], clock[COMPRESSION])
    if not clock[LEFT] > 0.0:
        if ti.static(grid.atomic):
            clock[ON] = 0.0
        else:
            look_again(particles, pace, densities, seen)
            clock[LEFT] = MOST_GROWTH
            clock[LOOKS] = clock[LOOKS] + 1.0
    clock[GOOD] = 0.0
    if goal == 0.0 or goal - end < float(MOST) * longest:
        clock[GOOD] = 1.0
    if (
        landing
        or clock[GOOD] == 0.0
        or clock[DRIFT] >= 0.99
        or particles.lost[None] < particles.count
    ):
        clock[ON] = 0.0
