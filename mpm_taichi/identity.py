"""What has to be the same for a run to go on where another process left it."""

import hashlib
from typing import Any

import numpy as np

from . import __version__
from .report import installed
from .scene import dump_scene


def identity(simulation) -> dict[str, Any]:
    """By the words of a message."""
    start = np.ascontiguousarray(simulation.initial_position)
    return {
        "version of mpm_taichi": __version__,
        "version of taichi": installed("taichi"),
        "device": simulation.device,
        "precision": simulation.precision,
        "scene": hashlib.sha256(dump_scene(simulation.scene).encode()).hexdigest(),
        "particles at the start": hashlib.sha256(start.tobytes()).hexdigest(),
    }


def differences(before: dict[str, Any], now: dict[str, Any]) -> list[str]:
    """In words; a digest is no word."""
    found = []
    for name, value in now.items():
        if before.get(name) != value:
            is_digest = len(str(value)) == 64
            found.append(name if is_digest else f"{name} ({before.get(name)}, now {value})")
    return found
