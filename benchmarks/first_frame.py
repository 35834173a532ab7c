"""What a user waits for: from the start of the process to the pictures on disk."""

import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

from interleaved import QUIET
from tables import markdown

SCENES = ("two_disks", "two_balls")
"""Shipped scenes of 694 particles in 2D and 6,214 in 3D."""

POLL = 0.01  # s
PATIENCE = 600.0  # s


def cpu_seconds(process: int) -> float:
    """Of a running process with all its threads; what Linux alone tells, else 0."""
    path = Path(f"/proc/{process}/stat")
    if not path.exists():
        return 0.0
    fields = path.read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def waited(scene: str, cache: str) -> dict[str, float]:
    """Wall seconds to the picture of the start and to that of the first output, and CPU seconds
    to the latter.  Then the process is asked to end, since Taichi writes its cache at the end."""
    with tempfile.TemporaryDirectory() as folder:
        command = [sys.executable, "-m", "mpm_taichi", "run", "-q", "-o", f"{folder}/run"]
        command.append(str(Path(__file__).parents[1] / "scenes" / f"{scene}.yaml"))
        frames = Path(folder) / "run" / "frames"
        environment = os.environ | QUIET | {"TI_OFFLINE_CACHE_FILE_PATH": cache}
        began, seen = time.perf_counter(), {}
        process = subprocess.Popen(command, env=environment, stderr=subprocess.PIPE, text=True)
        for name, number in (("start", 0), ("output", 1)):
            while not (frames / f"frame_{number:04d}.png").exists():
                if process.poll() is not None or time.perf_counter() - began > PATIENCE:
                    process.kill()
                    _, said = process.communicate()
                    sys.exit(f"{scene}: no picture {number}, in {PATIENCE:.0f} s or at all\n{said}")
                time.sleep(POLL)
            seen[name] = time.perf_counter() - began
        seen["cpu"] = cpu_seconds(process.pid)
        process.terminate()
        process.communicate()
        return seen


def measured(rounds: int) -> list[dict]:
    """A row for each scene, with an empty cache of kernels and with a full one; least of rounds."""
    rows: list[dict[str, Any]] = [
        {"case": scene, "cache": kind} for scene in SCENES for kind in ("empty", "full")
    ]
    for _ in range(rounds):
        for scene in SCENES:
            with tempfile.TemporaryDirectory() as cache:
                for row in (row for row in rows if row["case"] == scene):
                    for name, seconds in waited(scene, cache).items():
                        row[name] = min(seconds, row.get(name, seconds))
    return rows


def table(rows) -> str:
    """A line for each row of `measured`."""
    head = ["scene", "cache of kernels", "picture of the start", "of the first output", "CPU"]
    lines = [
        [row["case"], row["cache"], *(f"{row[k]:.1f} s" for k in ("start", "output", "cpu"))]
        for row in rows
    ]
    return markdown(head, lines)
