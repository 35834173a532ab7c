"""When things are due.  Steps are shortened so that they land on due times exactly."""

from math import ceil


class EverySeconds:
    """Due at 0, interval, 2 interval, ... and at the end, each reached without rounding error."""

    def __init__(self, interval: float, end: float):
        self.interval, self.end = interval, end
        self.count = ceil(end / interval - 1e-6)  # due times after 0

    def time(self, number: int) -> float:
        """The due time of a number, 0 ... count."""
        return self.end if number >= self.count else number * self.interval


def even_step(remaining: float, longest: float) -> float:
    """The longest step up to `longest` of which a whole number makes up `remaining` [s]."""
    return remaining / max(1, ceil(remaining / longest - 1e-6))
