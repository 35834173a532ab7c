"""The two ways in which a run can end badly; the command line turns each into its exit code."""


class InputError(Exception):
    """What the user gave cannot be run.  Exit code 2."""


class RunError(Exception):
    """The run started and failed.  Exit code 1."""


class MotionError(RunError):
    """The motion went wrong, and might not with shorter steps.  `particle` is that which showed it,
    by its place in the scene, or None; `is_exit`: it has left the domain, which may be right."""

    def __init__(self, text: str, particle: int | None = None, is_exit: bool = False):
        super().__init__(text)
        self.particle, self.is_exit = particle, is_exit
