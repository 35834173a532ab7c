"""The disk space that a run's particle files take, told before it starts."""

import shutil
from pathlib import Path

from .errors import InputError
from .memory import size
from .recorders.paraview import paraview_bytes
from .recorders.snapshots import snapshot_bytes, wants_snapshots
from .recorders.stages import stages_bytes

SPARE = 100 * 2**20
"""Bytes left for what is small: the history, pictures, the report."""


def planned_disk(simulation) -> dict[str, int]:
    """Bytes of its run by folder; nothing for pictures, which are small."""
    scene, count = simulation.scene, int(simulation.ranges[-1])
    outputs = simulation.outputs.count + 1
    found = {}
    if wants_snapshots(scene, count):
        found["snapshots"] = outputs * snapshot_bytes(scene, count) + 9 * count
    if scene.output.paraview:
        found["paraview"] = outputs * paraview_bytes(scene, count)
    if scene.output.stages:
        found["stages"] = outputs * stages_bytes(scene, count)
    return found


def describe(planned: dict[str, int]) -> str:
    """One line."""
    each = (f"{size(count)} for {folder}" for folder, count in planned.items())
    return f"disk: {', '.join(each) or 'no snapshots'}, beside pictures and tables"


def refuse_full_disk(planned: dict[str, int], folder: Path) -> None:
    """InputError where a run into `folder`, which need not be there yet, does not fit."""
    there = next(path for path in (folder, *folder.absolute().parents) if path.exists())
    free, need = shutil.disk_usage(there).free, sum(planned.values())
    if need and need + SPARE > free:
        largest = max(planned, key=lambda name: planned[name])
        raise InputError(
            f"the run would write {size(need)} of particles, {size(planned[largest])} of them "
            f"{largest}, and {size(free)} are free in {there}: write fewer outputs (output.every, "
            f"--frames), none of these (--set output.{largest}=false), or elsewhere (-o DIR)"
        )
