"""A wall that holds whatever touches it."""


class Sticky:
    """v = 0."""

    name = "sticky"
    holds = True
    lets_go = False

    @staticmethod
    def velocity(v, n):
        return 0.0 * v
