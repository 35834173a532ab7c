"""How far a run is, for people."""

import time

from rich.console import Console
from rich.progress import BarColumn, Progress, TaskID, TextColumn, TimeRemainingColumn

PLAIN_INTERVAL = 5.0  # seconds between lines where no terminal shows a bar


class Progressing:
    """A recorder that shows how far the run is: a bar on a terminal, else a line now and then."""

    every_steps = None

    def __init__(self, console: Console, began: float):
        self.console = console
        self.began: float | None = began
        self.bar = Progress(
            TextColumn("t = {task.completed:.4g} of {task.total:.4g} s"), BarColumn(),
            TextColumn("step {task.fields[step]}, {task.fields[pace]}"), TimeRemainingColumn(),
            console=console, transient=True, disable=not console.is_terminal,
        )  # fmt: skip
        self.task: TaskID | None = None
        self.start: tuple[float, int, float] | None = None

    def __enter__(self):
        self.bar.start()
        self.console.print("compiling kernels; later runs find them in Taichi's cache ...")
        return self

    def __exit__(self, *_):
        self.bar.stop()

    def record(self, simulation, is_output):
        now, step = time.perf_counter(), simulation.step_count
        if self.task is None:
            self.task = self.bar.add_task(
                "", total=simulation.end, step=step, pace="compiling kernels ..."
            )
            self.shown = now
        is_back = self.start is not None and step < self.start[1]  # after an attempt that failed
        if step == 0 or is_back:
            self.start = None
            return
        if self.start is None:  # the first step compiles: its pace says nothing
            self.start = now, step, simulation.time
            if self.began is not None:
                compiled = f"first step after {now - self.began:.1f} s"
                self.console.print(f"kernels are ready, {compiled}")
                self.began = None
            return
        interval = 0.1 if self.console.is_terminal else PLAIN_INTERVAL
        if now - self.shown < interval:
            return
        self.shown = now
        clock, first, time_then = self.start
        pace = (now - clock) / max(1, step - first)
        text = f"{1e3 * pace:.3g} ms a step"
        self.bar.update(self.task, completed=simulation.time, step=step, pace=text)
        if not self.console.is_terminal:
            left = (now - clock) * (simulation.end - simulation.time)
            left /= simulation.time - time_then
            self.console.print(
                f"t = {simulation.time:.4g} of {simulation.end:.4g} s, step "
                f"{step}, {text}, {left:.0f} s to finish",
            )
