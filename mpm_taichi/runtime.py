"""The one call of `ti.init`, its precision, and two annotations of kernel arguments."""

import contextlib
import io
import os
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import taichi as ti
from taichi.lang import impl
from taichi.lang.util import to_numpy_type

from . import taichi_memory
from .errors import InputError

taichi_memory.install()

if TYPE_CHECKING:
    Template = Any
    Array = Any
else:
    Template = ti.template()  # fixed when the kernel is compiled
    Array = ti.types.ndarray()  # a NumPy array, which a kernel on a CPU reads and writes in place


def default_precision(device: str) -> str:
    """f64 where it costs little (1.1 to 1.3 times f32 on a CPU), f32 on Vulkan and Metal."""
    return "f64" if device in ("cpu", "cuda") else "f32"


def widest_float():
    """For sums, once Taichi has started: f64 where every device of the kind has it, on Vulkan and
    Metal the precision of the run."""
    chosen = impl.current_cfg()
    return chosen.default_fp if chosen.arch in (ti.vulkan, ti.metal) else ti.f64


def has_wide_functions() -> bool:
    """Whether exponential, logarithm and angles are there in f64, once Taichi has started."""
    return impl.current_cfg().arch not in (ti.vulkan, ti.metal)


def real_type() -> np.dtype:
    """Of `float` in a kernel, since `start`."""
    return np.dtype(to_numpy_type(impl.get_runtime().default_fp))


MANY = 32_768
"""Particles from which Taichi's own control-flow optimization pays on a CPU.  LLVM does the same
work behind it, but for laws that iterate, whose stress takes 5 to 15 % longer without; with it a
scene takes 1 to 5 s longer to compile: it looks for the stores behind each load of a kernel."""

LEFT_BEHIND = 60
"""Seconds after which a lock of the cache is nobody's."""

ends = 0
"""How often all fields have gone, since the program began."""


def stop() -> None:
    """All fields are gone, and their memory is free."""
    global ends
    ends += 1
    ti.reset()


def _unlock_cache():
    """Taichi's cache of kernels is locked while it is written or read, for less than a second; a
    process killed then leaves a lock with which no other would find a kernel again."""
    usual = str(impl.default_cfg().offline_cache_file_path)
    lock = Path(os.environ.get("TI_OFFLINE_CACHE_FILE_PATH", usual), "ticache.lock")
    with contextlib.suppress(OSError):
        if time.time() - lock.stat().st_mtime > LEFT_BEHIND:
            lock.unlink()


def start(
    device: str = "cpu", precision: str = "f64", threads: int = 1, particles: int = 0, **options
) -> None:
    """Start Taichi afresh (all fields of before are gone); `float` in a kernel means `precision`.
    For the stages of at least MANY `particles` compiling takes its time.

    There is no silent fall-back: a device that is not there is an InputError."""
    forced = os.environ.get("TI_ARCH")
    if forced and getattr(ti, forced, None) != getattr(ti, device):
        raise InputError(
            f"the environment has TI_ARCH={forced}, which overrides --device {device}: unset it"
        )
    if device == "metal" and precision == "f64":
        raise InputError("--device metal has no 64-bit floats: take --precision f32")
    stop()
    _unlock_cache()
    if device == "vulkan" or not os.environ.get("DISPLAY"):
        os.environ.setdefault("EGL_PLATFORM", "surfaceless")
    try:
        with contextlib.redirect_stdout(io.StringIO()):  # Taichi prints "Starting on arch=..."
            ti.init(
                arch=getattr(ti, device),
                default_fp=getattr(ti, precision),
                cpu_max_num_threads=threads,
                enable_fallback=False,
                log_level=ti.ERROR,
                cfg_optimization=device != "cpu" or particles >= MANY,
                **options,
            )
    except RuntimeError as error:
        raise InputError(
            f"--device {device} does not work on this computer ({str(error).splitlines()[-1]}); "
            "--device cpu works everywhere"
        ) from None
