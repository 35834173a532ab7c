"""The command line as a user calls it, and what it leaves behind."""

import csv
import os
import subprocess
import sys
from pathlib import Path

import numpy as np

ROOT = Path(__file__).parents[1]
SCENES = ROOT / "scenes"
QUIETED = ("TI_SKIP_VERSION_CHECK", "ENABLE_TAICHI_HEADER_PRINT")
"""What conftest.py sets for the tests and the program has to see to by itself."""


def environment(**changes: str) -> dict[str, str]:
    kept = {name: value for name, value in os.environ.items() if name not in QUIETED}
    return kept | {"PYTHONPATH": str(ROOT)} | changes


def mpm_taichi(*arguments, cwd=None, **changes: str) -> subprocess.CompletedProcess:
    """`python -m mpm_taichi ARGUMENTS` to its end; `changes` of the environment."""
    command = [sys.executable, "-m", "mpm_taichi", *map(str, arguments)]
    return subprocess.run(
        command, cwd=cwd, env=environment(**changes), capture_output=True, text=True, timeout=600
    )


def in_words(text: str) -> bool:
    return bool(text.strip()) and "Traceback" not in text


def history(folder: Path) -> dict[str, np.ndarray]:
    """The columns of history.csv."""
    with (folder / "history.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    return {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}


def centers(table: dict[str, np.ndarray], body: str) -> np.ndarray:
    """Center of mass of a body in each row [rows, dim]."""
    return np.stack([table[f"{body}_center_{axis}"] for axis in "xyz"
                     if f"{body}_center_{axis}" in table], axis=1)  # fmt: skip
