"""Processes of `timed.py` that run in turns, so that what disturbs one disturbs all."""

import json
import os
import subprocess
import sys
import time
from pathlib import Path

QUIET = {
    "OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1", "MKL_NUM_THREADS": "1",
    "ENABLE_TAICHI_HEADER_PRINT": "0",
}  # fmt: skip
"""No threads of NumPy on the clock, no banner on stdout."""


class Child:
    """A process and what it has answered: `about` when it was ready, then `turns`."""

    def __init__(self, **spec):
        self.spec, self.turns = spec, []
        told = json.dumps(spec | {"began": time.time()})
        self.process = subprocess.Popen(
            [sys.executable, str(Path(__file__).with_name("timed.py")), told],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, env=os.environ | QUIET,
        )  # fmt: skip
        assert self.process.stdin and self.process.stdout
        self.stdin, self.stdout = self.process.stdin, self.process.stdout
        self.about = self._hear()

    def _hear(self):
        line = self.stdout.readline()
        if not line:
            sys.exit(f"{self.spec}: ended with exit code {self.process.wait()}, see above")
        return json.loads(line)

    def turn(self):
        self.stdin.write("\n")
        self.stdin.flush()
        self.turns.append(self._hear())

    def end(self):
        self.stdin.close()
        self.process.wait()


def in_turns(specs, rounds) -> list[Child]:
    """One process for each of `specs`, started one after the other; then `rounds` turns of all."""
    children = [Child(**spec) for spec in specs]
    for _ in range(rounds):
        for child in children:
            child.turn()
    for child in children:
        child.end()
    return children
