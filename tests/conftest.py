"""One compile cache for the whole run, and one place that starts Taichi."""

import os
import random
import tempfile
from pathlib import Path

import numpy as np
import pytest

CACHE = Path(tempfile.gettempdir()) / f"mpm_taichi_test_cache_{os.getuid()}"
os.environ.setdefault("TI_OFFLINE_CACHE_FILE_PATH", str(CACHE))
os.environ.setdefault("TI_SKIP_VERSION_CHECK", "ON")
os.environ.setdefault("ENABLE_TAICHI_HEADER_PRINT", "0")


@pytest.fixture
def rng():
    """Random numbers of a seed drawn now; a failure prints it."""
    seed = int(os.environ.get("MPM_TAICHI_SEED", random.SystemRandom().randrange(2**31)))
    print(f"seed {seed}: repeat with MPM_TAICHI_SEED={seed}")
    return np.random.default_rng(seed)


@pytest.fixture
def exact():
    """Taichi in f64 with fast-math off: what is compared with the twin to round-off."""
    from mpm_taichi import runtime

    runtime.start("cpu", "f64", threads=2, fast_math=False)


@pytest.fixture
def fast():
    """Taichi as users run it: f64, fast-math on."""
    from mpm_taichi import runtime

    runtime.start("cpu", "f64", threads=2)
