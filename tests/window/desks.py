"""Desks to test: two disks of a lattice, which other tests have compiled already."""

from pathlib import Path

import numpy as np

from mpm_taichi import Simulation, load_scene
from mpm_taichi.window.desk import Desk
from tests.command_line import SCENES

SCENE = SCENES / "two_disks_lattice.yaml"
SIZE = 1280, 800


def simulation(*changes: str) -> Simulation:
    return Simulation(load_scene(SCENE, list(changes)), "cpu", None, 1)


def desk_in(folder: Path, *changes: str) -> Desk:
    return Desk(simulation(*changes), "disks", folder, *SIZE)


def fields(simulation) -> dict[str, np.ndarray]:
    """All that a checkpoint would keep."""
    return {name: field.to_numpy() for name, field in simulation.solver.stored.items()}


def stored(simulation) -> dict[str, bytes]:
    """To the last bit."""
    return {name: values.tobytes() for name, values in fields(simulation).items()}
