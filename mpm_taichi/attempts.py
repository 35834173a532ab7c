"""A simulation on its way into a folder: recorders, checkpoints, and another attempt with shorter
steps where the motion goes wrong."""

import contextlib
from pathlib import Path
from typing import Any

from . import checkpoints
from .errors import InputError, MotionError
from .identity import identity
from .interruption import Interrupted
from .recorders import Errors, History, Images, Keeper, ParaView, Snapshots, Stages
from .recorders.snapshots import wants_snapshots
from .simulation import Simulation

MOST_RETRIES = 5

SHORTER = 0.5
"""Steps of a retry, as a part of those that failed."""

SAME_TIME = 0.02
"""A particle that leaves the domain again within this part of the attempt's time does so with
shorter steps too: that is where the motion goes."""


class Attempts:
    """Runs a simulation to its end.  Where the motion goes wrong it goes back to a checkpoint, or
    to the start where there is none, and tries again with steps half as long, at most five times;
    `failures` tells of each, for run.json.

    `checkpoint`: the one that the simulation was restored from."""

    def __init__(self, simulation: Simulation, folder: Path, console, checkpoint=None):
        self.simulation, self.folder, self.console = simulation, folder, console
        self.checkpoint: checkpoints.Checkpoint | None = checkpoint
        self.reduction = simulation.time_step.reduction
        self.failures: list[dict[str, Any]] = []
        self.recorders: list[Any] = []
        self.identity = identity(simulation)

    def run(self, followers) -> None:
        """`followers`: recorders that keep nothing."""
        while True:
            with self.recording() as keeper:
                try:
                    return self.simulation.run([*self.recorders, keeper, *followers])
                except Interrupted as wish:
                    if wish.is_between and keeper.interval != "none":
                        keeper.save(self.simulation)
                    raise
                except MotionError as error:
                    self._note(error)
                    if not self._is_worth_another():
                        raise
            self._go_back()

    def recorder(self, kind: type) -> Any:
        """That of a kind, None if the scene has none."""
        return next((one for one in self.recorders if isinstance(one, kind)), None)

    @property
    def saved(self) -> Path | None:
        """The newest checkpoint."""
        return next(iter(checkpoints.newest_first(self.folder / "checkpoints")), None)

    @contextlib.contextmanager
    def recording(self):
        """Within it `recorders` are open; yields the one that writes checkpoints."""
        scene, output = self.simulation.scene, self.simulation.scene.output
        every, states = output.history.every_steps, {}
        if self.checkpoint is not None:
            states = self.checkpoint.meta["recorders"]
        plans: list[tuple[Any, ...]] = [(History, "history.csv", every)]
        if scene.exact is not None:
            plans.append((Errors, "errors.csv", every))
        if output.images != "none":
            plans.append((Images, "frames", output.images))
        if wants_snapshots(scene, self.simulation.ranges[-1]):
            plans.append((Snapshots, "snapshots"))
        if output.paraview:
            plans.append((ParaView, "paraview", getattr(output.paraview, "grid", False)))
        if output.stages:  # last: it leaves other values at the nodes
            plans.append((Stages, "stages"))
        with contextlib.ExitStack() as stack:
            self.recorders = []
            for kind, name, *how in plans:
                state = states.get(kind.__name__)
                self.recorders.append(kind(self.folder / name, self.simulation, *how, state=state))
                stack.callback(self.recorders[-1].close)
            if scene.exact is not None and not self.failures:
                self.console.print(self.recorder(Errors).exact.describe(), soft_wrap=True)
            yield Keeper(
                self.folder / "checkpoints", self.recorders, self.identity, output.checkpoints
            )

    def _note(self, error: MotionError):
        simulation = self.simulation
        self.failures.append({
            "error": str(error), "particle": error.particle, "is_exit": error.is_exit,
            "time": simulation.time, "step": simulation.step_count,
            "from_step": self.checkpoint.meta["simulation"]["step_count"] if self.checkpoint else 0,
            "from_time": self.checkpoint.meta["simulation"]["time"] if self.checkpoint else 0.0,
            "steps_shortened_to": self.reduction,
        })  # fmt: skip

    def _is_worth_another(self) -> bool:
        now, before = self.failures[-1], self.failures[:-1]
        if len(before) == MOST_RETRIES:
            return False
        if not (before and now["is_exit"] and before[-1]["is_exit"]):
            return True
        apart = abs(now["time"] - before[-1]["time"])
        attempt, step = now["time"] - now["from_time"], self.simulation.time_step.longest
        return apart > max(SAME_TIME * attempt, 3 * step)

    def _go_back(self):
        """To the newest checkpoint, from the third retry on to the one before: the newest may have
        been written when the trouble had begun."""
        number = len(self.failures)
        self.reduction *= SHORTER
        self.checkpoint = None
        paths = checkpoints.newest_first(self.folder / "checkpoints")
        for path in paths[1:] if number > 2 and len(paths) > 1 else paths:
            with contextlib.suppress(InputError):
                self.checkpoint = checkpoints.load(path)
                break
        before = self.simulation
        if self.checkpoint is None:
            self.simulation = Simulation(
                before.scene, before.device, before.precision, before.threads_asked, self.reduction
            )
        else:
            before.restore(self.checkpoint.meta["simulation"], self.checkpoint.arrays)
            before.shorten_steps(self.reduction)
        if number == MOST_RETRIES:
            self.simulation.lookout.guard_steps = 1  # so that the first particle is named
        place = f"step {self.simulation.step_count}" if self.checkpoint else "the start"
        self.console.print(
            f"{self.failures[-1]['error']}\nretry {number} of {MOST_RETRIES}: from {place}, with "
            f"steps {self.reduction:g} times as long as the rule allows",
            soft_wrap=True,
        )
