"""stages/stage_0000.npz, ...: the stages of the step that follows each output, in 2D."""

from math import prod
from pathlib import Path

import numpy as np

from ..arrays_file import write_arrays
from ..errors import MotionError
from ..stage_formulas import stage_names
from ..walk import Stage, Walk
from .snapshots import OVERHEAD

MOVING = ("particles to nodes", "grid update", "stress")
"""Stages that leave velocities of their own at the nodes."""


def moving_stages(scene) -> tuple[str, ...]:
    """Those of a scene's method."""
    return MOVING[: 2 if scene.method.stress_update == "usl" else 3]


def stages_bytes(scene, count: int) -> int:
    """Bytes of one file, at most."""
    support, velocities = scene.method.basis_class.support, len(moving_stages(scene))
    nodes = prod(n + 1 + 2 * support for n in scene.domain.cells)
    nodes = min(nodes, count * support**scene.dimension)
    return 4 * (nodes * (2 + 2 * velocities) + 9 * count) + OVERHEAD * 7


class Stages:
    """A file for each output: the length dt [s] of the step that follows, 0 where it fails; of the
    N nodes that particles touch their place [N, 2] (x / dx), mass [N] (kg), and velocity after each
    of the `moving_stages` [stages, N, 2] (m/s); of the n particles, at the output, their
    displacement_gradient [n, 2, 2], cauchy_stress (xx, yy, xy) [n, 3] (Pa), and the gain of
    velocity in the step [n, 2] (m/s).  In float32, places in int32.

    The step is taken to see it, and then taken back."""

    every_steps = None

    def __init__(self, folder: Path, simulation, state: dict | None = None):
        folder.mkdir(exist_ok=True)
        self.folder, self.count = folder, 0 if state is None else state["count"]
        for path in folder.glob("stage_*.npz"):
            number = path.stem.removeprefix("stage_")
            if number.isdecimal() and int(number) >= self.count:
                path.unlink()

    def record(self, simulation, is_output):
        if not is_output:
            return
        dt, stages = simulation.dt, look_ahead(simulation)
        write_arrays(
            stages_path(self.folder, self.count),
            dt=np.float64(dt if stages else 0.0),
            **{
                name: values.astype(np.int32 if name == "place" else np.float32)
                for name, values in columns(simulation, stages).items()
            },
        )
        self.count += 1

    def state(self) -> dict:
        return {"count": self.count}

    def close(self):
        """Files are whole as soon as they are there."""


def stages_path(folder: Path, number: int) -> Path:
    return folder / f"stage_{number:04d}.npz"


def look_ahead(simulation) -> dict[str, Stage]:
    """The stages of the next step by name, empty where it fails.  On return the simulation is as it
    was, on a CPU to the last bit."""
    numbers = simulation.state()
    fields = {name: field.to_numpy() for name, field in simulation.solver.stored.items()}
    walk = Walk(simulation)
    try:
        return {name: walk.advance() for name in stage_names(simulation.scene)}
    except MotionError:
        return {}
    finally:
        simulation.restore(numbers, fields)


def columns(simulation, stages: dict[str, Stage]) -> dict[str, np.ndarray]:
    now, moving = simulation.snapshot, moving_stages(simulation.scene)
    xx, yy, xy = (now.cauchy_stress[:, d, e] for d, e in ((0, 0), (1, 1), (0, 1)))
    found = {
        "place": np.zeros((0, 2)), "node_mass": np.zeros(0),
        "node_velocity": np.zeros((len(moving), 0, 2)),
        "displacement_gradient": now.deformation_gradient - np.eye(2),
        "cauchy_stress": np.stack([xx, yy, xy], axis=1),
        "velocity_gain": np.zeros_like(now.velocity),
    }  # fmt: skip
    if stages:
        given = stages["particles to nodes"]
        found |= {
            "place": np.rint(given.node_position / simulation.scene.cell_size),
            "node_mass": given.node_mass,
            "node_velocity": np.stack([stages[name].node_velocity for name in moving]),
            "velocity_gain": stages["nodes to particles"].velocity - now.velocity,
        }
    return found
