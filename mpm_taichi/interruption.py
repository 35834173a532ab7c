"""Ctrl-C and SIGTERM: the run stops between two steps, and what it has is kept."""

import contextlib
import signal
import sys


class Interrupted(Exception):  # noqa: N818 - a wish of the user's, no error
    """A signal asked the run to stop; the exit code is 128 + its number.  `is_between`: the run
    stands between two steps, so that its state is whole."""

    def __init__(self, number: int, is_between: bool):
        super().__init__(signal.Signals(number).name)
        self.exit_code, self.is_between = 128 + number, is_between


class Interruption:
    """A recorder that ends the run between two steps after Ctrl-C or SIGTERM, so that results and
    report are whole.  A second signal acts at once."""

    every_steps = None

    def __init__(self):
        self.simulation = None

    def __enter__(self):
        self.number, self.before = None, {}
        for number in (signal.SIGINT, signal.SIGTERM):
            with contextlib.suppress(ValueError):  # not the main thread: signals are another's
                self.before[number] = signal.signal(number, self._note)
        return self

    def __exit__(self, *_):
        for number, handler in self.before.items():
            signal.signal(number, handler)

    def watch(self, simulation) -> None:
        """The next signal stops this one."""
        self.simulation = simulation

    def _note(self, number, _frame):
        if self.number is not None:
            raise Interrupted(number, is_between=False)
        self.number = number
        if self.simulation is not None:
            self.simulation.stop_asked = True
            print(f"{signal.Signals(number).name}: finishing the step ...", file=sys.stderr)

    def record(self, simulation, is_output):
        if self.number is not None:
            raise Interrupted(self.number, is_between=True)
        self.watch(simulation)
