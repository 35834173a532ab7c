"""What works on this computer, each thing with the command that brings it."""

import json
import os
import platform
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any, NamedTuple

from .free_memory import free_on_host
from .memory import size
from .report import installed, versions

TIMEOUT = 60.0
"""Seconds that a probe may take; one takes about two."""

BACKENDS = ("cpu", "cuda", "vulkan", "metal")


class Package(NamedTuple):
    name: str
    purpose: str
    requirement: str
    is_optional: bool = False


PACKAGES = (
    Package("taichi", "the kernels", "taichi==1.7.4"),
    Package("numpy", "arrays", "numpy>=1.26"),
    Package("pydantic", "scene models", "pydantic>=2.7"),
    Package("ruamel.yaml", "scene files", "ruamel.yaml>=0.18"),
    Package("rich", "progress", "rich>=13"),
    Package("Pillow", "text on pictures", "Pillow>=10.1"),
    Package("meshio", "mesh files of yours", "meshio>=5.3.5"),
    Package("gmsh", "meshes of shapes", "gmsh>=4.12"),
    Package("matplotlib", "plot, compare, converge, curve", "matplotlib>=3.8", True),
    Package("imageio-ffmpeg", "export --mp4", "imageio-ffmpeg>=0.5", True),
    Package("vtk", "tests of files for ParaView", "vtk>=9.3", True),
    Package("playwright", "clicking tests of the player", "playwright>=1.40", True),
    Package("pytest", "the tests", "pytest>=8,<9.2", True),
)
"""As pyproject.toml has them."""

LIBRARIES = {
    "Taichi": {"libX11.so.6": "libx11-6"},
    "gmsh": {
        "libGLU.so.1": "libglu1-mesa", "libGL.so.1": "libgl1", "libXrender.so.1": "libxrender1",
        "libXcursor.so.1": "libxcursor1", "libXfixes.so.3": "libxfixes3",
        "libXft.so.2": "libxft2", "libXinerama.so.1": "libxinerama1",
        "libgomp.so.1": "libgomp1", "libfontconfig.so.1": "libfontconfig1",
    },
    "Vulkan and the window": {"libvulkan.so.1": "libvulkan1"},
}  # fmt: skip
"""What needs them: library -> package of Debian and Ubuntu."""

PROGRAMS = {
    "a window without a display": {"xvfb-run": "xvfb", "xauth": "xauth"},
    "clicking tests of the player": {"chromium": "chromium"},
    "clicking tests of the window": {"Xvfb": "xvfb", "xdotool": "xdotool"},
}

DRIVERS = ("/usr/share/vulkan/icd.d", "/etc/vulkan/icd.d", "/usr/local/share/vulkan/icd.d")
"""Where a driver of Vulkan says that it is there."""


def examine() -> dict[str, Any]:
    """All that there is to know, ready for JSON.  Nothing that crashes takes this process along."""
    with ThreadPoolExecutor() as threads:
        tries = {device: threads.submit(_backend, device) for device in BACKENDS}
        tries["window"] = threads.submit(window)
        tries["system"] = threads.submit(_system)
        done = {name: one.result() for name, one in tries.items()}
    cache = next((done[device].pop("cache", None) for device in BACKENDS), None)
    return {
        "versions": versions(),
        "machine": platform.platform(),
        "cores": _cores(),
        "load": os.getloadavg()[0] if hasattr(os, "getloadavg") else None,
        "free_memory": free_on_host(),
        "cache": _cache(cache),
        "packages": [one._asdict() | {"installed": installed(one.name)} for one in PACKAGES],
        "system": done["system"],
        "backends": {device: done[device] for device in BACKENDS},
        "window": done["window"],
    }


def probe(*words: str, timeout: float = TIMEOUT) -> tuple[list[dict], str | None]:
    """The answers of `mpm_taichi.probe`, and how it ended where that was no good end."""
    package = str(Path(__file__).parents[1])
    before = os.environ.get("PYTHONPATH")
    path = package if before is None else os.pathsep.join((package, before))
    with tempfile.TemporaryDirectory() as folder:  # GGUI writes imgui.ini into its folder
        try:
            ended = subprocess.run(
                [sys.executable, "-m", "mpm_taichi.probe", *words], cwd=folder, timeout=timeout,
                capture_output=True, text=True, errors="replace",
                env=os.environ | {"PYTHONPATH": path},
            )  # fmt: skip
        except subprocess.TimeoutExpired as error:
            said = (error.stdout or b"").decode(errors="replace")
            return _answers(said), f"no answer within {timeout:g} s"
        except OSError as error:
            return [], f"cannot be tried: {error}"
    fault = None
    if ended.returncode < 0:
        fault = f"crashes (signal {-ended.returncode})"
    elif ended.returncode:
        words_of_it = [line for line in ended.stderr.splitlines() if line.strip()]
        fault = f"fails: {words_of_it[-1].strip() if words_of_it else ended.returncode}"
    return _answers(ended.stdout), fault


def _answers(text: str) -> list[dict]:
    return [json.loads(line) for line in text.splitlines() if line.startswith("{")]


def _backend(device: str) -> dict[str, Any]:
    """`works`: precisions; `notes`: in words."""
    if device == "metal" and sys.platform != "darwin":
        return {"works": [], "notes": ["is for macOS"]}
    answers, fault = probe(device)
    found: dict[str, Any] = {"works": [], "notes": []}
    for said in answers:
        if "cache" in said:
            found["cache"] = said["cache"]
        elif "fault" in said:
            absent = "is not supported" in said["fault"]
            text = "no such device, or no driver" if absent else said["fault"]
            found["notes"].append(text)
        else:
            found["works"].append(said["precision"])
            if not said["logarithm"]:
                text = "without log, exp, sin: laws and formulas that use them do not compile"
                found["notes"].append(f"{said['precision']} {text}")
    found["notes"] = list(dict.fromkeys(found["notes"]))
    if fault:
        found["notes"].append(fault)
    return found


def window() -> dict[str, Any]:
    """Whether one `opens`, and a `note` on why not."""
    if sys.platform.startswith("linux") and not os.environ.get("DISPLAY"):
        return {"opens": False, "note": "there is no display (DISPLAY is not set)"}
    answers, fault = probe("window")
    return {"opens": bool(answers) and fault is None, "note": fault}


def _system() -> dict[str, Any]:
    """By what needs them: packages of Debian that are missing.  None where it cannot be told."""
    if not sys.platform.startswith("linux"):
        return {"missing": None}
    names = [name for group in LIBRARIES.values() for name in group]
    there = {said["library"] for said in probe("libraries", *names)[0] if said["loads"]}
    missing = {
        need: [package for name, package in group.items() if name not in there]
        for need, group in LIBRARIES.items()
    }
    if not any(any(Path(folder).glob("*.json")) for folder in DRIVERS):
        missing["Vulkan and the window"].append("mesa-vulkan-drivers")
    for need, group in PROGRAMS.items():
        missing[need] = [package for name, package in group.items() if shutil.which(name) is None]
    return {"missing": missing}


def _cores() -> int | None:
    """Those that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()


def _cache(path: str | None) -> dict[str, Any]:
    """Taichi's folder of compiled kernels; without it each run compiles anew."""
    if path is None:
        return {"folder": None, "writable": None}
    folder = Path(path).expanduser()
    there = next(one for one in (folder, *folder.absolute().parents) if one.exists())
    try:
        with tempfile.TemporaryFile(dir=there):
            return {"folder": path, "writable": True}
    except OSError:
        return {"folder": path, "writable": False}


def table(found: dict[str, Any]) -> str:
    """What `examine` has found, for people."""
    memory = found["free_memory"]
    lines = [
        f"mpm_taichi {found['versions']['mpm_taichi']}, Python {found['versions']['python']}, "
        f"{found['machine']}",
        f"{found['cores']} cores"
        + ("" if found["load"] is None else f", load {found['load']:.1f}")
        + ("" if memory is None else f"; {size(memory)} of memory are free"),
        *_cache_lines(found["cache"]),
        "", "backends (--device), each tried in a process of its own",
        *(_backend_line(name, one) for name, one in found["backends"].items()),
        _window_line(found["window"]),
        "", "packages",
        *(_package_line(one) for one in found["packages"]),
    ]  # fmt: skip
    missing = found["system"]["missing"]
    if missing is not None:
        lines += ["", "system (Debian, Ubuntu)"]
        lines += [_need_line(need, packages) for need, packages in missing.items()]
    return "\n".join(lines)


def _line(works: bool, name: str, text: str) -> str:
    return f"  {'ok' if works else '--'}  {name:<15} {text}".rstrip()


def _backend_line(name, one):
    text = "; ".join(filter(None, [", ".join(one["works"]), *one["notes"]]))
    return _line(bool(one["works"]), name, text)


def _window_line(window):
    aside = "" if window["opens"] else "; pictures, videos and the player need none"
    return _line(window["opens"], "window", (window["note"] or "opens") + aside)


def _package_line(one):
    if one["installed"]:
        return _line(True, one["name"], f"{one['installed']}: {one['purpose']}")
    need = "optional" if one["is_optional"] else "required"
    text = f'{need}, for {one["purpose"]}: pip install "{one["requirement"]}"'
    return _line(False, one["name"], text)


def _need_line(need, packages):
    if not packages:
        return f"  ok  {need}"
    return f"  --  {need}: sudo apt-get install {' '.join(packages)}"


def _cache_lines(cache):
    if cache["writable"] is False:
        yield (
            f"cache {cache['folder']}: cannot be written, so each run compiles anew; name another "
            "folder: export TI_OFFLINE_CACHE_FILE_PATH=DIR"
        )
    elif cache["writable"]:
        yield f"cache of kernels: {cache['folder']}"
