"""paraview/particles.pvd: each output for ParaView, which can open it while the run goes on."""

from math import prod
from pathlib import Path

import numpy as np

from ..kernels.blocks import CHUNK
from ..vtk_files import (
    Column,
    scalar,
    symmetric_tensor,
    tensor,
    vector,
    whole,
    write_pvd,
    write_vti,
    write_vtp,
)
from .snapshots import has_plastic_strain

PER_PARTICLE, PER_NODE, HEADER = 128, 16, 2500
"""Bytes of a file, in 2D and 3D."""

LABELS = {
    "pressure": "pressure [Pa]",
    "stress": "von Mises stress [Pa]",
    "density": "density [kg/m^3]",
    "plastic_strain": "equivalent plastic strain [-]",
}


def paraview_bytes(scene, count: int) -> int:
    """Bytes of one output, to a few hundred."""
    particles = PER_PARTICLE * count + HEADER
    if not getattr(scene.output.paraview, "grid", False):
        return particles
    return particles + PER_NODE * prod(n + 1 for n in scene.domain.cells) + HEADER


class ParaView:
    """A .vtp file of particles for each output and, if asked, a .vti file of the nodes for each
    after the start, with the mass and velocity that they had in the step that led there.

    A series holds only files that are whole; it is written anew after each, as a whole."""

    every_steps = None

    def __init__(self, folder: Path, simulation, with_grid: bool, state: dict | None = None):
        folder.mkdir(exist_ok=True)
        count = 0 if state is None else state["count"]
        self.series = [Series(folder, "particles", ".vtp")]
        if with_grid:
            self.series.append(Series(folder, "grid", ".vti"))
        for series in self.series:
            series.begin([simulation.outputs.time(number) for number in range(count)])

    def record(self, simulation, is_output):
        if not is_output:
            return
        particles, *grid = self.series
        now = simulation.snapshot
        with np.errstate(invalid="ignore"):  # of what was deleted, and is not written
            density = now.density
        scalars = {
            "pressure": now.pressure,
            "stress": now.von_mises_stress,
            "density": density,
        }
        if has_plastic_strain(simulation.scene):
            scalars["plastic_strain"] = now.plastic_strain
        there = visible(now.visible_position)
        columns = [
            *particle_columns(there, simulation.body_of_particle, now, scalars),
            symmetric_tensor("Cauchy stress [Pa]", now.cauchy_stress[there]),
            tensor("deformation gradient [-]", now.deformation_gradient[there]),
            scalar("elastic energy density [J/m^3]", now.energy_density[there]),
            scalar("volume ratio [-]", now.volume_ratio[there]),
        ]
        write_vtp(particles.next_path, now.time, now.position[there], columns)
        particles.add(now.time)
        for series in grid:
            if simulation.step_count > 0:
                nodes, columns = node_columns(simulation.solver.grid)
                write_vti(series.next_path, now.time, nodes, simulation.scene.cell_size, columns)
            series.add(now.time)

    def state(self) -> dict:
        return {"count": len(self.series[0].times)}

    def close(self):
        """Files are whole as soon as they are there."""


class Series:
    """Numbered files and the .pvd that lists those that are there."""

    def __init__(self, folder: Path, stem: str, suffix: str):
        self.folder, self.stem, self.suffix = folder, stem, suffix
        self.times: list[float] = []

    @property
    def next_path(self) -> Path:
        return self._path(len(self.times))

    def begin(self, times: list[float]) -> None:
        """Go on after files of these times [s]; later ones, of a run that was cut off, go."""
        self.times = times
        self._list()
        known = {self._path(number) for number in range(len(times))}
        for path in self.folder.glob(f"{self.stem}_*{self.suffix}"):
            if path not in known:
                path.unlink()

    def add(self, time: float) -> None:
        """What is at `next_path`, if something is, belongs to the series."""
        self.times.append(time)
        self._list()

    def _list(self):
        paths = ((time, self._path(number)) for number, time in enumerate(self.times))
        there = [(time, path.name) for time, path in paths if path.exists()]
        write_pvd(self.folder / f"{self.stem}.pvd", there)

    def _path(self, number):
        return self.folder / f"{self.stem}_{number:04d}{self.suffix}"


def visible(position: np.ndarray) -> slice | np.ndarray:
    """Selects the particles that have a place, which those that were deleted do not: with such
    ParaView would show nothing at all."""
    gone = np.isnan(position[:, 0])
    return ~gone if gone.any() else slice(None)


def particle_columns(there, body: np.ndarray, now, scalars: dict[str, np.ndarray]) -> list[Column]:
    """Of the particles `there`, at a moment with velocity and mass, and `scalars` by the names of
    LABELS."""
    return [
        whole("id", np.arange(len(body))[there]),
        whole("body", body[there]),
        scalar("mass [kg]", now.mass[there]),
        vector("velocity [m/s]", now.velocity[there]),
        *(scalar(label, scalars[name][there]) for name, label in LABELS.items() if name in scalars),
    ]


def node_columns(grid) -> tuple[list[int], list[Column]]:
    """Nodes along each axis of the closed domain, and their mass and velocity.  Nodes that no
    particle can reach, where old values lie, are 0."""
    node = grid.node.to_numpy()
    reached = np.zeros(grid.mask + 1, bool)
    chunks = grid.active.to_numpy()[: grid.active_count[None]]
    reached.reshape(-1, CHUNK)[chunks] = True
    lanes = np.where(reached[: grid.nodes, None], node[: grid.nodes], 0)
    inner = tuple(slice(grid.ghost, grid.ghost + count + 1) for count in grid.cells)
    # x side by side, as VTK has it: axes in reverse
    lanes = lanes.reshape(*grid.extent, 4)[inner].transpose(*reversed(range(grid.dim)), grid.dim)
    lanes = lanes.reshape(-1, 4)
    columns = [
        scalar("mass [kg]", lanes[:, grid.dim]), vector("velocity [m/s]", lanes[:, : grid.dim])
    ]  # fmt: skip
    return [count + 1 for count in grid.cells], columns
