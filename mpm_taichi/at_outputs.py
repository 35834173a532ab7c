"""Plain functions as recorders: `simulation.run([print_energy])`."""

from collections.abc import Callable
from typing import Any

from .errors import InputError


class AtOutputs:
    """A recorder that calls `function(simulation)` at the start and at every output."""

    every_steps = None

    def __init__(self, function: Callable):
        self.function = function

    def record(self, simulation, is_output):
        if is_output:
            self.function(simulation)


def as_recorder(one: Any) -> Any:
    """A recorder as it is, a function as one.  InputError for what is neither."""
    if hasattr(one, "record"):
        return one
    if callable(one):
        return AtOutputs(one)
    raise InputError(
        "run: a recorder is a function of the simulation, or an object with "
        f"record(simulation, is_output) (got {one!r})"
    )
