"""Many bars in one run, each in a row of cells of its own: a scheme costs one run instead of 24.

The equations have no length but those of bar and cell, so bars of 10, 20 and 40 cells in one grid
are one bar in three grids, and dt = 0.2 dx / c suits all.  A row of particles with nu = 0 that
moves along x is a 1D problem though nodes on both sides of it are free: their masses, momenta and
forces are those of the strip times a weight across the row, which drops out of the velocities."""

import numpy as np

from mpm_taichi import Simulation, load_scene
from mpm_taichi.errors import RunError
from mpm_taichi.scene import Scene
from tests.command_line import SCENES
from tests.exact_motion import distances

NUMBERS = (10, 20, 40)
"""N, cells per bar."""

OFFSETS = (0, 0.25, 0.5, 0.75)
"""Of the particles [cells]."""

AMPLITUDE = {"free_bar": 0.05 / np.pi, "periodic_bar": 0.05}
"""Largest displacement [bar lengths]."""

DX = 1 / max(NUMBERS)
APART = (
    4  # cells from row to row: no two share a node, as a stencil has one in front and two behind
)
N = np.repeat(NUMBERS[::-1], 2 * len(OFFSETS))  # of each row
C = 10.0


def rows_of(name: str, method: str, start: float = 0.0) -> Scene:
    """The scene `free_bar` or `periodic_bar` with a bar in each row: N = 40, 20, 10, of each at
    rest and riding at V = 1 = c / 10, of each the offsets, which begin at `start` cells."""
    given = load_scene(SCENES / f"{name}.yaml")
    row = f"floor(Y / {APART * DX})"
    rest_of = {n: f"({row} - {n} * floor({row} / {n}))" for n in (4, 8)}
    bodies = [
        given.bodies[0].model_dump(exclude_unset=True)
        | {"name": f"bar {k}", "shape": _cells_of_bar(name, k)}
        for k in range(len(N))
    ]
    width = round(given.domain.size[0] / DX)
    changes = [
        f"domain.size={[width * DX, len(N) * APART * DX]}",
        f"domain.cells={[width, len(N) * APART]}",
        f"definitions.L=where({row} < 8, 1, where({row} < 16, 0.5, 0.25))",
        f"definitions.V=where({rest_of[8]} < 4, 0, 1)",
        f"definitions.shift=({rest_of[4]} / {len(OFFSETS)} + {start}) * {DX}",
        f"bodies={bodies}",
        f"method={method}",
        f"time={{end: 0.25, step: {0.2 * DX / C}}}",
        "output={every: 0.00625, images: none}",
    ]
    return load_scene(SCENES / f"{name}.yaml", changes)


def _cells_of_bar(name: str, k: int) -> dict:
    """The free bar as long as N cells, the periodic one as often as it fits."""
    left, length = (0.5, int(N[k]) * DX) if name == "free_bar" else (0.0, 1.0)
    low, high = [left, APART * k * DX], [left + length, (APART * k + 1) * DX]
    return {"type": "box", "min": low, "max": high}


def errors(name: str, method: str, start: float = 0.0) -> np.ndarray:
    """Root mean square of the error of u over the amplitude, [at rest, riding] x [N = 10, 20, 40]:
    the largest of all offsets and of t = 1.125 T and 1.25 T, T = 2 L / c; infinite for bars whose
    time had not come when the run failed."""
    simulation = Simulation(rows_of(name, method, start))
    bar, L = simulation.body_of_particle, N * DX
    worst, seen = np.zeros(len(N)), np.zeros(len(N))
    try:
        for now in simulation.frames():
            due = np.isclose(now.time * C / L, 2.25) | np.isclose(now.time * C / L, 2.5)
            if due.any():
                off = distances(now)[:, 0]
                error = np.sqrt(np.bincount(bar, off**2) / np.bincount(bar))
                worst[due] = np.maximum(worst, error / L / AMPLITUDE[name])[due]
                seen += due
    except RunError as failure:
        print(failure)
    worst[seen < 2] = np.inf
    return worst.reshape(len(NUMBERS), 2, len(OFFSETS)).max(axis=2).T[:, ::-1]
