"""Several steps in one launch and on one thread, for small scenes.

A launch and its hand-off to the threads cost some 50 microseconds, and a step has eight: more than
all the work of a thousand particles.  Here the stages follow each other without a return to Python,
in the order of `Solver.step` for USL, and the device chooses the length of the next step."""

from dataclasses import dataclass, field
from math import inf

import numpy as np
import taichi as ti

from ..materials import Material
from ..runtime import Array, Template
from ..schedules import MOST
from ..stages import stage
from ..time_step import MOST_GROWTH, Motion, Pace, Stiffness
from .body_force import push_share
from .clear import clear_share
from .g2p import gather_share
from .ghosts import exchange_share
from .grid_update import update_share
from .p2g import scatter_share
from .stiffness import look_again
from .tally import NoTally, note_share
from .time_step import even_step, growth_of_moduli, longest_step
from .update_stress import stress_share

TIME, DT, TARGET, AFTER, LAST, DRIFT, LEFT, LOOKS, TAKEN, ON, GOOD, SPEED, RATE, COMPRESSION = (
    range(14)
)


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


@ti.func
def is_near_end(axis: Template, grid: Template):
    """Whether particles reach ghost nodes along an axis."""
    near = True
    if ti.static(axis not in grid.periodic):
        low, high = grid.lowest[None][axis] - 1, grid.highest[None][axis] + grid.support
        near = low < grid.ghost or high > grid.ghost + grid.cells[axis]
    return near


@ti.func
def exchange(
    grid: Template, walls: Template, gravity: Template, dt, updated: Template, fill: Template
):
    """Fold or fill the ghost nodes that particles reach."""
    for axis in ti.static(grid.folded):
        if is_near_end(axis, grid):
            exchange_share(
                axis, grid, walls, gravity, dt, updated, fill, grid.records,
                grid.lines_along[axis], 0, 1,
            )  # fmt: skip


@ti.func
def note(grid: Template, gravity: Template, dt, alpha, tally: Template, when: Template):
    if ti.static(tally.has_walls and (when != "kept" or tally.lets_go)):
        note_share(grid, gravity, dt, alpha, tally, when, 0, 1)


@ti.func
def take_step(
    particles: Template, grid: Template, basis: Template, transfer: Template, walls: Template,
    gravity: Template, body_force: Template, flip: Template, pace: Template, densities: Template,
    seen: Template, tally: Template, clock: Template,
):  # fmt: skip
    """Returns which of BOUNDS binds the next step."""
    time, dt, landing = clock[TIME], clock[DT], clock[TIME] + 1.5 * clock[DT] > clock[TARGET]
    h = ti.cast(dt, float)
    alpha = ti.cast(flip[0] * ti.exp(-flip[1] * dt), float)
    if ti.static(particles.layout.force):
        push_share(particles, grid, body_force, ti.cast(time, float), h, 0, 1)
    grid.speed_squared[None], grid.rate_squared[None], grid.compression[None] = 0.0, 0.0, 0.0
    clear_share(grid, 0, 1)
    for color in range(grid.colors):
        scatter_share(particles, grid, basis, transfer, "all", color, 0, 1)
    note(grid, gravity, h, alpha, tally, "given")
    exchange(grid, walls, gravity, h, False, False)
    update_share(grid, walls, gravity, h, tally, 0, 1)
    note(grid, gravity, h, alpha, tally, "kept")
    exchange(grid, walls, gravity, 0.0, True, True)
    note(grid, gravity, h, alpha, tally, "taken")
    gather_share(particles, grid, basis, transfer, "all", h, tally, 0, 1)
    longest, bound = longest_step(pace, clock[SPEED], clock[RATE], clock[LAST])
    end = clock[TARGET] if landing else time + dt
    goal = clock[AFTER] if landing else clock[TARGET]
    dt_next = even_step(goal - end, longest) if goal > 0.0 else longest
    for law in ti.static(particles.laws):
        for material in range(law.constants.shape[0]):
            stress_share(
                particles, law, material, grid, transfer, law.ends[material],
                law.ends[material + 1], h, ti.cast(dt_next, float), alpha, True, True, True, tally,
                0, 1,
            )  # fmt: skip
    clock[TIME], clock[DT], clock[LAST] = end, dt_next, longest
    clock[SPEED] = ti.sqrt(ti.cast(grid.speed_squared[None], ti.f64))
    clock[RATE] = ti.sqrt(ti.cast(grid.rate_squared[None], ti.f64))
    clock[COMPRESSION] = grid.compression[None]
    clock[DRIFT] += dt * clock[SPEED] * grid.constants[None].inv_dx
    clock[LEFT] -= dt * growth_of_moduli(pace, clock[RATE], clock[COMPRESSION])
    if not clock[LEFT] > 0.0:
        look_again(particles, pace, densities, seen)
        clock[LEFT] = MOST_GROWTH
        clock[LOOKS] += 1
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
    return bound


@ti.kernel
def take_steps(
    particles: Template, grid: Template, basis: Template, transfer: Template, walls: Template,
    gravity: Template, body_force: Template, flip: Array, pace: Array, densities: Array,
    seen: Array, tally: Template, most: int, clock: Array, lengths: Array, bounds: Array,
):  # fmt: skip
    ti.loop_config(serialize=True)
    for n in range(most):
        if clock[ON] > 0.0:
            lengths[n] = clock[DT]
            clock[TAKEN] = n + 1
            bounds[n] = take_step(
                particles, grid, basis, transfer, walls, gravity, body_force, flip, pace,
                densities, seen, tally, clock,
            )  # fmt: skip


@stage
def whole_steps(
    particles, grid, basis, transfer, walls, gravity, body_force, flip_part, clock, most,
    tally=NoTally,
):  # fmt: skip
    """Up to `most` steps from `clock`, fewer where an output is reached, a sort is due, a particle
    is lost or the next step is no number.  On return the clock says how far that was."""
    numbers = np.array([
        clock.time, clock.dt, clock.target, clock.after, clock.last, clock.drift,
        clock.growth_left, 0, 0, 1, 1, clock.motion.speed, clock.motion.rate,
        clock.motion.compression,
    ])  # fmt: skip
    lengths, bounds = np.zeros(most), np.zeros(most, np.int32)
    pace, seen = np.array(clock.pace, float), np.zeros((len(particles.groups), 4))
    densities = np.array([group.material.density for group in particles.groups], float)
    take_steps(
        particles, grid, basis, transfer, walls, gravity, body_force, np.array(flip_part, float),
        pace, densities, seen, tally, most, numbers, lengths, bounds,
    )  # fmt: skip
    clock.time, clock.dt, clock.last = map(float, numbers[[TIME, DT, LAST]])
    speed, rate, compression = map(float, numbers[[SPEED, RATE, COMPRESSION]])
    clock.motion = Motion(speed, rate, compression)
    clock.drift, clock.growth_left = map(float, numbers[[DRIFT, LEFT]])
    clock.stiffness = {}
    if numbers[LOOKS]:
        clock.pace = Pace(*pace.tolist())
        clock.stiffness = {
            group.material: Stiffness(wave, int(wave_particle), lone, int(lone_particle))
            for group, (wave, wave_particle, lone, lone_particle) in zip(
                particles.groups, seen.tolist(), strict=True
            )
        }
    clock.is_good, taken = bool(numbers[GOOD]), int(numbers[TAKEN])
    clock.lengths, clock.bounds = lengths[:taken], bounds[:taken]
