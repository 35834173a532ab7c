"""Steps land exactly on output times, and the last on the end."""

from fractions import Fraction

import numpy as np
import pytest

from mpm_taichi import Simulation, load_scene
from mpm_taichi.errors import InputError, RunError
from mpm_taichi.schedules import EverySeconds, even_step
from tests.command_line import SCENES


@pytest.mark.parametrize(
    ("interval", "end", "times"),
    [
        (0.5, 1.0, [0, 0.5, 1.0]),
        (0.4, 1.0, [0, 0.4, 0.8, 1.0]),
        (2.0, 1.0, [0, 1.0]),
        (0.1, 0.3, [0, 0.1, 0.2, 0.3]),  # 0.3 / 0.1 is 2.9999999999999996
        (0.05, 3.5, [*(k * 0.05 for k in range(70)), 3.5]),  # 3.5 / 0.05 is 70.00000000000001
        (3.5 / 7, 3.5, [*(k * 0.5 for k in range(7)), 3.5]),
    ],
)  # fmt: skip
def test_due_times(interval, end, times):
    """0, interval, 2 interval, ... and the end, once, though the quotient is rounded; each time is
    one product, not a sum that drifts."""
    due = EverySeconds(interval, end)
    assert [due.time(k) for k in range(due.count + 1)] == times


def test_any_whole_number_of_intervals(rng):
    """end / n, n up to a million, gives n outputs: the quotient errs by 1e-16 n, far below 1e-6."""
    for _ in range(1000):
        n, end = int(rng.integers(1, 1_000_000)), float(10 ** rng.uniform(-6, 6))
        assert EverySeconds(end / n, end).count == n


def test_too_many_outputs():
    """A clock of 53 bits: refused in words, not an overflow."""
    with pytest.raises(InputError, match=r"output\.every: 1e-300 s makes too many outputs"):
        EverySeconds(1e-300, 1.0)


def test_even_steps(rng):
    """The longest equal steps up to `longest`: n steps make up the rest, and n - 1 would be longer
    than allowed.  A step may exceed `longest` by a millionth part, lest rounding make one more."""
    for _ in range(1000):
        remaining, longest = 10 ** rng.uniform(-6, 3, 2)
        step = even_step(remaining, longest)
        n = round(remaining / step)
        assert step == remaining / n
        assert step <= longest * (1 + 1.01e-6)
        assert n == 1 or remaining / (n - 1) > longest


def test_a_tiny_rest_is_no_step():
    """0.05 in steps of 0.001 is 50 steps, though 0.05 / 0.001 is 50.00000000000001 at times."""
    for k in range(1, 1000):
        assert even_step(k * 1e-3, 1e-3) == k * 1e-3 / k
    assert Fraction(0.3) / Fraction(0.1) < 3  # the example of the note above
    assert even_step(0.3, 0.1) == 0.3 / 3


@pytest.mark.parametrize("longest", [0.0, float("nan"), 1e-320, 1e-18])
def test_a_step_that_gets_nowhere(longest):
    """No division by zero and no overflow where a run has blown up: a RunError."""
    with pytest.raises(RunError, match="too short to get to the next output"):
        even_step(0.05, longest)


@pytest.mark.parametrize(
    ("changes", "steps"),
    [
        # 0.0013 does not divide 0.013 k; each interval takes ten equal steps, the last, 0.011, nine
        (["time.step=0.0013001", "output.every=0.013", "time.end=0.05"], 3 * 10 + 9),
        (["time.step=0.02", "output.every=0.013", "time.end=0.05"], 4),  # longer than an interval
        (["time.step=auto", "output.every=0.013", "time.end=0.05"], None),
    ],
)
def test_a_simulation_lands_on_outputs(changes, steps):
    """Times of frames are k times the interval exactly, and the end; the clock of every step grows,
    by the step taken; none is longer than asked for, by more than a millionth."""
    scene = load_scene(SCENES / "two_disks_lattice.yaml", changes)
    simulation = Simulation(scene)
    interval, end = scene.output_interval, scene.time.end
    times, landed = [0.0], [0.0]
    while not simulation.is_done:
        dt, before = simulation.dt, simulation.time
        if simulation.step():
            landed.append(simulation.time)
        times.append(simulation.time)
        assert simulation.time - before == pytest.approx(dt, rel=1e-9)
        if scene.time.step != "auto":
            assert dt <= scene.time.step * (1 + 1.01e-6)
    assert landed == [*(k * interval for k in range(len(landed) - 1)), end]
    assert (np.diff(times) > 0).all()
    if steps is not None:
        assert simulation.step_count == steps
