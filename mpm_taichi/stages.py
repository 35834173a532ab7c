"""Wall time by stage of the step."""

import functools
import time
from collections import defaultdict

first_calls: dict[str, float] = defaultdict(float)
"""Seconds of the first call of each stage, in which its kernels are compiled or loaded."""

seconds: dict[str, float] = defaultdict(float)
"""Seconds of all later calls."""


def stage(function):
    """Add up the time of a stage under its name.  Kernels return when they are done on a CPU; on a
    GPU this is the time of the launch."""

    @functools.wraps(function)
    def timed(*arguments, **options):
        start = time.perf_counter()
        function(*arguments, **options)
        elapsed = time.perf_counter() - start
        name = function.__name__
        if name in first_calls:
            seconds[name] += elapsed
        else:
            first_calls[name] = elapsed

    return timed


def reset() -> None:
    first_calls.clear()
    seconds.clear()
