"""run.json: what ran, how, for how long, and what it kept."""

import dataclasses
import platform
import re
import time
from importlib.metadata import PackageNotFoundError, version

from . import __version__, stages
from .audit import Line
from .audit import summary as audit_summary
from .disk_space import planned_disk
from .recorders import Errors, History
from .time_step import OF_MOTION

KEPT = r"mass|(angular_)?momentum(_[xyz])?|(kinetic|elastic|dissipated|gravitational)_energy"
PACKAGES = ("taichi", "numpy", "gmsh", "meshio", "pydantic")


class Report:
    """Grows with the run; `content` is the JSON of the moment."""

    def __init__(self, attempts, command: list[str], before=None):
        self.attempts, self.command = attempts, command
        self.before = dict(before or {})
        self.audit: list[Line] = []  # closed when the run is done
        self.started = time.time()

    def content(self, status: str, error: str | None = None) -> dict:
        simulation = self.attempts.simulation
        time_step = simulation.time_step
        result = {
            "status": status,
            "error": error,
            "command": self.command,
            "started": time.strftime("%Y-%m-%dT%H:%M:%S%z", time.localtime(self.started)),
            "wall_seconds": time.time() - self.started,
            "processes_before": self._processes_before(),
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
                "bound_by": {
                    name: whom(simulation, limit) for name, limit in time_step.binders.items()
                },
                "limits_at_start": [limit._asdict() for limit in simulation.limits_at_start],
            },
            "seeding": [dataclasses.asdict(report) for report in simulation.seeding],
            "memory": simulation.memory.summary(),
            "disk": planned_disk(simulation),
            "timing": {
                "first_calls_seconds": dict(stages.first_calls),
                "stage_seconds": dict(stages.seconds),
                "sorts": simulation.solver.sorts,
            },
            "failures": self.attempts.failures,
            "warnings": simulation.warnings(),
        }
        if self.attempts.failures:
            words = "attempts that failed; what followed has shorter steps"
            result["warnings"][words] = len(self.attempts.failures)
        history, errors = map(self.attempts.recorder, (History, Errors))
        if history is not None and history.first is not None:
            result["conservation"] = conservation(history.first, history.last)
        if errors is not None:
            result["errors"] = errors.summary()
        if self.audit:
            result["audit"] = audit_summary(self.audit)
        return result

    def _processes_before(self) -> list[dict]:
        """How the run came to where this process took it up, the first one first."""
        if not self.before:
            return []
        kept = ("command", "status", "error", "started", "wall_seconds", "steps", "failures")
        last = {name: self.before.get(name) for name in kept}
        return [*self.before.get("processes_before", []), last]


def whom(simulation, limit) -> str:
    """What or whose a limit is: of its cause or its particle."""
    if limit.particle is None:
        return limit.cause
    who = simulation.describe_particle(limit.particle)
    return f"{who}, {limit.cause}" if limit.name in OF_MOTION else who


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
