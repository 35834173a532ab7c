"""CPU and wall time of a call."""

import time
from typing import Any, NamedTuple

PAUSE = 1e-3  # [s]


class Spent(NamedTuple):
    """CPU time of all threads and wall time [s] of a call, and what it returned."""

    cpu: float
    wall: float
    result: Any


def spent(function) -> Spent:
    """Of a thread on another core Linux knows the CPU time only as of its last tick, up to 4 ms
    ago, until that thread goes to rest.  So the CPU time is read after a pause, which is on neither
    clock: without, the least of many calls is too little by as much.  What comes after a pause
    starts cold, which some 0.05 ms of a call tell."""
    cpu, wall = time.process_time(), time.perf_counter()
    result = function()
    wall = time.perf_counter() - wall
    time.sleep(PAUSE)
    return Spent(time.process_time() - cpu, wall, result)
