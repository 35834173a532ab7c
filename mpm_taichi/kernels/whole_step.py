"""One step, timed by the device: the stages in the order of `Solver.step` for USL.

At the root of a kernel, as on a GPU, each loop over workers is parallel, which it is not under an
`if`; and one whose end is known when it is compiled has no more threads than it needs.  Inside the
serial loop of a CPU the only worker does it all."""

import taichi as ti

from ..runtime import Template, has_wide_functions
from .blocks import active_blocks
from .body_force import push_share
from .clear import clear_share
from .clock import AFTER, DT, LAST, ORIGIN, RATE, SPEED, TARGET, TIME, is_landing, turn
from .g2p import gather_share
from .ghosts import exchange_share
from .grid_update import update_share
from .p2g import scatter_particle, scatter_share
from .tally import NoTally, note_share
from .time_step import even_step, longest_step
from .update_stress import note_motion, stress_share, update_particle


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
    axis: Template, grid: Template, walls: Template, gravity: Template, dt, updated: Template,
    fill: Template, worker, workers,
):  # fmt: skip
    """Fold or fill ghost nodes."""
    exchange_share(
        axis, grid, walls, gravity, dt, updated, fill, grid.records, grid.lines_along[axis],
        worker, workers,
    )  # fmt: skip


@ti.func
def scatter_all(particles: Template, grid: Template, basis: Template, transfer: Template, worker):
    """On a GPU one particle, else all."""
    if ti.static(grid.atomic):
        scatter_particle(worker, particles, grid, basis, transfer, "all")
    else:
        for color in range(grid.colors):
            scatter_share(particles, grid, basis, transfer, "all", color, worker, 1)


@ti.func
def update_one(
    p, particles: Template, law: Template, grid: Template, transfer: Template, dt, dt_next, alpha
):
    """Particle p, whichever of the materials of a law it is of."""
    material = 0
    for k in ti.static(range(1, law.constants.shape[0])):
        if p >= law.ends[k]:
            material = k
    speed_squared, rate_squared, compression = update_particle(
        p, particles, law, material, grid, transfer, dt, dt_next, alpha, True, True, True,
        NoTally, 0,
    )  # fmt: skip
    note_motion(grid, speed_squared, rate_squared, compression)


@ti.func
def update_law(
    particles: Template, law: Template, grid: Template, transfer: Template, dt, dt_next, alpha,
    tally: Template, worker,
):  # fmt: skip
    """All particles of a law, on a GPU one of them."""
    count = ti.static(law.constants.shape[0])
    if ti.static(grid.atomic):
        if law.begin + worker < law.ends[count]:
            p = law.begin + worker
            update_one(p, particles, law, grid, transfer, dt, dt_next, alpha)
    else:
        for material in range(count):
            stress_share(
                particles, law, material, grid, transfer, law.ends[material],
                law.ends[material + 1], dt, dt_next, alpha, True, True, True, tally, 0, 1,
            )  # fmt: skip


@ti.func
def note(grid: Template, gravity: Template, dt, alpha, tally: Template, when: Template):
    if ti.static(tally.has_walls and (when != "kept" or tally.lets_go)):
        note_share(grid, gravity, dt, alpha, tally, when, 0, 1)


@ti.func
def flip_decay(exponent):
    """exp(-exponent); that of Vulkan and Metal has 32 bits."""
    if ti.static(has_wide_functions()):
        return ti.exp(-exponent)
    else:
        return ti.exp(ti.cast(-exponent, ti.f32))


@ti.func
def take_step(
    particles: Template, grid: Template, basis: Template, transfer: Template, walls: Template,
    gravity: Template, body_force: Template, flip: Template, pace: Template, densities: Template,
    seen: Template, tally: Template, clock: Template, log: Template, on,
):  # fmt: skip
    """A step, or nothing where it is not `on`."""
    all_hands = ti.static(particles.count if grid.atomic else 1)
    at_lines = ti.static(sorted(grid.lines_along)[-1] if grid.atomic else 1)
    at_nodes = 1
    if ti.static(grid.atomic):
        at_nodes = on * active_blocks(grid)
    time, dt = clock[TIME], clock[DT]
    h = ti.cast(dt, float)
    alpha = ti.cast(flip[0] * flip_decay(flip[1] * dt), float)
    longest, bound = longest_step(pace, clock[SPEED], clock[RATE], clock[LAST])
    end, goal = time + dt, clock[TARGET]
    if is_landing(clock):
        end, goal = clock[TARGET], clock[AFTER]
    dt_next = even_step(goal - end, longest) if goal > 0.0 else longest
    if on:
        grid.speed_squared[None], grid.rate_squared[None] = 0.0, 0.0
        grid.compression[None] = 0.0

    if ti.static(particles.layout.force):
        for worker in range(all_hands):
            if on:
                moment = ti.cast(clock[ORIGIN] + time, float)
                push_share(particles, grid, body_force, moment, h, worker, all_hands)
    for worker in range(at_nodes):
        clear_share(grid, worker, at_nodes)
    for worker in range(all_hands):
        if on:
            scatter_all(particles, grid, basis, transfer, worker)
    note(grid, gravity, h, alpha, tally, "given")
    for axis in ti.static(grid.folded):
        for worker in range(at_lines):
            if on and is_near_end(axis, grid):
                exchange(axis, grid, walls, gravity, h, False, False, worker, at_lines)
    for worker in range(at_nodes):
        update_share(grid, walls, gravity, h, tally, worker, at_nodes)
    note(grid, gravity, h, alpha, tally, "kept")
    for axis in ti.static(grid.folded):
        for worker in range(at_lines):
            if on and is_near_end(axis, grid):
                exchange(axis, grid, walls, gravity, 0.0, True, True, worker, at_lines)
    note(grid, gravity, h, alpha, tally, "taken")
    for worker in range(all_hands):
        if on:
            gather_share(particles, grid, basis, transfer, "all", h, tally, worker, all_hands)
    for law in ti.static(particles.laws):
        for worker in range(all_hands):
            if on:
                h_next = ti.cast(dt_next, float)
                update_law(particles, law, grid, transfer, h, h_next, alpha, tally, worker)
    if on:
        turn(clock, log, pace, end, goal, longest, bound, dt_next, particles, grid, densities, seen)
