"""Recorders: what a run leaves behind.  A recorder reads a Simulation and never changes it:

- `record(simulation, is_output)`  called at the start and after every step; `is_output` says that
  the moment is one of the scene's output times
- `state()`                        what a checkpoint keeps, to be written as JSON: with it as the
                                   last argument, and its files as they are on the disk, a later
                                   recorder goes on where this one was
- `close()`                        called once, also when the run has failed
"""

from .errors import Errors
from .history import History
from .images import Images
from .keeper import Keeper
from .paraview import ParaView
from .snapshots import Snapshots
from .stages import Stages

__all__ = ["Errors", "History", "Images", "Keeper", "ParaView", "Snapshots", "Stages"]
