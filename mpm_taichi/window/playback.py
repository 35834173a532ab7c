"""The simulation as start, stop, step and reset move it, and what there is to show of it."""

import time

from ..errors import InputError, MotionError, RunError
from ..walk import Stage, Walk
from .energies import Energies
from .scales import Scales

FRAMES = 300
"""Of a whole run at the speed of the start."""

FASTEST = 500
"""Steps a frame, at most."""

PATIENCE = 0.1
"""Seconds of computing between two frames, at most: buttons answer at once."""

TOGETHER = 64
"""Steps that few particles take in one go."""


class Playback:
    """`snapshot`, `energies` and `scales` are those of the last moment that was sound; `fault`
    says in words why the run has stopped for good, until `reset`; with a `walk` a step is taken
    stage by stage.  `looks_taken` counts the moments there were to show.

    The first step is taken and taken back here, so that kernels are compiled when a window opens.
    """

    def __init__(self, simulation):
        self.simulation = simulation
        fields = simulation.solver.stored
        arrays = {name: field.to_numpy() for name, field in fields.items()}
        self._start = simulation.state(), arrays
        expected = simulation.end / simulation.dt
        self.steps_per_frame = min(max(round(expected / FRAMES), 1), FASTEST)
        self.most_steps = min(max(30, 5 * self.steps_per_frame), FASTEST)
        self.walk: Walk | None = None
        self.looks_taken = 0
        self.energies, self.scales = Energies(), Scales(simulation.scene)
        self._carry_on(1)
        self.reset()

    @property
    def is_done(self) -> bool:
        return self.simulation.is_done

    def start_or_stop(self) -> None:
        self.is_running = not self.is_running and self.fault is None and not self.is_done

    def step(self) -> None:
        """Stop, and take one time step, or a stage of it."""
        self.is_running, self._asked = False, 1

    def reset(self) -> None:
        """To the start of the scene."""
        self.simulation.restore(*self._start)
        if self.walk is not None:
            self.walk = Walk(self.simulation)
        self._is_at_stage = False
        self.is_running, self._asked, self.fault = False, 0, None
        self.energies, self.scales = Energies(), Scales(self.simulation.scene)
        self._look()

    def toggle_stages(self) -> None:
        """Stop, and let `step` take stages, or no longer: then the step is finished.  2D only."""
        self.is_running = False
        if self.walk is None:
            self.walk = Walk(self.simulation)
        else:
            self._try(self._finish_step)
            self.walk = None

    def stage_of(self, particle: int) -> Stage | None:
        """Where the walk stands, for a particle; None where it has not begun or went wrong."""
        if self.walk is None or not self._is_at_stage or self.fault is not None:
            return None
        self.walk.particle = particle
        return self.walk.stage

    def go_on(self) -> None:
        """To the next moment that is shown, where the run goes on."""
        steps = self.steps_per_frame if self.is_running else self._asked
        self._asked = 0
        if steps and self.fault is None and not self.is_done:
            self._carry_on(steps)
        if self.is_done or self.fault is not None:
            self.is_running = False

    def _carry_on(self, steps):
        by_stages = self.walk is not None and not self.is_running
        self._try(self._take_stage if by_stages else lambda: self._take(steps))

    def _try(self, act):
        try:
            act()
            self._look()
        except MotionError as error:
            self.fault = f"{error}\nReset begins again; a run would try again with shorter steps."
        except (RunError, InputError) as error:
            self.fault = str(error)

    def _take(self, steps):
        self._finish_step()
        simulation, began = self.simulation, time.perf_counter()
        aim = simulation.step_count + steps
        together = TOGETHER if simulation.solver.is_whole else 1
        while simulation.step_count < aim and not simulation.is_done:
            simulation.advance(min(together, aim - simulation.step_count))
            if time.perf_counter() - began > PATIENCE:
                break

    def _take_stage(self):
        assert self.walk is not None
        self.walk.advance()
        self._is_at_stage = True

    def _finish_step(self):
        if self.walk is not None:
            self.walk.finish()
        self._is_at_stage = False

    def _look(self):
        self.snapshot = self.simulation.snapshot
        self.looks_taken += 1
        self.energies.note(self.simulation)
        self.scales.note(self.snapshot)

    def status(self) -> str:
        """In a few words."""
        if self.fault is not None:
            return "stopped: the run went wrong"
        if self.simulation.is_amid_step:
            return "amid a step"
        if self.is_done:
            return "done: reset to begin again"
        return "running" if self.is_running else "stopped"
