"""The length of the next step, on the device: the rules of mpm_taichi/time_step.py and schedules.py
in the same numbers, in f64 whatever the precision of the run."""

import taichi as ti

from ..runtime import Template


@ti.func
def longest_step(pace: Template, speed, last):
    """The longest step [s] that may be taken at the largest nodal speed [m/s]."""
    p = pace[None]
    length = p.given
    if length == 0.0:
        allowed = ti.min(p.acoustic / (p.wave_speed + speed), p.constant)
        if speed > 0.0:
            allowed = ti.min(allowed, p.travel / speed)
        length = ti.min(p.safety * allowed, p.growth * last)
    return length


@ti.func
def even_step(remaining, longest):
    """The longest step up to `longest` of which a whole number makes up `remaining` [s]."""
    count = ti.ceil(remaining / longest - ti.cast(1e-6, ti.f64))
    return remaining / ti.max(ti.cast(1.0, ti.f64), count)
