"""Run a scene into a folder: pictures, history, report, progress."""

import contextlib
import json
import signal
import sys
import time
from pathlib import Path

from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

from . import run_folder
from .errors import RunError
from .recorders import Errors, History, Images
from .report import Report
from .scene import dump_scene
from .simulation import Simulation

PLAIN_INTERVAL = 5.0  # seconds between lines where no terminal shows a bar


class Interrupted(Exception):  # noqa: N818 - a wish of the user's, no error
    """A signal asked the run to stop; the exit code is 128 + its number."""

    def __init__(self, number: int):
        super().__init__(signal.Signals(number).name)
        self.exit_code = 128 + number


def run(scene, name, options, console: Console) -> int:
    """Run a scene; `name` is that of its file.  Returns the exit code."""
    began = time.perf_counter()
    run_folder.refuse(options.output, options.overwrite)
    simulation = Simulation(scene, options.device, options.precision, options.threads)
    announce(simulation, console)
    folder = run_folder.create(name, options.output, options.overwrite)
    report, history, errors = Report(simulation, sys.argv[1:]), None, None
    status, error, code = "done", None, 0
    try:
        run_folder.write_text(folder / "scene.yaml", dump_scene(scene))
        run_folder.write_json(folder / "run.json", report.content("running"))
        with contextlib.ExitStack() as stack:
            history = History(folder / "history.csv", simulation, scene.output.history.every_steps)
            stack.callback(history.close)
            recorders: list = [history]
            if scene.exact is not None:
                every = scene.output.history.every_steps
                errors = Errors(folder / "errors.csv", simulation, every)
                stack.callback(errors.close)
                recorders.append(errors)
                console.print(errors.exact.describe(), soft_wrap=True)
            if scene.output.images != "none":
                recorders.append(Images(folder / "frames", simulation, scene.output.images))
                stack.callback(recorders[-1].close)
            recorders.append(stack.enter_context(Interruption()))
            recorders.append(stack.enter_context(Progressing(console, began)))
            simulation.run(recorders)
    except RunError as failure:
        status, error, code = "failed", str(failure), 1
    except Interrupted as signal_name:
        status, error, code = "interrupted", f"by {signal_name}", signal_name.exit_code
    except OSError as failure:
        status, error, code = "failed", f"writing to {folder} failed: {failure}", 1
    except BaseException as fault:
        with contextlib.suppress(OSError):
            run_folder.write_json(folder / "run.json", report.content("failed", None, repr(fault)))
        raise
    content = report.content(status, history, error, errors)
    try:
        run_folder.write_json(folder / "run.json", content)
    except OSError as failure:
        status, error, code = "failed", error or f"writing to {folder} failed: {failure}", code or 1
    for warning, count in content["warnings"].items():
        console.print(f"warning: {warning}: {count}", soft_wrap=True)
    if errors is not None and errors.summary():
        console.print(errors.describe(), soft_wrap=True)
    if error:
        print(f"{status}: {error}", file=sys.stderr)  # also where the console is quiet
    console.print(summary(simulation, folder, status), soft_wrap=True)
    if options.json:
        print(json.dumps(content, indent=2))
    return code


def check(scene, options, console: Console) -> int:
    """Seed a scene and show what a run would be."""
    simulation = Simulation(scene, options.device, options.precision, options.threads)
    announce(simulation, console)
    console.print(simulation.memory.describe(), soft_wrap=True)
    steps = scene.time.end / simulation.dt
    console.print(
        f"about {steps:.0f} steps to t = {scene.time.end:g} s, {simulation.outputs.count} outputs "
        f"after the start",
        soft_wrap=True,
    )  # fmt: skip
    return 0


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
        f"{status}: t = {simulation.time:.6g} s after {simulation.step_count} steps; "
        f"results in {folder}"
    )


class Interruption:
    """A recorder that ends the run between two steps after Ctrl-C or SIGTERM, so that results and
    report are whole.  A second signal acts at once."""

    every_steps = None

    def __enter__(self):
        self.number, self.before = None, {}
        for number in (signal.SIGINT, signal.SIGTERM):
            with contextlib.suppress(ValueError):  # not the main thread: signals are another's
                self.before[number] = signal.signal(number, self._note)
        return self

    def __exit__(self, *_):
        for number, handler in self.before.items():
            signal.signal(number, handler)

    def _note(self, number, _frame):
        if self.number is not None:
            raise Interrupted(number)
        self.number = number

    def record(self, simulation, is_output):
        if self.number is not None:
            raise Interrupted(self.number)


class Progressing:
    """A recorder that shows how far the run is: a bar on a terminal, else a line now and then."""

    every_steps = None

    def __init__(self, console: Console, began: float):
        self.console, self.began = console, began
        self.bar = Progress(
            TextColumn("t = {task.completed:.4g} of {task.total:.4g} s"), BarColumn(),
            TextColumn("step {task.fields[step]}, {task.fields[pace]}"), TimeRemainingColumn(),
            console=console, transient=True, disable=not console.is_terminal,
        )  # fmt: skip
        self.task = None

    def __enter__(self):
        self.bar.start()
        return self

    def __exit__(self, *_):
        self.bar.stop()

    def record(self, simulation, is_output):
        now = time.perf_counter()
        if self.task is None:
            self.task = self.bar.add_task(
                "", total=simulation.end, step=0, pace="compiling kernels ..."
            )
            self.console.print("compiling kernels; later runs find them in Taichi's cache ...")
            self.start, self.shown = now, now
            return
        if simulation.step_count == 1:  # the first step compiles: its pace says nothing
            self.start = now
            compiled = f"first step after {now - self.began:.1f} s"
            self.console.print(f"kernels are ready, {compiled}")
            return
        interval = 0.1 if self.console.is_terminal else PLAIN_INTERVAL
        if now - self.shown < interval:
            return
        self.shown = now
        pace = (now - self.start) / (simulation.step_count - 1)
        text = f"{1e3 * pace:.3g} ms a step"
        self.bar.update(self.task, completed=simulation.time, step=simulation.step_count, pace=text)
        if not self.console.is_terminal:
            left = (now - self.start) * (simulation.end / simulation.time - 1)
            self.console.print(
                f"t = {simulation.time:.4g} of {simulation.end:.4g} s, step "
                f"{simulation.step_count}, {text}, {left:.0f} s to finish",
            )
