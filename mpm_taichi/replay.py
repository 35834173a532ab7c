"""See once more how a run failed."""

import json
from pathlib import Path

from . import checkpoints
from .errors import InputError, MotionError
from .run_folder import read_report
from .scene import load_scene
from .simulation import Simulation


def replay(folder: Path, console) -> int:
    """The last attempt of a failed run, without recorders: from where it began, with the steps it
    took and a look at all particles after each.  Returns 1 where it fails again, else 0."""
    path = folder / "trouble" / "trouble.json"
    try:
        told = json.loads(path.read_text(encoding="utf-8"))
        report = read_report(folder)
        start, reduction = told["from"], told["steps_shortened_to"]
        machine = report["device"], report["precision"], report["threads"]
    except OSError:
        raise InputError(f"{folder}: holds no run that failed (no trouble/trouble.json)") from None
    except (ValueError, KeyError, TypeError):
        raise InputError(f"{path}: is damaged") from None
    device, precision, threads = machine
    simulation = Simulation(
        load_scene(folder / "scene.yaml", []), device, precision,
        threads if device == "cpu" else None, reduction,
    )  # fmt: skip
    if start is not None:
        checkpoint = checkpoints.load(folder / "trouble" / Path(start).name)
        simulation.restore(checkpoint.meta["simulation"], checkpoint.arrays)
        simulation.shorten_steps(reduction)
    simulation.lookout.guard_steps = 1
    console.print(
        f"from t = {simulation.time:.6g} s, step {simulation.step_count}, toward the failure at "
        f"t = {told['time']:.6g} s, step {told['step']}",
        soft_wrap=True,
    )
    try:
        simulation.run()
    except MotionError as error:
        same = error.particle == told.get("particle", {}).get("id")
        again = "the same particle" if same else "the first particle that shows it"
        when = "at the same step" if simulation.step_count == told["step"] else "at another step"
        console.print(f"it fails again, {again}, {when}: {error}", soft_wrap=True)
        return 1
    console.print(f"this time it goes through to t = {simulation.time:.6g} s", soft_wrap=True)
    return 0
