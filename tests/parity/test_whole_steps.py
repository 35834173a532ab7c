"""Whole steps in one launch, as few particles take them, against the twin step by step."""

from math import sqrt

import numpy as np
import pytest

from mpm_taichi.bases import CubicBSpline, Linear, QuadraticBSpline
from mpm_taichi.expressions import Expressions
from mpm_taichi.kernels.clock import Clock
from mpm_taichi.schedules import even_step
from mpm_taichi.time_step import GROWTH, HUGE, MOST_GROWTH, Motion, Pace
from mpm_taichi.transfers import FLIP, MLS, TPIC, FLIPBlend

from .states import build, largest_difference, particle_fields

TOLERANCE = 1e-12
"""As in test_stages.py."""

FIRST, SECOND = 7e-4, 1.1e-3
"""Times of two outputs [s]."""


MOTION = Motion(speed=3.0, rate=20.0, compression=10.0)
"""At the start."""


def pace(given):
    """Where `given` is 0, steps that the speed decides, some 0.3 ms long, growth the first."""
    return Pace(
        longest=given or HUGE, safety=0.4, acoustic=0.09, wave_speed=90.0, constant=8e-4,
        travel=0.05, deformation=0.02, growth=GROWTH, stiffening=2.0, packing=3.0,
    )  # fmt: skip


def next_length(motion, given, chosen, remaining):
    """The rule written out; `chosen`: what it has allowed so far, `remaining` to an output [s]."""
    speed, rate, *_ = motion
    allowed = min(0.09 / (90.0 + speed), 8e-4, 0.05 / speed, 0.02 / rate)
    chosen.append(min(given or HUGE, 0.4 * allowed, GROWTH * chosen[-1]))
    return even_step(remaining, chosen[-1]) if remaining else chosen[-1]


def by_hand(twin, given, dt, last):
    """Steps of the twin to both outputs: their lengths, the next, the growth of moduli at most and
    the motion of the last one."""
    time, lengths, targets, chosen, motion = 0.0, [], [FIRST, SECOND], [last], MOTION
    growth = 0.0
    while targets:
        start, landing = time, time + 1.5 * dt > targets[0]
        time = targets.pop(0) if landing else time + dt
        remaining = targets[0] - time if targets else 0.0
        lengths.append(dt)
        dt_next = next_length(motion, given, chosen, remaining)
        motion = twin.step(start, dt, dt_next)
        growth += dt * max(2.0 * motion[1], 3.0 * motion[2])
        dt = dt_next
    return lengths, dt, growth, motion


CASES = [
    (2, QuadraticBSpline, MLS, 0.0, False),
    pytest.param(2, QuadraticBSpline, FLIPBlend, 0.0, True, marks=pytest.mark.slow),
    pytest.param(2, CubicBSpline, TPIC, 0.0, False, marks=pytest.mark.campaign),
    pytest.param(3, Linear, FLIP, 2.5e-4, False, marks=pytest.mark.slow),
]


@pytest.mark.parametrize(("dim", "basis", "transfer", "given", "forced"), CASES)
def test_whole_steps_equal_the_twin(exact, rng, dim, basis, transfer, given, forced):
    """Up to two outputs, with walls, gravity, two laws, and a body force that depends on place and
    time: the same lengths, outputs reached exactly, the same particles.  The steps of one launch
    end at an output; there are more of them than one launch may take."""
    force = Expressions(["3*sin(X + 2*y) - t", "x*Y + 40*t**2", "x"][:dim], dim=dim)
    fast, twin = build(
        rng, dim, basis.__name__, transfer.__name__, whole=True,
        body_force=force if forced else None,
    )  # fmt: skip
    assert fast.is_whole
    dt = even_step(FIRST, 2.5e-4)
    fast.start(dt)
    twin.start(dt)
    lengths, dt_next, growth, motion = by_hand(twin, given, dt, 2.5e-4)

    clock = Clock(0.0, dt, FIRST, SECOND, 2.5e-4, MOTION, fast.drift, pace(given), growth_left=1e3)
    found = []
    while clock.time < SECOND:
        fast.take_whole_steps(clock, 3)
        found += clock.lengths.tolist()
        assert clock.is_good
        if clock.time == FIRST:
            clock.target, clock.after = SECOND, 0.0
    assert clock.time == SECOND
    assert found == pytest.approx(lengths, rel=TOLERANCE)
    assert clock.dt == pytest.approx(dt_next, rel=TOLERANCE)
    assert clock.motion[:3] == pytest.approx(motion, rel=TOLERANCE)
    assert 1e3 - clock.growth_left == pytest.approx(growth, rel=TOLERANCE, abs=1e3 * TOLERANCE)
    for name, (ours, theirs) in particle_fields(fast, twin).items():
        assert largest_difference(ours, theirs) < TOLERANCE, name


def test_a_launch_looks_at_the_stiffness(exact, rng):
    """A step that takes the growth of moduli that was left: what the launch tells of each material
    is what `stiffest` tells of the same particles, and the rule follows: the largest wave speed,
    and the shortest limit of a lone particle where the others last longer.  A second step, of
    little strain, looks no more."""
    given = pace(0.0)._replace(lasting=7.0, lone=2e-3)
    fast, _ = build(rng, 2, "QuadraticBSpline", "MLS", whole=True)
    fast.start(1e-5)
    clock = Clock(0.0, 1e-5, FIRST, SECOND, 1e-5, MOTION, fast.drift, given, growth_left=1e-9)
    fast.take_whole_steps(clock, 1)
    assert clock.stiffness == fast.stiffness()
    assert len(clock.stiffness) == 2
    wave = max(now.wave / material.density for material, now in clock.stiffness.items())
    lone = max(now.lone / material.density for material, now in clock.stiffness.items())
    expected = given._replace(wave_speed=sqrt(wave), constant=2e-3 / sqrt(lone))
    assert clock.pace == pytest.approx(expected, rel=1e-15)
    assert clock.growth_left == MOST_GROWTH
    fast.take_whole_steps(clock, 1)
    assert clock.stiffness == {}
    assert 0 < clock.growth_left < MOST_GROWTH


def test_a_step_that_is_no_number_is_told(exact, rng):
    """A velocity of 1e200 m/s: its square is infinite, and so is the strain of the first step,
    which ends a launch; the rule gives 0 for the step after the second, so the clock says so, and
    goes no further."""
    fast, _ = build(rng, 2, "QuadraticBSpline", "MLS", whole=True)
    rows = fast.particles.rows.to_numpy()
    rows[0, 0, :2] = 1e200
    fast.particles.rows.from_numpy(rows)
    fast.start(1e-4)
    clock = Clock(0.0, 1e-4, FIRST, SECOND, 1e-4, MOTION, fast.drift, pace(0.0))
    fast.take_whole_steps(clock, 50)
    assert len(clock.lengths) == 1
    fast.take_whole_steps(clock, 50)
    assert len(clock.lengths) == 1
    assert not clock.is_good
    assert not np.isfinite(clock.dt) or clock.dt < 1e-100
