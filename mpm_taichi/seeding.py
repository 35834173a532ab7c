"""Bodies of a scene to points, with a report of what sampling made of them."""

from dataclasses import dataclass

import numpy as np

from .errors import InputError
from .points import Points
from .sampling import LARGEST_LATTICE, Lattice


@dataclass(frozen=True)
class SeedingReport:
    """Volumes in m^dim; `dataclasses.asdict` gives plain numbers, ready for JSON."""

    name: str
    particles: int
    volume: float
    exact_volume: float | None
    volume_error: float | None
    smallest_volume: float
    largest_volume: float
    particles_per_cell: float
    fewest_per_cell: int

    def describe(self) -> str:
        """One line."""
        exact = ""
        if self.exact_volume is not None and self.volume_error is not None:
            exact = f" of {self.exact_volume:.5g} ({100 * self.volume_error:+.2f} %)"
        particles = f"{self.particles} particle" + "s" * (self.particles != 1)
        return (
            f"{self.name}: {particles}, volume {self.volume:.5g}{exact}, "
            f"smallest {self.smallest_volume:.2g}, "
            f"{self.particles_per_cell:.1f} particles per cell (least {self.fewest_per_cell})"
        )


def expected_counts(scene) -> list[int]:
    """About how many particles each body will have, V / h^dim: of lattices with a number that can
    be; 0 of meshes, whose number is known when they are made."""
    counts = []
    for body in scene.bodies:
        count = 0.0
        if isinstance(body.particles, Lattice) and body.shape is not None:
            with np.errstate(all="ignore"):
                h = np.float64(body.particles.distance(scene.cell_size))
                count = np.float64(body.shape.volume()) / h**scene.dimension
        counts.append(round(count) if count <= LARGEST_LATTICE else 0)
    return counts


def seed(scene) -> tuple[list[Points], list[SeedingReport]]:
    """Points and report of each body of a Scene; points outside the domain are an InputError."""
    points, reports = [], []
    for index, body in enumerate(scene.bodies):
        key = f"bodies[{index}].particles"
        try:
            mine = body.particles.points(body.shape, scene.cell_size, scene.dimension)
        except InputError as error:
            raise InputError(f"{key} ({body.name}): {error}") from None
        except MemoryError:
            raise InputError(f"{key} ({body.name}): the points do not fit into memory") from None
        refuse_outside(mine.x, key, body.name, scene.domain)
        exact = None if body.shape is None else body.shape.volume()
        points.append(mine)
        reports.append(seeding_report(body.name, mine, scene.cell_size, exact))
    return points, reports


def refuse_outside(x: np.ndarray, key: str, name: str, domain) -> None:
    """InputError where places x [n, dim] are outside, except along periodic axes."""
    kept = [axis for axis in range(domain.dimension) if axis not in domain.periodic]
    outside = ((x < 0) | (x > np.array(domain.size)))[:, kept].any(axis=1)
    if outside.any():
        first = [float(f"{value:.6g}") for value in x[outside][0]]
        raise InputError(
            f"{key}: {outside.sum()} of {len(x)} particles of {name} lie outside the domain "
            f"{domain.size}, the first at {first}"
        )


def seeding_report(
    name: str, points: Points, cell_size: float, exact_volume: float | None
) -> SeedingReport:
    """The volume error is sum(V0) / exact - 1; cells without particles do not count."""
    volume = float(points.V0.sum())
    per_cell = _particles_in_cells(np.floor(points.x / cell_size))
    return SeedingReport(
        name=name,
        particles=len(points.V0),
        volume=volume,
        exact_volume=exact_volume,
        volume_error=None if exact_volume is None else volume / exact_volume - 1,
        smallest_volume=float(points.V0.min()),
        largest_volume=float(points.V0.max()),
        particles_per_cell=float(per_cell.mean()),
        fewest_per_cell=int(per_cell.min()),
    )


def _particles_in_cells(cells: np.ndarray) -> np.ndarray:
    """How often each distinct row of `cells` [n, dim] occurs."""
    rows = cells[np.lexsort(cells.T)]
    starts = np.flatnonzero(np.r_[True, (rows[1:] != rows[:-1]).any(axis=1), True])
    return np.diff(starts)
