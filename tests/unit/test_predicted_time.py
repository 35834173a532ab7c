"""The time that `check` tells: from real steps, in words, within its patience."""

from types import SimpleNamespace

import pytest

from mpm_taichi import Simulation, load_scene, predicted_time, run
from mpm_taichi.errors import MotionError
from mpm_taichi.predicted_time import Enough, Prediction, Stopwatch, duration, predict
from tests.command_line import SCENES

LATTICE = SCENES / "two_disks_lattice.yaml"


class Clock:
    """Stands still but for what the test lets pass."""

    def __init__(self):
        self.now = 0.0

    def perf_counter(self) -> float:
        return self.now


def test_the_stopwatch_leaves_out_the_first_step(monkeypatch):
    """A step of 100 s, which compiles, then blocks of ten steps of 2 ms each and an output: paces
    are seconds per step, outputs are told apart, and after 0.1 s it is enough.  Steps that take
    over a hundredth of the patience are watched one by one."""
    clock, watch = Clock(), Stopwatch(patience=0.1)
    monkeypatch.setattr(predicted_time, "time", clock)

    def after(seconds, step, is_output=False):
        clock.now += seconds
        watch.record(SimpleNamespace(step_count=step), is_output)

    after(50, 0, is_output=True)
    after(100, 1)
    assert watch.paces == []
    after(0.02, 11)
    assert watch.every_steps == 1
    after(0.0002, 12)
    assert watch.every_steps is None
    after(0.06, 22, is_output=True)
    with pytest.raises(Enough):
        after(0.04, 32)
    assert watch.paces == pytest.approx([0.002, 0.0002, 0.006, 0.004])
    assert watch.outputs == [False, False, True, False]


def test_a_prediction_adds_up(tmp_path, monkeypatch):
    """500 steps of 1 ms and 5 outputs: the run is its steps and outputs (and that of the start),
    between its ends; it stops early where patience is short, and leaves no file here."""
    monkeypatch.chdir(tmp_path)
    words = ["time.end=0.5", "output.every=0.1", "output.images.size=100"]
    simulation = Simulation(load_scene(LATTICE, words))
    found = predict(simulation, patience=0.0)
    assert found is not None
    assert 1 < simulation.step_count < 100
    for step, whole in zip(found.step, found.run, strict=True):
        assert whole == pytest.approx(500 * step + 6 * found.output)
    assert 0 < found.run[1] <= found.run[0] <= found.run[2]
    assert list(tmp_path.iterdir()) == []


def test_a_run_that_is_over_at_once():
    """One step: nothing to tell."""
    words = ["time.end=0.001", "output.every=0.001", "output.images=none"]
    assert predict(Simulation(load_scene(LATTICE, words))) is None


def test_the_time_in_words(monkeypatch):
    """A line with what it rests on; a run that fails at once is told, and no crash."""
    found = Prediction(step=(0.002, 0.001, 0.004), output=0.05, run=(190.0, 100.0, 390.0))
    monkeypatch.setattr(run, "predict", lambda simulation: found)
    assert run.told_time(None) == (
        "time: about 3.2 min on this computer now, 1.7 min to 6.5 min by the spread of the steps "
        "(2 ms a step, 50 ms an output), if steps stay as they are"
    )

    def fails(simulation):
        raise MotionError("t = 0 s: no")

    monkeypatch.setattr(run, "predict", fails)
    assert run.told_time(None) == "warning: the run fails in its first steps: t = 0 s: no"


@pytest.mark.parametrize(
    "seconds, text",
    [(0.0421, "0.042 s"), (25.4, "25 s"), (99, "99 s"), (200, "3.3 min"), (7560, "2.1 h"),
     (180000, "3 days")],
)  # fmt: skip
def test_durations(seconds, text):
    """Two digits, in the unit that people would take."""
    assert duration(seconds) == text
