"""CPU time of the threads of this process, and the clock of the processor."""

import os
import platform
import time
from pathlib import Path

import numpy as np
import taichi as ti

from mpm_taichi.runtime import Array

LINKS = 5_000_000
CYCLES = 4
"""Of a link of the chain: a product of integers takes 3 on every x86-64 since 2008, the exclusive
or one more, and each waits for the one before."""


def of_workers() -> dict[str, float]:
    """CPU seconds of each thread but the main one, where Linux counts them; empty elsewhere."""
    used = {}
    for task in Path("/proc/self/task").glob("*"):
        if task.name != str(os.getpid()) and (task / "schedstat").exists():
            used[task.name] = int((task / "schedstat").read_text().split()[0]) / 1e9
    return used


@ti.kernel
def chain(start: int, factor: int, mix: int, links: int, end: Array):
    ti.loop_config(serialize=True)
    for _once in range(1):
        x = start
        for _link in range(links):
            x = (x * factor) ^ mix
        end[0] = x


def clock_ghz() -> float | None:
    """The clock of the processor now, from a chain of instructions of known latency; Taichi runs.
    None on processors that are not x86-64."""
    if platform.machine() not in ("x86_64", "AMD64"):
        return None
    end = np.zeros(1, dtype=np.int32)
    chain(1, 3, 5, 1, end)
    best = np.inf
    for _ in range(3):
        before = time.process_time()
        chain(1, 1664525, 1013904223, LINKS, end)
        best = min(best, time.process_time() - before)
    return CYCLES * LINKS / best / 1e9
