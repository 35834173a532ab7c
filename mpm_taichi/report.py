"""run.json: what ran, how, for how long, and what it kept."""

import dataclasses
import platform
import re
import time
from importlib.metadata import PackageNotFoundError, version

from . import __version__, stages

KEPT = r"mass|(angular_)?momentum(_[xyz])?|(kinetic|elastic|dissipated|gravitational)_energy"
PACKAGES = ("taichi", "numpy", "gmsh", "meshio", "pydantic")


class Report:
    """Grows with the run; `content` is the JSON of the moment."""

    def __init__(self, simulation, command: list[str]):
        self.simulation, self.command = simulation, command
        self.started = time.time()

    def content(self, status: str, history=None, error: str | None = None, errors=None) -> dict:
        simulation = self.simulation
        time_step = simulation.time_step
        result = {
            "status": status,
            "error": error,
            "command": self.command,
            "started": time.strftime("%Y-%m-%dT%H:%M:%S%z", time.localtime(self.started)),
            "wall_seconds": time.time() - self.started,
            "versions": versions(),
            "machine": platform.platform(),
            "device": simulation.device,
            "precision": simulation.precision,
            "threads": simulation.threads,
            "time": simulation.time,
            "steps": simulation.step_count,
            "time_step": {
                "shortest": time_step.shortest if simulation.step_count else None,
                "longest": time_step.longest if simulation.step_count else None,
                "chosen_by": "scene" if time_step.given is not None else "auto",
                "shortened": time_step.shortened,
                "binding": dict(time_step.counts),
                "limits_at_start": [limit._asdict() for limit in simulation.limits_at_start],
            },
            "seeding": [dataclasses.asdict(report) for report in simulation.seeding],
            "memory": simulation.memory.summary(),
            "timing": {
                "first_calls_seconds": dict(stages.first_calls),
                "stage_seconds": dict(stages.seconds),
                "sorts": simulation.solver.sorts,
            },
            "warnings": simulation.warnings(),
        }
        if history is not None and history.first is not None:
            result["conservation"] = conservation(history.first, history.last)
        if errors is not None:
            result["errors"] = errors.summary()
        return result


def versions() -> dict[str, str | None]:
    return {
        "mpm_taichi": __version__,
        "python": platform.python_version(),
        **{package: installed(package) for package in PACKAGES},
    }


def installed(package: str) -> str | None:
    """Its version; None where a package that this run did not need is missing."""
    try:
        return version(package)
    except PackageNotFoundError:
        return None


def conservation(first: dict, last: dict) -> dict:
    """Start, end and change of what a free system keeps."""
    kept = [name for name in first if re.fullmatch(KEPT, name)]
    return {n: {"start": first[n], "end": last[n], "change": last[n] - first[n]} for n in kept}
