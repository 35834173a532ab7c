"""The two ways in which a run can end badly; the command line turns each into its exit code."""


class InputError(Exception):
    """What the user gave cannot be run.  Exit code 2."""


class RunError(Exception):
    """The run started and failed.  Exit code 1."""
