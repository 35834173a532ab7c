"""Benchmarks time the same method in both forms, put speed beside error, print what they say."""

import json
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

BENCHMARKS = Path(__file__).parents[2] / "benchmarks"


@pytest.mark.parametrize("dim", [2, pytest.param(3, marks=pytest.mark.campaign)])
def test_other_forms_are_the_same_method(fast, monkeypatch, dim):
    """Ten steps from the same start, f64, of the textbook form, of Taichi's own example and of
    ours: positions and velocities equal to 1e-11 of the largest (other order of additions, ln J by
    another formula)."""
    monkeypatch.syspath_prepend(str(BENCHMARKS))
    from taichi_example import TaichiExample  # pyright: ignore[reportMissingImports]
    from textbook import Textbook  # pyright: ignore[reportMissingImports]
    from workload import block  # pyright: ignore[reportMissingImports]

    from mpm_taichi.bases import QuadraticBSpline
    from mpm_taichi.materials import NeoHookean
    from mpm_taichi.particles import BodyPoints
    from mpm_taichi.solver import Solver
    from mpm_taichi.transfers import MLS

    x, v, V0, cells = block(dim, 500, "textbook random")
    jelly = NeoHookean(type="neo_hookean", density=1000, youngs_modulus=1e5, poissons_ratio=0.3)
    dt = 0.1 / cells / jelly.wave_speed()
    textbook = Textbook(x, v, V0, cells, jelly, dt)
    example = TaichiExample(x, v, cells, jelly, dt)
    ours = Solver(
        [BodyPoints(jelly, x, v, V0)], (cells,) * dim, 1 / cells, QuadraticBSpline, MLS, (),
        [0.0] * dim,
    )  # fmt: skip
    ours.start(dt)
    for _ in range(10):
        textbook.clear()
        textbook.p2g()
        textbook.grid_update()
        textbook.g2p()
        example.substep()
        ours.step(0.0, dt, dt)
    rows = ours.particles.to_numpy("rows")
    moved = {
        "x": (ours.particles.to_numpy("x"), textbook.x, example.x),
        "v": (rows[:, 0, :dim] / rows[:, 0, dim : dim + 1], textbook.v, example.v),
    }
    for name, (a, *others) in moved.items():
        for b in (field.to_numpy() for field in others):
            assert np.abs(a - b).max() < 1e-11 * np.abs(b).max(), name
    assert np.abs(moved["v"][0] - v).max() > 1e-3 * np.abs(v).max()


@pytest.mark.slow
def test_throughput_prints_a_table_and_json(tmp_path):
    """A small run: a row for each form, all numbers positive, and the same in the JSON."""
    path = tmp_path / "numbers.json"
    command = [sys.executable, str(BENCHMARKS / "throughput.py"), "--quick", "--dim", "2"]
    command += ["--particles", "4000"]
    result = subprocess.run([*command, "--json", str(path)], capture_output=True, text=True)
    assert result.returncode == 0, result.stderr
    forms = json.loads(path.read_text())["results"]["2D f32"]
    assert set(forms) == {"quadratic mls", "textbook sorted", "textbook random", "mpm3d sorted"}
    for name, form in forms.items():
        assert f"2D f32 {name}" in result.stdout
        assert all(ns > 0 for ns in form["stages"].values())
        assert f"{form['total']:.1f}" in result.stdout
        assert 0 < form["shares"]["memory"] < 1
        assert form["first_step_seconds"] > 0


@pytest.fixture
def speed(monkeypatch):
    """Modules of `speed_vs_error.py`."""
    monkeypatch.syspath_prepend(str(BENCHMARKS))
    import experiments  # pyright: ignore[reportMissingImports]
    import speed_vs_error  # pyright: ignore[reportMissingImports]
    import turns  # pyright: ignore[reportMissingImports]
    import verdicts  # pyright: ignore[reportMissingImports]

    return SimpleNamespace(
        experiments=experiments, main=speed_vs_error, turns=turns, verdicts=verdicts
    )


def measured(scheme, level, error, seconds, experiment="free_bar", scale=2.0):
    """What `judge` takes: a run that is done, or one that failed where its error is None."""
    found = {} if error is None else {"displacement": {"error": error, "scale": scale}}
    row = {
        "experiment": experiment, "scheme": scheme, "precision": "f64", "level": level,
        "cpu_seconds": seconds, "failure": "blew up" if error is None else None,
    }  # fmt: skip
    return SimpleNamespace(row=row, found=found)


def test_every_scheme_that_works_is_known(speed):
    """All pairs that work, with each transfer of a table, and no others: those whose transfers
    have the force along grad w in three stress orders, both precisions; defaults are among them."""
    from mpm_taichi.transfers import FLIP, XPIC
    from tests.cases import PAIRS

    words = {FLIP: 1, XPIC: 2}  # flip, xpic 2 and xpic 5
    count = sum(words.get(t, 1) * (3 if t.gradient else 1) * 2 for _, t in PAIRS)
    assert len(set(speed.experiments.EVERY)) == len(speed.experiments.EVERY) == count
    for experiment in speed.experiments.EXPERIMENTS.values():
        for schemes in experiment.levels:
            assert set(schemes) <= set(speed.experiments.EVERY)


def test_moving_stands_beside_rest(speed):
    """The two bars take the same schemes, resolutions, times and grid, so that motion is all that
    differs; errors are relative to the vibration."""
    from mpm_taichi import load_scene

    rest, riding = (speed.experiments.EXPERIMENTS[n] for n in ("free_bar", "free_bar_riding"))
    assert rest.levels == riding.levels
    scenes = [
        load_scene(speed.main.SCENES / f"{e.scene}.yaml", e.changes).model_dump()
        for e in (rest, riding)
    ]
    for scene in scenes:
        assert (scene.pop("title"), scene["definitions"].pop("V")) is not None
        scene.pop("source")
    assert scenes[0] == scenes[1]
    assert riding.scale == "free_bar"


def test_interval_and_its_coverage(speed):
    """Ten values: 2nd to 9th, which hold the median with 1 - 11 / 512 = 97.85 %; four: all, with
    1 - 2 / 16."""
    assert speed.turns.interval([float(k) for k in range(10)]) == [1.0, 8.0]
    assert speed.turns.coverage(10) == pytest.approx(1 - 11 / 512, abs=1e-15)
    assert speed.turns.interval([1.0, 2.0, 3.0, 4.0]) == [1.0, 4.0]
    assert speed.turns.coverage(4) == pytest.approx(1 - 2 / 16, abs=1e-15)


def test_coverage_by_chance(speed, rng):
    """Of 20,000 samples of 10, as often as it says, to 4 standard deviations."""
    sample = np.sort(rng.exponential(size=(20_000, 10)), axis=1)
    low, high = np.apply_along_axis(speed.turns.interval, 1, sample).T
    share = ((low < np.log(2)) & (np.log(2) < high)).mean()
    p = speed.turns.coverage(10)
    assert abs(share - p) < 4 * (p * (1 - p) / 20_000) ** 0.5


def test_pareto_front(speed):
    """(time, error): (1, 0.4) and (2, 0.1) are on the front, (3, 0.2) is not, nor is a failure;
    fronts of other experiments do not matter."""
    rows = speed.verdicts.judge([
        measured("a", 0, 0.4, 1.0), measured("b", 0, 0.2, 3.0), measured("c", 0, 0.1, 2.0),
        measured("d", 0, None, None), measured("e", 0, 0.01, 0.1, "manufactured_2d"),
    ])  # fmt: skip
    assert [row["pareto"] for row in rows] == [
        ["displacement"], [], ["displacement"], [], ["displacement"],
    ]  # fmt: skip


def test_errors_of_a_riding_bar_are_relative_to_the_vibration(speed):
    """Not to its way, which is 100 times as long; without a bar at rest, to what there is."""
    rest = measured("a", 0, 0.5, 1.0, "free_bar", 2.0)
    riding = measured("a", 0, 0.5, 1.0, "free_bar_riding", 200.0)
    assert [row["errors"]["displacement"] for row in speed.verdicts.judge([rest, riding])] == [
        0.25, 0.25,
    ]  # fmt: skip
    riding = measured("a", 0, 0.5, 1.0, "free_bar_riding", 200.0)
    assert speed.verdicts.judge([riding])[0]["errors"]["displacement"] == 0.0025


def test_worse_with_smaller_cells(speed):
    """0.4, 0.39, 0.1, failed: the second gains less than 10 %; a failure is told as one."""
    rows = speed.verdicts.judge(
        [measured("a", level, e, 1.0) for level, e in enumerate((0.4, 0.39, 0.1, None))]
    )
    assert [row["worse"] for row in rows] == [False, True, False, False]


def test_arguments(speed):
    """--quick is two schemes at two resolutions on the bars; a scheme by name has both precisions
    unless it names one; --full takes everything."""
    quick = speed.main.plan(speed.main.parse(["--quick"]))
    assert quick.keys() == {"free_bar", "free_bar_riding"}
    for levels in quick.values():
        names = [[scheme.with_precision for scheme in schemes] for schemes in levels]
        assert names == [["linear flip f64", "quadratic mls f64"]] * 2
    asked = ["--scene", "vortex", "--scheme", "cubic mls", "cubic apic f32"]
    for levels in speed.main.plan(speed.main.parse(asked)).values():
        for schemes in levels:
            assert {scheme.with_precision for scheme in schemes} == {
                "cubic mls f64", "cubic mls f32", "cubic apic f32",
            }  # fmt: skip
    full = speed.main.plan(speed.main.parse(["--full"]))
    assert full.keys() == speed.experiments.EXPERIMENTS.keys()
    for name, levels in full.items():
        assert len(levels) == len(speed.experiments.EXPERIMENTS[name].levels) + 1
        assert all(len(schemes) == len(speed.experiments.EVERY) for schemes in levels)


@pytest.mark.slow
def test_speed_vs_error_measures_and_draws(tmp_path):
    """Two schemes on the bar at rest, coarse, three turns: a line each, the same error in
    the JSON, order 2, and a picture.  Failures keep their sentence: hat functions blow up at rest
    with 20 cells, where the ends of the bar swing across a third of a cell."""
    command = [sys.executable, str(BENCHMARKS / "speed_vs_error.py"), "--quick", "--rounds", "3"]
    command += ["--scene", "free_bar"]
    path, pictures = tmp_path / "numbers.json", tmp_path / "pictures"
    result = subprocess.run(
        [*command, "--json", str(path), "--pictures", str(pictures)],
        capture_output=True, text=True, timeout=600,
    )  # fmt: skip
    assert result.returncode == 0, result.stderr
    content = json.loads(path.read_text())
    assert len(content["rows"]) == 4
    coarse, fine = (row for row in content["rows"] if row["scheme"] == "quadratic mls")
    for row in (coarse, fine):
        assert row["cpu_interval"][0] <= row["cpu_seconds"] <= row["cpu_interval"][1]
        assert (row["turns"], row["coverage"]) == (3, 0.75)
        assert row["courant"] == pytest.approx(0.2, rel=1e-4)
        assert f"{100 * row['errors']['displacement']:.3g}" in result.stdout
    assert fine["steps"] == 2 * coarse["steps"] == 1000
    errors = [row["errors"]["displacement"] for row in (coarse, fine)]
    assert 1.8 < np.log2(errors[0] / errors[1]) < 2.2
    assert errors[1] < 0.012
    failed = [row for row in content["rows"] if row["failure"]]
    assert failed
    assert all(row["expected"] and row["cpu_seconds"] is None for row in failed)
    assert all(row["failure"] in result.stdout for row in failed)
    assert [p.name for p in pictures.iterdir()] == ["speed_vs_error_bar.png"]
