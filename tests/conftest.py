"""One compile cache for the whole run, and one place that starts Taichi."""

import os
import random
import tempfile
from pathlib import Path

import numpy as np
import pytest

CACHE = Path(tempfile.gettempdir()) / f"mpm_taichi_test_cache_{os.getuid()}"
os.environ.setdefault("TI_OFFLINE_CACHE_FILE_PATH", str(CACHE))
os.environ.setdefault("TI_OFFLINE_CACHE_MAX_SIZE_OF_FILES", str(2**30))  # the suite fills 120 MB
os.environ.setdefault("TI_SKIP_VERSION_CHECK", "ON")
os.environ.setdefault("ENABLE_TAICHI_HEADER_PRINT", "0")


def _shared(item) -> list[str]:
    """The fixtures of its module that an item shares with others."""
    fixtures = item._fixtureinfo.name2fixturedefs.values()
    here = [one[-1] for one in fixtures if one[-1].func.__module__ == item.module.__name__]
    return [one.argname for one in here if one.scope == "module"]


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(config, items):
    """For xdist with `--dist loadgroup`: tests that share a fixture of their module go to one
    worker, so that it is set up once; and long tests come first, lest the last one keeps a worker
    busy while the others wait."""
    if not getattr(config.option, "loadgroup", False):
        return
    for item in items:
        if item.get_closest_marker("xdist_group") is None and _shared(item):
            item.add_marker(pytest.mark.xdist_group(item.module.__name__))
    items.sort(key=lambda item: item.get_closest_marker("slow") is None)


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
