"""The benchmark times the same method in both forms, and prints what it says."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

BENCHMARKS = Path(__file__).parents[2] / "benchmarks"


@pytest.mark.parametrize("dim", [2, 3])
def test_textbook_form_is_the_same_method(fast, monkeypatch, dim):
    """Ten steps from the same start, f64: positions and velocities equal to 1e-11 of the largest
    (other order of additions, ln J by another formula)."""
    monkeypatch.syspath_prepend(str(BENCHMARKS))
    from textbook import Textbook  # pyright: ignore[reportMissingImports]
    from throughput import block  # pyright: ignore[reportMissingImports]

    from mpm_taichi.bases import QuadraticBSpline
    from mpm_taichi.materials import NeoHookean
    from mpm_taichi.particles import BodyPoints
    from mpm_taichi.solver import Solver
    from mpm_taichi.transfers import MLS

    x, v, V0, cells = block(dim, 500, "textbook random")
    jelly = NeoHookean(type="neo_hookean", density=1000, youngs_modulus=1e5, poissons_ratio=0.3)
    dt = 0.1 / cells / jelly.wave_speed()
    textbook = Textbook(x, v, V0, cells, jelly, dt)
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
        ours.step(0.0, dt, lambda speed: dt)
    rows = ours.particles.to_numpy("rows")
    moved = {
        "x": (ours.particles.to_numpy("x"), textbook.x.to_numpy()),
        "v": (rows[:, 0, :dim] / rows[:, 0, dim : dim + 1], textbook.v.to_numpy()),
    }
    for name, (a, b) in moved.items():
        assert np.abs(a - b).max() < 1e-11 * np.abs(b).max(), name
    assert np.abs(moved["v"][1] - v).max() > 1e-3 * np.abs(v).max()


@pytest.mark.slow
def test_throughput_prints_a_table_and_json(tmp_path):
    """A small run: a row for each form, all numbers positive, and the same in the JSON."""
    path = tmp_path / "numbers.json"
    command = [sys.executable, str(BENCHMARKS / "throughput.py"), "--quick", "--particles", "4000"]
    result = subprocess.run([*command, "--json", str(path)], capture_output=True, text=True)
    assert result.returncode == 0, result.stderr
    forms = json.loads(path.read_text())["results"]["3D f32"]
    assert set(forms) == {"quadratic mls", "textbook sorted", "textbook random"}
    for name, form in forms.items():
        assert f"3D f32 {name}" in result.stdout
        assert all(ns > 0 for ns in form["stages"].values())
        assert f"{form['total']:.1f}" in result.stdout
