"""The length of the next step, on the device: the rules of mpm_taichi/time_step.py and schedules.py
in the same numbers, in f64 whatever the precision of the run."""

import taichi as ti

from ..runtime import Template
from ..time_step import HUGE, Pace

(
    LONGEST, SAFETY, ACOUSTIC, WAVE_SPEED, CONSTANT, TRAVEL, DEFORMATION, GROWTH, STIFFENING,
    PACKING, LASTING, LONE_LENGTH,
) = range(len(Pace._fields))  # fmt: skip


@ti.func
def longest_step(pace: Template, speed, rate, last):
    """As Pace.step: the longest step [s], and which of BOUNDS it is."""
    still = ti.cast(1 / HUGE, ti.f64)
    length, bound = pace[LONGEST], 0
    for k, allowed in ti.static(
        enumerate(
            [
                pace[GROWTH] * last,
                pace[SAFETY] * pace[ACOUSTIC] / ti.max(pace[WAVE_SPEED] + speed, still),
                pace[SAFETY] * pace[CONSTANT],
                pace[SAFETY] * pace[TRAVEL] / ti.max(speed, still),
                pace[SAFETY] * pace[DEFORMATION] / ti.max(rate, still),
            ]
        )
    ):
        if allowed < length:
            length, bound = allowed, k + 1
    return length, bound


@ti.func
def growth_of_moduli(pace: Template, rate, compression):
    """As Pace.growth_of_moduli [1/s]."""
    return ti.max(pace[STIFFENING] * rate, pace[PACKING] * compression)


@ti.func
def even_step(remaining, longest):
    """The longest step up to `longest` of which a whole number makes up `remaining` [s]."""
    count = ti.ceil(remaining / longest - ti.cast(1e-6, ti.f64))
    return remaining / ti.max(ti.cast(1.0, ti.f64), count)
