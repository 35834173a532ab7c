"""The length of the next step, on the device: the rules of mpm_taichi/time_step.py and schedules.py
in the same numbers, in f64 where the device has it, whatever the precision of the run."""

import numpy as np
import taichi as ti
from taichi.lang.util import to_numpy_type

from ..runtime import Template, widest_float
from ..time_step import HUGE, Pace

(
    LONGEST, SAFETY, ACOUSTIC, WAVE_SPEED, CONSTANT, TRAVEL, DEFORMATION, GROWTH, STIFFENING,
    PACKING, LASTING, LONE_LENGTH,
) = range(len(Pace._fields))  # fmt: skip

NARROW_HUGE = 1e18
"""As HUGE, where the clock has 32 bits."""

NARROW_SLACK = 1e-5
"""There a step may be longer than its limit by this part, to make up a whole number of them: as
much as the clock may round in 64 steps."""


def is_narrow() -> bool:
    """Whether the clock of the device has 32 bits, once Taichi has started."""
    return to_numpy_type(widest_float()) == np.float32


@ti.func
def wide(x):
    """In the floats of the clock."""
    if ti.static(is_narrow()):
        return ti.cast(x, ti.f32)
    else:
        return ti.cast(x, ti.f64)


@ti.func
def longest_step(pace: Template, speed, rate, last):
    """As Pace.step: the longest step [s], and which of BOUNDS it is."""
    still = wide(ti.static(1 / (NARROW_HUGE if is_narrow() else HUGE)))
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
    count = remaining / longest
    if ti.static(is_narrow()):
        count *= 1.0 - NARROW_SLACK
    return remaining / ti.max(wide(1.0), ti.ceil(count - wide(1e-6)))
