"""Recorders: what a run leaves behind.  A recorder reads a Simulation and never changes it:

- `record(simulation, is_output)`  called at the start and after every step; `is_output` says that
  the moment is one of the scene's output times
- `close()`                        called once, also when the run has failed
"""

from .errors import Errors
from .history import History
from .images import Images
from .paraview import ParaView
from .snapshots import Snapshots

__all__ = ["Errors", "History", "Images", "ParaView", "Snapshots"]
