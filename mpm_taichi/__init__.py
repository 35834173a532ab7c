"""Material Point Method in Taichi: scenes in YAML, 2D plane strain and 3D.

    from mpm_taichi import Simulation, load_scene
    for simulation in Simulation(load_scene("scenes/two_disks.yaml")).frames():
        print(simulation.time, simulation.snapshot.speed.max())

Importing the package starts nothing; `runtime.start` holds the one call of `ti.init`."""

import os
from typing import TYPE_CHECKING

# Read by Taichi when it is imported: no post to its version server, no banner on stdout.
os.environ.setdefault("TI_SKIP_VERSION_CHECK", "ON")
os.environ.setdefault("ENABLE_TAICHI_HEADER_PRINT", "0")

if TYPE_CHECKING:
    from .scene import Scene, load_scene
    from .simulation import Simulation

__version__ = "0.8.0"
__all__ = ["Scene", "Simulation", "__version__", "load_scene"]


def __getattr__(name):
    """The public names, imported when first used: `--help` need not wait for Taichi."""
    if name == "Simulation":
        from .simulation import Simulation

        return Simulation
    if name in ("Scene", "load_scene"):
        from . import scene

        return getattr(scene, name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
