"""How many threads a run is worth."""

import os

from .errors import InputError

PARTICLES_PER_THREAD = 2048
"""Below this a second thread costs more in hand-offs than it saves."""

MOST_THREADS = 1024


def threads(asked: int | None, device: str, particles: int) -> int:
    """As asked; else as many as the size of the scene is worth.  InputError for what cannot be."""
    if device != "cpu":
        if asked:
            raise InputError(f"--threads: is for --device cpu ({device} has its own)")
        return 1
    if asked and asked > MOST_THREADS:
        raise InputError(f"--threads: at most {MOST_THREADS} (got {asked})")
    return asked or max(1, min(_cores(), particles // PARTICLES_PER_THREAD))


def _cores():
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
