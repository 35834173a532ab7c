"""When things are due.  Steps are shortened so that they land on due times exactly."""

from math import ceil

from .errors import InputError, MotionError

MOST = 2**53
"""Steps or outputs: a clock of 53 bits counts no more."""


class EverySeconds:
    """Due at 0, interval, 2 interval, ... and at the end, each reached without rounding error."""

    def __init__(self, interval: float, end: float):
        if not end < MOST * interval:
            raise InputError(f"output.every: {interval:g} s makes too many outputs up to {end:g} s")
        self.interval, self.end = interval, end
        self.count = ceil(end / interval - 1e-6)  # due times after 0

    def time(self, number: int) -> float:
        """The due time of a number, 0 ... count."""
        return self.end if number >= self.count else number * self.interval


def even_step(remaining: float, longest: float) -> float:
    """The longest step up to `longest` of which a whole number makes up `remaining` [s].

    MotionError where `longest` is too short to advance the clock, or no number."""
    if not remaining < MOST * longest:
        raise MotionError(
            f"the time step would be {longest:.3g} s, too short to get to the next output in "
            f"{remaining:.3g} s: the run has blown up, or the scene asks for such steps"
        )
    return remaining / max(1, ceil(remaining / longest - 1e-6))
