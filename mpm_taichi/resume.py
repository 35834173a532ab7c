"""Go on with a run that was interrupted, or killed."""

import time
from pathlib import Path

from . import checkpoints
from .attempts import Attempts
from .errors import InputError
from .identity import differences, identity
from .run import announce, carry_out
from .run_folder import read_report
from .scene import dump_scene, load_scene
from .simulation import Simulation


def resume(options, console) -> int:
    """From the newest whole checkpoint of the run folder `options.resume`: on a CPU as if it had
    never been interrupted, to the last bit.  Refused for another scene, version or precision,
    unless forced.  Returns the exit code."""
    began, folder = time.perf_counter(), options.resume
    report = read_report(folder)
    checkpoint = checkpoints.newest(
        folder / "checkpoints",
        warn=lambda text: console.print(f"warning: {text}; going on from the one before"),
    )
    if checkpoint is None:
        raise InputError(
            f"--resume {folder}: the run has no checkpoint; the first is written after a minute of "
            "computing (output.checkpoints), or when the run is interrupted: start it anew"
        )
    if report.get("status") == "done":
        raise InputError(f"--resume {folder}: the run is done")
    before = checkpoint.meta["identity"]
    simulation = Simulation(
        _scene(options, folder),
        options.device or before["device"],
        options.precision or before["precision"],
        options.threads,
    )
    found = differences(before, identity(simulation))
    if found and not options.force:
        raise InputError(
            f"--resume {folder}: not the same as when the run was saved: {', '.join(found)}. Go on "
            "all the same: --force"
        )
    try:
        simulation.restore(checkpoint.meta["simulation"], checkpoint.arrays)
    except (KeyError, TypeError, ValueError) as error:
        raise InputError(
            f"--resume {folder}: the checkpoint is of other particles or another method ({error})"
        ) from None
    announce(simulation, console)
    console.print(
        f"going on from t = {simulation.time:.6g} s, step {simulation.step_count}, of "
        f"{checkpoint.path}",
        soft_wrap=True,
    )
    attempts = Attempts(simulation, folder, console, checkpoint)
    return carry_out(attempts, options, console, began, report)


def _scene(options, folder: Path):
    """That of the run, or the one that is named; with changes."""
    kept = load_scene(folder / "scene.yaml", options.set)
    if options.scene is None:
        return kept
    named = load_scene(options.scene, options.set)
    if dump_scene(named) != dump_scene(kept) and not options.force:
        raise InputError(
            f"{options.scene} is another scene than that of {folder}: leave it out, or --force"
        )
    return named
