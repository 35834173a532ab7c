"""Reads back what a run has recorded, also while it goes on.

recording = Recording("runs/two_disks-001")
for frame in recording:
    print(frame.time, frame.scalars["speed"].max())"""

import zipfile
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

from .errors import InputError
from .history_table import read_history
from .notebook import inline_player
from .recorders.snapshots import SCALARS, numbered
from .recorders.stages import moving_stages, stages_path
from .run_folder import read_report
from .scene import Scene, load_scene

DAMAGED = (zipfile.BadZipFile, OSError, EOFError, ValueError, KeyError, NotImplementedError)
"""What NumPy raises for a file that is cut off, changed, or something else."""


@dataclass(frozen=True, eq=False)
class RecordedFrame:
    """The n particles of one output, in the order of the scene, in float32."""

    time: float  # s
    step: int
    position: np.ndarray  # [n, dim] m; nan of particles that were deleted
    velocity: np.ndarray  # [n, dim] m/s
    mass: np.ndarray  # [n] kg
    scalars: dict[str, np.ndarray]
    """[n] each, by the names of `output.images.color_by`: speed [m/s], pressure and von Mises
    stress [Pa], density [kg/m^3]; plastic_strain [-] where a law of the scene has it."""

    @property
    def kinetic_energy(self) -> np.ndarray:
        """[n] J; 0 of particles that were deleted."""
        gone = np.isnan(self.position[:, 0])
        return np.where(gone, 0, 0.5 * self.mass * self.scalars["speed"] ** 2)


@dataclass(frozen=True, eq=False)
class RecordedStages:
    """The step that follows a frame, in float32: recorders/stages.py says what is what."""

    dt: float  # s, 0 where the step failed or the run ended before it
    place: np.ndarray  # [N, 2], int32
    node_mass: np.ndarray  # [N] kg
    node_velocity: np.ndarray  # [moving stages, N, 2] m/s
    displacement_gradient: np.ndarray  # [n, 2, 2]
    cauchy_stress: np.ndarray  # [n, 3] Pa
    velocity_gain: np.ndarray  # [n, 2] m/s


class Recording:
    """The frames of a run folder: `len(recording)`, `recording[k]`, `for frame in recording`.

    A frame is read when it is asked for.  InputError where the folder is no run, has no snapshots,
    or a file of it is damaged."""

    def __init__(self, folder: str | Path):
        self.folder = Path(folder)
        self.report = read_report(self.folder)
        found = numbered(self.folder / "snapshots")
        if not found:
            raise InputError(
                f"{self.folder}: no particles were recorded; run the scene again with\n  python -m "
                f"mpm_taichi run {self.folder / 'scene.yaml'} --set output.snapshots=true"
            )
        for place, (number, path) in enumerate(found):
            if number != place:
                missing = path.with_name(f"snapshot_{place:04d}.npz")
                raise _damaged(missing, "it is missing, and there are later ones")
        self._paths = [path for _, path in found]

    def __len__(self) -> int:
        return len(self._paths)

    def __getitem__(self, number: int) -> RecordedFrame:
        path = self._paths[number]
        arrays = _read(path)
        n, dim = len(self.body), self.scene.dimension
        shapes = {"time": (), "step": (), "position": (n, dim), "velocity": (n, dim)}
        shapes |= dict.fromkeys((*SCALARS, *(arrays.keys() - shapes.keys())), (n,))
        if {name: values.shape for name, values in arrays.items()} != shapes:
            raise _damaged(path, f"it does not hold {n} particles in {dim}D")
        time, step, position, velocity = (arrays.pop(name) for name in list(shapes)[:4])
        speed = np.linalg.norm(velocity, axis=1)
        return RecordedFrame(
            float(time), int(step), position, velocity, self.mass, {"speed": speed, **arrays}
        )

    @property
    def has_stages(self) -> bool:
        """Whether the scene asked for them."""
        return self.scene.output.stages

    def stages(self, number: int) -> RecordedStages:
        """Of the step that follows a frame, where the run `has_stages`."""
        path = stages_path(self.folder / "stages", number)
        arrays = _read(path) if path.exists() else {}
        n, nodes = len(self.body), len(arrays.get("place", ()))
        shapes = {
            "dt": (), "place": (nodes, 2), "node_mass": (nodes,),
            "node_velocity": (len(moving_stages(self.scene)), nodes, 2),
            "displacement_gradient": (n, 2, 2), "cauchy_stress": (n, 3), "velocity_gain": (n, 2),
        }  # fmt: skip
        arrays = arrays or {name: np.zeros(shape) for name, shape in shapes.items()}
        if {name: values.shape for name, values in arrays.items()} != shapes:
            raise _damaged(path, f"it does not hold the stages of {n} particles")
        return RecordedStages(float(arrays.pop("dt")), **arrays)

    def __iter__(self) -> Iterator[RecordedFrame]:
        return (self[number] for number in range(len(self)))

    def _repr_html_(self) -> str:
        """What a notebook shows of it: the player (notebook.py)."""
        return inline_player(self)

    @cached_property
    def times(self) -> np.ndarray:
        """[frames] s."""
        return np.array([_read(path, ["time"])["time"] for path in self._paths], float)

    @cached_property
    def scene(self) -> Scene:
        return load_scene(self.folder / "scene.yaml")

    @cached_property
    def history(self) -> dict[str, np.ndarray]:
        """The columns of history.csv by name."""
        return read_history(self.folder / "history.csv")

    @property
    def body_names(self) -> list[str]:
        return [body.name for body in self.scene.bodies]

    @property
    def body(self) -> np.ndarray:
        """[n] index into body_names."""
        return self._particles["body"]

    @property
    def mass(self) -> np.ndarray:
        """[n] kg, float32."""
        return self._particles["mass"]

    @property
    def initial_volume(self) -> np.ndarray:
        """[n] m^dim, float32."""
        return self._particles["initial_volume"]

    @cached_property
    def _particles(self):
        path = self.folder / "snapshots" / "particles.npz"
        names = ["body", "mass", "initial_volume"]
        arrays = _read(path, names)
        if len({values.shape for values in arrays.values()}) != 1 or arrays["body"].ndim != 1:
            raise _damaged(path, "its arrays differ in length")
        return arrays


def _read(path: Path, names: list[str] | None = None) -> dict[str, np.ndarray]:
    """Arrays of a file by name, all or some, checked by their check sums."""
    try:
        with np.load(path, allow_pickle=False) as file:
            return {name: file[name] for name in (file.files if names is None else names)}
    except DAMAGED as error:
        raise _damaged(path, str(error)) from None


def _damaged(path: Path, why: str) -> InputError:
    return InputError(f"{path}: the recording is damaged ({why}); run the scene again")
