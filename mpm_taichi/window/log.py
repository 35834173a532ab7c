"""The log: the numbers of the moment, particle by particle and of all, as lines of text."""

import numpy as np

from .looks import Looks
from .playback import Playback

ROWS = 12
"""Particles in the table."""

HEADING = ("particle", "mass", "velocity", "stress", "strain", "kinetic")
UNITS = ("", "[kg]", "[m/s]", "[Pa]", "[-]", "[J]")


def green_strain(F: np.ndarray) -> np.ndarray:
    """E = (F^T F - I) / 2 [..., dim, dim]."""
    return 0.5 * (np.swapaxes(F, -1, -2) @ F - np.eye(F.shape[-1]))


def number(value) -> str:
    return f"{value:.4g}"


def vector(values) -> str:
    return f"({', '.join(map(number, values))})"


def table(snapshot, first: int, picked: int | None) -> list[str]:
    """A heading, a row for all particles, and those of ROWS particles from `first` on: von Mises
    stress, norm |E| of Green's strain, of what is stored elastically if a law flows."""
    kinetic = 0.5 * snapshot.mass * snapshot.speed**2
    rows = [
        HEADING,
        UNITS,
        ("all", number(snapshot.mass.sum()), "", "", "", number(kinetic.sum())),
    ]
    some = range(first, min(first + ROWS, len(kinetic)))
    stress = snapshot.von_mises_stress
    for p in some:
        E = green_strain(snapshot.deformation_gradient[p])
        rows.append((
            f"{'>' if p == picked else ''}{p}", number(snapshot.mass[p]),
            vector(snapshot.velocity[p]), number(stress[p]), number(np.linalg.norm(E)),
            number(kinetic[p]),
        ))  # fmt: skip
    widths = (8, 10, 12 * snapshot.velocity.shape[1], 10, 10, 10)
    return [
        " ".join(word.rjust(width) for word, width in zip(row, widths, strict=True)) for row in rows
    ]


def components(matrix: np.ndarray, dim: int) -> str:
    """Of a symmetric matrix, xx first; in 2D without those that are 0."""
    names = "xx", "yy", "zz", "xy", *(("yz", "zx") if dim == 3 else ())
    at = {name: ("xyz".index(name[0]), "xyz".index(name[1])) for name in names}
    return ", ".join(
        f"{name} {number(matrix[place])}" for name, place in at.items() if max(place) < len(matrix)
    )


def details(playback: Playback, picked: int) -> list[str]:
    """All numbers of one particle."""
    snapshot, dim = playback.snapshot, playback.snapshot.position.shape[1]
    E = green_strain(snapshot.deformation_gradient[picked])
    return [
        f"{playback.simulation.describe_particle(picked)} at {vector(snapshot.position[picked])} m",
        f"density {number(snapshot.density[picked])} kg/m^3, "
        f"plastic strain {number(snapshot.plastic_strain[picked])}",
        f"stress [Pa] {components(snapshot.cauchy_stress[picked], dim)}",
        f"strain [-] {components(E, dim)}",
    ]


def log_lines(playback: Playback, looks: Looks) -> list[str]:
    simulation, energies = playback.simulation, playback.energies
    sums = ", ".join(f"{name} {number(values[-1])}" for name, values in energies.curves().items())
    lines = [
        f"step {playback.snapshot.step}, t = {playback.snapshot.time:.6g} s, "
        f"dt = {simulation.last_dt or simulation.dt:.3g} s",
        f"energy [J]: {sums}",
    ]
    if looks.picked is not None:
        lines += details(playback, looks.picked)
    return lines + table(playback.snapshot, looks.first, looks.picked)
