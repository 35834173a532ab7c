"""Samples of the suite of hard cases: one case drawn, and one with Taichi's checks; all of them in
a campaign."""

import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

BENCHMARKS = Path(__file__).parents[2] / "benchmarks"
FILES = sorted((BENCHMARKS / "hard_cases").glob("*.py"))
TEXT = "\n".join(file.read_text() for file in FILES)
NAMES = re.findall(r'CASE = Case\(\s*"(\w+)"', TEXT)
SCHEME = ("--quick", "--scheme", "quadratic mls")
CHECKS = ("--debug", "--no-fast-math")


def run_suite(*words: str, timeout: float | None = 1200):
    """Output and exit code of the suite in a process of its own."""
    return subprocess.run(
        [sys.executable, BENCHMARKS / "stability.py", *words],
        capture_output=True, text=True, timeout=timeout, check=False,
    )  # fmt: skip


@pytest.mark.slow
def test_a_case_of_the_suite(rng):
    """Any case has the status that it predicts, with the scheme that is the default of scenes."""
    case, seed = rng.choice(NAMES), rng.integers(2**31)
    done = run_suite(case, *SCHEME, "--seed", str(seed))
    print(done.stdout)
    assert done.returncode == 0, done.stderr


@pytest.mark.slow
def test_a_case_with_checks():
    """No access outside the bounds of a field, and the same status as with fast-math."""
    done = run_suite("H20", *SCHEME, *CHECKS)
    assert done.returncode == 0, done.stderr


@pytest.mark.slow
@pytest.mark.campaign
@pytest.mark.parametrize("check", CHECKS)
@pytest.mark.parametrize("case", NAMES)
def test_all_cases_with_checks(case, check):
    """As above, each case."""
    done = run_suite(case, *SCHEME, check, timeout=None)
    print(done.stdout)
    assert done.returncode == 0, done.stderr


WRITES_OUTSIDE = """
import taichi as ti
from mpm_taichi import runtime

runtime.start()
field = ti.field(float, 4)

@ti.kernel
def write(i: int):
    field[i] = 1.0

write(4)
"""


def test_the_check_of_bounds_checks(tmp_path):
    """What --debug sets ends a program that writes behind a field, by name of the kernel."""
    script = tmp_path / "outside.py"
    script.write_text(WRITES_OUTSIDE)
    done = subprocess.run(
        [sys.executable, script], env=os.environ | {"TI_DEBUG": "1"},
        capture_output=True, text=True, timeout=300, check=False,
    )  # fmt: skip
    assert done.returncode == 1
    assert "of size (4) with indices (4)" in done.stderr


def test_trend(monkeypatch, rng):
    """A slope is found and told from noise of a fifth of it; noise alone passes for a slope once in
    500 times, in 5 of 100 with a probability of 2e-6; what does not move has none."""
    monkeypatch.syspath_prepend(str(BENCHMARKS))
    from hard_cases.trend import CHANCE, trend  # pyright: ignore[reportMissingImports]

    line = np.linspace(0, 1, 200)
    assert trend(line)[0] == pytest.approx(1, rel=1e-2)
    assert abs(trend(np.full(200, 0.1))[1]) < 1
    noise = rng.normal(size=(100, 200))
    assert np.sum([abs(trend(each)[1]) > CHANCE for each in noise]) < 5
    assert trend(noise[0] + 5 * line)[1] > CHANCE
