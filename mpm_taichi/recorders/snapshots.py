"""snapshots/snapshot_0000.npz, ...: the particles at each output."""

from pathlib import Path

import numpy as np

from ..arrays_file import write_arrays
from ..kernels.record import record
from ..materials.law import MaterialLaw

SCALARS = ("pressure", "stress", "density")
"""Of each particle, by their names in `output.images.color_by`; where a law has it plastic_strain
too."""

MOST_UNASKED = 200_000
"""Particles up to which snapshots are recorded where the scene says nothing of them."""

OVERHEAD = 256
"""Bytes that an array takes in a file beside its numbers, at most: 128 for its own header, the rest
for its two entries in the archive."""


def wants_snapshots(scene, count: int) -> bool:
    """What the scene says; by default yes up to MOST_UNASKED particles."""
    said = scene.output.snapshots
    return count <= MOST_UNASKED if said is None else said


def has_plastic_strain(scene) -> bool:
    """Whether a body is of a law that adds up plastic strain."""
    laws = {type(scene.materials[body.material]) for body in scene.bodies}
    return any(law.plastic_strain is not MaterialLaw.plastic_strain for law in laws)


def snapshot_bytes(scene, count: int) -> int:
    """Bytes of one file, to a few hundred."""
    scalars = len(SCALARS) + has_plastic_strain(scene)
    return 4 * count * (2 * scene.dimension + scalars) + OVERHEAD * (4 + scalars)


class Snapshots:
    """A file for each output: time [s], step, position [n, dim] (m), velocity [n, dim] (m/s),
    pressure, stress (von Mises) [n] (Pa), density [n] (kg/m^3) and, where a law has it, the
    equivalent plastic_strain [n], in float32 and in the order of the scene, the position nan of
    particles that were deleted; and once particles.npz: body (index) [n], mass [n] (kg),
    initial_volume [n] (m^dim).

    Each file appears whole.  `mpm_taichi.recording.Recording` reads them."""

    every_steps = None

    def __init__(self, folder: Path, simulation, state: dict | None = None):
        folder.mkdir(exist_ok=True)
        self.folder, self.count = folder, 0 if state is None else state["count"]
        self.plastic = has_plastic_strain(simulation.scene)
        for number, path in numbered(folder):
            if number >= self.count:
                path.unlink()
        if state is None:
            self._write_particles(simulation)

    def record(self, simulation, is_output):
        if not is_output:
            return
        arrays = record(simulation.solver.particles, self.plastic)
        if not all(np.isfinite(values).all() for values in arrays.values()):
            _ = simulation.snapshot  # names the particle that is no number
        gone = simulation.is_deleted
        if gone.any():
            arrays["position"][gone] = np.nan
            arrays["density"][gone] = np.nan
        write_arrays(
            self.folder / f"snapshot_{self.count:04d}.npz",
            time=np.float64(simulation.time),
            step=np.int64(simulation.step_count),
            **arrays,
        )
        self.count += 1

    def _write_particles(self, simulation):
        bodies, now = len(simulation.scene.bodies), simulation.snapshot
        write_arrays(
            self.folder / "particles.npz",
            body=simulation.body_of_particle.astype(np.min_scalar_type(bodies)),
            mass=now.mass.astype(np.float32),
            initial_volume=now.initial_volume.astype(np.float32),
        )

    def state(self) -> dict:
        return {"count": self.count}

    def close(self):
        """Files are whole as soon as they are there."""


def numbered(folder: Path) -> list[tuple[int, Path]]:
    """The snapshots in a folder with their numbers, in order."""
    found = ((path.stem.removeprefix("snapshot_"), path) for path in folder.glob("snapshot_*.npz"))
    return sorted((int(number), path) for number, path in found if number.isdecimal())
