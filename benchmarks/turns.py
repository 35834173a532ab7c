"""Runs of `stepping.py` side by side: compiled two at a time, then one at a time in turns."""

import json
import os
import statistics
import subprocess
import sys
from pathlib import Path

from experiments import EXPERIMENTS, Scheme

ONE_THREAD = {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1", "MKL_NUM_THREADS": "1"}
"""NumPy's threads go on spinning after it has recorded an error, on the clock of the steps."""

TOGETHER = 10  # processes that wait beside the one that steps


class Child:
    """A run of `stepping.py`, and the row that it becomes."""

    def __init__(self, name: str, scheme: Scheme, level: int, rounds: int, cache: str):
        experiment = EXPERIMENTS[name]
        self.row = {
            "experiment": name, "scheme": str(scheme), "basis": scheme.basis,
            "transfer": scheme.transfer, "stress_update": scheme.order,
            "precision": scheme.precision, "method": scheme.method, "level": level, "errors": {},
            "failure": None, "expected": experiment.expected(scheme),
        }  # fmt: skip
        self.turns, self.found = [], {}
        self.process = subprocess.Popen(
            [sys.executable, str(Path(__file__).with_name("stepping.py"))],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
            env=os.environ | ONE_THREAD | {"TI_OFFLINE_CACHE_FILE_PATH": cache},
        )  # fmt: skip
        assert self.process.stdin and self.process.stdout
        self.stdin, self.stdout = self.process.stdin, self.process.stdout
        method = f"method={json.dumps(scheme.method)}"
        self._tell(
            json.dumps({
                "scene": experiment.scene, "changes": [*experiment.changes, method],
                "level": level, "precision": scheme.precision, "rounds": rounds,
            })
        )  # fmt: skip

    def _tell(self, line):
        self.stdin.write(line + "\n")
        self.stdin.flush()

    def hear(self):
        """What it answers; the first time, when it is ready."""
        line = self.stdout.readline()
        if not line:
            place = f"{self.row['experiment']}, {self.row['scheme']}, level {self.row['level']}"
            sys.exit(f"{place}: its process ended with exit code {self.process.wait()}, see above")
        self.row |= json.loads(line)

    def turn(self):
        if self.row["failure"] is None:
            self._tell("")
            self.hear()
            if self.row["failure"] is None:
                self.turns.append((self.row.pop("cpu"), self.row.pop("wall")))

    def end(self) -> dict:
        self.stdin.close()
        self.process.wait()
        done = self.row["failure"] is None
        self.found = self.row["errors"]
        self.row |= {"turns": len(self.turns), "coverage": coverage(len(self.turns))}
        for place, clock in enumerate(("cpu", "wall")):
            times = sorted(self.row["steps"] * turn[place] for turn in self.turns)
            self.row[f"{clock}_seconds"] = statistics.median(times) if done else None
            self.row[f"{clock}_interval"] = interval(times) if done else None
        return self.row


def interval(times: list[float]) -> list[float]:
    """Order statistics around the median, see above; `times` in order."""
    return [times[1], times[-2]] if len(times) > 5 else [times[0], times[-1]]


def coverage(n: int) -> float | None:
    """Of `interval` for the median, whatever the distribution."""
    outside = 1 + n if n > 5 else 1
    return 1 - outside * 0.5 ** (n - 1) if n else None


def measure(name: str, level: int, schemes, rounds: int, cache: str) -> list[Child]:
    """All schemes on one experiment at one resolution, in turns."""
    finished = []
    for start in range(0, len(schemes), TOGETHER):
        children = []
        for pair in range(start, min(start + TOGETHER, len(schemes)), 2):
            two = schemes[pair : min(pair + 2, start + TOGETHER)]
            new = [Child(name, scheme, level, rounds, cache) for scheme in two]
            for child in new:
                child.hear()
            children += new
        for _ in range(rounds):
            for child in children:
                child.turn()
        for child in children:
            child.end()
        finished += children
    return finished
