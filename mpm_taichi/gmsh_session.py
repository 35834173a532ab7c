"""gmsh, started so that the rest of the program does not notice."""

import os
import signal
from contextlib import contextmanager, suppress

from .errors import InputError

SYSTEM_LIBRARIES = (
    "libglu1-mesa libgl1 libxrender1 libxcursor1 libxfixes3 libxft2 libxinerama1 libgomp1 "
    "libx11-6 libfontconfig1"
)
# PETSc inside gmsh would obey a .petscrc of the current folder; -v 0 hides that gmsh wonders at it
ARGUMENTS = ["gmsh", "-v", "0", "-skip_petscrc"]


@contextmanager
def gmsh_session():
    """The module gmsh, started with an empty model and ended in any case.

    Silent, on one thread, blind to configuration files; it writes none, and Ctrl-C stays ours."""
    try:
        import gmsh
    except ImportError as error:
        raise InputError("meshing needs the package gmsh: pip install gmsh") from error
    except OSError as error:
        raise InputError(
            f"gmsh lacks a library of the system ({error}); on Debian and Ubuntu: "
            f"apt-get install {SYSTEM_LIBRARIES}"
        ) from error
    if gmsh.isInitialized():
        raise InputError("gmsh is in use in this process: call gmsh.finalize() first")
    with _no_home():
        # interruptible=True would give SIGINT back to the system, for good
        gmsh.initialize(ARGUMENTS, readConfigFiles=False, interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.option.setNumber("General.NumThreads", 1)
        yield gmsh
    finally:
        gmsh.finalize()
        _raise_at_broken_pipes()


def _raise_at_broken_pipes():
    """gmsh lets a pipe whose reader has gone end the process without a word; Python has it raise
    BrokenPipeError."""
    with suppress(AttributeError, ValueError):  # no such signal; not the main thread
        signal.signal(signal.SIGPIPE, signal.getsignal(signal.SIGPIPE))


@contextmanager
def _no_home():
    """FLTK inside gmsh would write $HOME/.fltk."""
    home = os.environ.get("HOME")
    os.environ["HOME"] = os.devnull
    try:
        yield
    finally:
        del os.environ["HOME"]
        if home is not None:
            os.environ["HOME"] = home
