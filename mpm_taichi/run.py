"""Run a scene into a folder: pictures, history, report, progress.  Or show what that would be."""

import contextlib
import json
import sys
import time
from pathlib import Path

from rich.console import Console

from . import run_folder
from .attempts import Attempts
from .audit import audit
from .audit import describe as describe_audit
from .disk_space import describe, planned_disk, refuse_full_disk
from .errors import InputError, MotionError, RunError
from .interruption import Interrupted, Interruption
from .predicted_time import predict
from .progress import Progressing
from .recorders import Errors
from .report import Report, whom
from .scene import dump_scene
from .simulation import Simulation
from .trouble import write_trouble
from .whole_files import write_json, write_text


def run(scene, name, options, console: Console) -> int:
    """Run a scene; `name` is that of its file.  Returns the exit code."""
    began = time.perf_counter()
    run_folder.refuse(options.output, options.overwrite)
    simulation = Simulation(scene, options.device or "cpu", options.precision, options.threads)
    announce(simulation, console)
    refuse_full_disk(planned_disk(simulation), options.output or Path("runs"))
    folder = run_folder.create(name, options.output, options.overwrite)
    return carry_out(Attempts(simulation, folder, console), options, console, began)


def carry_out(attempts: Attempts, options, console: Console, began: float, before=()) -> int:
    """Run to the end, and tell how it went.  `before`: the report of the processes whose run this
    one goes on with.  Returns the exit code."""
    folder, report = attempts.folder, Report(attempts, sys.argv[1:], before)
    status, error, code = "done", None, 0
    try:
        write_text(folder / "scene.yaml", dump_scene(attempts.simulation.scene))
        write_json(folder / "run.json", report.content("running"))
        with Interruption() as interruption, Progressing(console, began) as progressing:
            interruption.watch(attempts.simulation)
            attempts.run([interruption, progressing])
            report.audit = audit(attempts.simulation, folder / "history.csv")
    except MotionError as failure:
        status, error, code = "failed", str(failure), 1
        error += write_trouble(attempts, failure)
    except (RunError, InputError) as failure:
        status, error, code = "failed", str(failure), 1
    except Interrupted as signal_name:
        status, error, code = "interrupted", f"by {signal_name}", signal_name.exit_code
    except OSError as failure:
        status, error, code = "failed", f"writing to {folder} failed: {failure}", 1
    except BaseException as fault:
        with contextlib.suppress(OSError):
            write_json(folder / "run.json", report.content("failed", repr(fault)))
        raise
    content = report.content(status, error)
    try:
        write_json(folder / "run.json", content)
    except OSError as failure:
        status, error, code = "failed", error or f"writing to {folder} failed: {failure}", code or 1
    for warning, count in content["warnings"].items():
        console.print(f"warning: {warning}: {count}", soft_wrap=True)
    errors = attempts.recorder(Errors)
    if errors is not None and errors.summary():
        console.print(errors.describe(), soft_wrap=True)
    if report.audit:
        console.print(describe_audit(report.audit), soft_wrap=True)
    if options.strict and any(line.verdict == "FAIL" for line in report.audit):
        code, error = (
            code or 1,
            error or "a line of the audit fails (--strict); all results are kept",
        )
    if error:
        print(f"{status}: {error}", file=sys.stderr)  # also where the console is quiet
    if code and attempts.saved is not None:
        print(f"to go on: python -m mpm_taichi --resume {folder}", file=sys.stderr)
    console.print(summary(attempts.simulation, folder, status), soft_wrap=True)
    if options.json:
        print(json.dumps(content, indent=2))
    return code


def check(scene, options, console: Console) -> int:
    """Seed a scene and show what a run would be."""
    simulation = Simulation(scene, options.device or "cpu", options.precision, options.threads)
    announce(simulation, console)
    console.print(simulation.memory.describe(), soft_wrap=True)
    disk = planned_disk(simulation)
    console.print(describe(disk), soft_wrap=True)
    refuse_full_disk(disk, Path("runs"))
    steps = scene.time.end / simulation.dt
    console.print(
        f"about {steps:.0f} steps to t = {scene.time.end:g} s, {simulation.outputs.count} outputs "
        f"after the start",
        soft_wrap=True,
    )  # fmt: skip
    if options.time:
        console.print("taking the first steps to tell the time (--no-time leaves it out) ...")
        console.print(told_time(simulation), soft_wrap=True)
    return 0


def told_time(simulation) -> str:
    """How long the run will take, in words."""
    try:
        prediction = predict(simulation)
    except MotionError as error:
        return f"warning: the run fails in its first steps: {error}"
    return "time: one step" if prediction is None else prediction.describe()


def announce(simulation, console):
    """What will run: particles, device, time step."""
    scene = simulation.scene
    for seeding in simulation.seeding:
        console.print(seeding.describe(), soft_wrap=True)
    console.print(
        f"{simulation.device} {simulation.precision}, threads {simulation.threads}; "
        f"{' x '.join(map(str, scene.domain.cells))} cells of {scene.cell_size:g} m; "
        f"{scene.method.basis} basis, {scene.method.transfer.type}",
        soft_wrap=True,
    )  # fmt: skip
    for line in simulation.time_step.describe(simulation.dt):
        console.print(line, soft_wrap=True)


def summary(simulation, folder: Path, status: str) -> str:
    return (
        f"{status}: t = {simulation.time:.6g} s after {simulation.step_count} steps"
        f"{binding(simulation)}; results in {folder}"
    )


def binding(simulation) -> str:
    """Which limit has bound most of the steps, and whom it was about."""
    found = simulation.time_step.most_binding()
    if found is None:
        return ""
    limit, count = found
    return f", {count} of them bound by the {limit.name} limit ({whom(simulation, limit)})"
