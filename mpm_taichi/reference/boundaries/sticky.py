"""A wall that holds whatever touches it."""


class Sticky:
    """v = 0."""

    name = "sticky"

    @staticmethod
    def velocity(v, n):
        return 0.0 * v
