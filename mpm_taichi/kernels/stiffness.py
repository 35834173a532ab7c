"""For the time step: how stiff the stiffest particle of a material is."""

import numpy as np
import taichi as ti

from ..runtime import Array, Template
from .blocks import first_block
from .sums import MOST_BLOCKS
from .time_step import CONSTANT, LASTING, LONE_LENGTH, WAVE_SPEED, wide
from .update_stress import load_state

WAVE, LONE = range(2)


@ti.func
def stiffest_of(particles: Template, law: Template, material, begin, end):
    """As `stiffest`, of particles begin ... end - 1."""
    wave_most, wave_place, lone_most, lone_place = 0.0, begin, 0.0, begin
    for p in range(begin, end):
        wave, lone = law.kind.moduli(law.constants[material], particles.H[p], load_state(law, p))
        if wave > wave_most:
            wave_most, wave_place = wave, p
        if lone > lone_most:
            lone_most, lone_place = lone, p
    return wave_most, particles.id[wave_place], lone_most, particles.id[lone_place]


@ti.func
def look_share(
    particles: Template, law: Template, material, begin, end, size, largest: Template,
    places: Template, worker, workers,
):  # fmt: skip
    blocks = largest.shape[0]
    for block in range(
        first_block(worker, workers, blocks), first_block(worker + 1, workers, blocks)
    ):
        first = begin + block * size
        wave, wave_particle, lone, lone_particle = stiffest_of(
            particles, law, material, first, ti.min(first + size, end)
        )
        largest[block, WAVE], places[block, WAVE] = wave, wave_particle
        largest[block, LONE], places[block, LONE] = lone, lone_particle


@ti.func
def look_again(particles: Template, pace: Template, densities: Template, seen: Template):
    """As Simulation does between launches: `seen` [materials, 4] becomes what `stiffest` tells of
    each, and the rule `pace` follows."""
    pace[WAVE_SPEED], pace[CONSTANT] = wide(0.0), pace[LASTING]
    for law in ti.static(particles.laws):
        for material in range(law.constants.shape[0]):
            k = law.first + material
            wave, wave_particle, lone, lone_particle = stiffest_of(
                particles, law, material, law.ends[material], law.ends[material + 1]
            )
            seen[k, 0], seen[k, 1] = wide(wave), wide(wave_particle)
            seen[k, 2], seen[k, 3] = wide(lone), wide(lone_particle)
            pace[WAVE_SPEED] = ti.max(pace[WAVE_SPEED], ti.sqrt(seen[k, 0] / densities[k]))
            if lone > 0.0:
                alone = pace[LONE_LENGTH] * ti.sqrt(densities[k] / seen[k, 2])
                pace[CONSTANT] = ti.min(pace[CONSTANT], alone)


@ti.kernel
def look(
    particles: Template, law: Template, material: int, grid: Template, begin: int, end: int,
    size: int, largest: Array, places: Array, workers: int,
):  # fmt: skip
    for counter in range(grid.gate * workers):
        if counter % grid.gate == 0:
            look_share(
                particles, law, material, begin, end, size, largest, places,
                counter // grid.gate, workers,
            )  # fmt: skip


def stiffest(particles, group, grid) -> tuple[float, int, float, int]:
    """The largest rho0 c^2 [Pa] of the particles of a material and whose it is (its place in the
    scene), and the largest modulus M_d [Pa] of a lone one and whose that is.

    Each block of particles has its own; then the largest of these is taken, of equal ones the
    first: the result does not depend on the number of threads."""
    count = group.end - group.begin
    size = max(grid.block, -(-count // MOST_BLOCKS["gpu" if grid.atomic else "cpu"]))
    blocks = -(-count // size)
    largest = np.zeros((blocks, 2), particles.dtype)
    places = np.zeros((blocks, 2), np.int32)
    look(
        particles, group.law, group.number, grid, group.begin, group.end, size, largest, places,
        grid.workers(blocks),
    )  # fmt: skip
    at = largest.argmax(axis=0)
    wave, lone = ((float(largest[at[k], k]), int(places[at[k], k])) for k in (WAVE, LONE))
    return *wave, *lone
