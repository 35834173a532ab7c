"""How much memory is free: on the host, within the limits of its control groups, on a GPU."""

import ctypes
import sys
from pathlib import Path

GROUPS = {  # folder, limit, use, and what of that use the kernel gives back: files it has cached
    1: ("sys/fs/cgroup/memory", "memory.limit_in_bytes", "memory.usage_in_bytes",
        "total_inactive_file"),
    2: ("sys/fs/cgroup", "memory.max", "memory.current", "inactive_file"),
}  # fmt: skip


def free_memory(device: str) -> dict[str, int]:
    """Bytes by place: `memory` of the host, and for a GPU `cuda memory`; without the places that
    cannot be asked."""
    found = {"memory": free_on_host()}
    if device == "cuda":
        found["cuda memory"] = free_on_cuda()
    return {place: count for place, count in found.items() if count is not None}


def free_on_host(root: Path = Path("/")) -> int | None:
    """The least of what Linux calls available and what each control group of this process leaves;
    `root` holds proc and sys.  None on other systems."""
    found = list(_left_by_groups(root))
    for line in _lines(root / "proc/meminfo"):
        if line.startswith("MemAvailable:"):
            found.append(1024 * int(line.split()[1]))
    return min(found, default=None)


def _left_by_groups(root):
    """The group of this process and all around it, as far as they can be seen from here: in a
    container the path of a group is often that on its host."""
    for line in _lines(root / "proc/self/cgroup"):
        _, controllers, path = line.split(":", 2)
        if controllers and "memory" not in controllers.split(","):
            continue
        folder, limit, use, cached = GROUPS[1 if controllers else 2]
        top = root / folder
        here = top / path.lstrip("/")
        for group in (here, *here.parents):
            most, used = _number(group / limit), _number(group / use)
            if most is not None and used is not None:
                stat = dict(line.split() for line in _lines(group / "memory.stat"))
                yield max(0, most - used + int(stat.get(cached, 0)))
            if group == top:
                break


def _lines(path):
    try:
        return path.read_text().splitlines()
    except OSError:
        return []


def _number(path):
    """What a file says; None for `max` and where there is no file."""
    text = "".join(_lines(path)).strip()
    return int(text) if text.isdecimal() else None


def free_on_cuda() -> int | None:
    """Of the first device that the driver shows, which is the one that Taichi takes."""
    try:
        cuda = ctypes.CDLL("nvcuda.dll" if sys.platform == "win32" else "libcuda.so.1")
    except OSError:
        return None
    device, context = ctypes.c_int(), ctypes.c_void_p()
    free, total = ctypes.c_size_t(), ctypes.c_size_t()
    if (
        cuda.cuInit(0)
        or cuda.cuDeviceGet(ctypes.byref(device), 0)
        or cuda.cuDevicePrimaryCtxRetain(ctypes.byref(context), device)
    ):
        return None
    failed = cuda.cuCtxPushCurrent_v2(context) or cuda.cuMemGetInfo_v2(
        ctypes.byref(free), ctypes.byref(total)
    )
    cuda.cuCtxPopCurrent_v2(ctypes.byref(context))
    cuda.cuDevicePrimaryCtxRelease_v2(device)
    return None if failed else free.value
