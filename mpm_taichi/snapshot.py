"""All that a run shows of one moment, in the order of the scene and in float64."""

from dataclasses import dataclass

import numpy as np

from .kernels.evaluate import evaluate

BLOCK = 2**14
"""Particles at a time, so that what lies between the fields and a Snapshot takes little memory."""


@dataclass(frozen=True)
class Snapshot:
    """Particles at `time` [s] after `step` steps; n particles in `dim` dimensions."""

    time: float
    step: int
    position: np.ndarray  # [n, dim] m
    velocity: np.ndarray  # [n, dim] m/s
    mass: np.ndarray  # [n] kg
    initial_volume: np.ndarray  # [n] m^dim
    deformation_gradient: np.ndarray  # [n, dim, dim], of what is stored elastically if a law flows
    cauchy_stress: np.ndarray  # [n, 3, 3] Pa; in plane strain with its out-of-plane component
    energy_density: np.ndarray  # [n] J/m^3, stored, per reference volume
    volume_ratio: np.ndarray  # [n] volume by volume at the start
    plastic_strain: np.ndarray  # [n] equivalent; 0 of laws that do not flow
    # Skew part of the moments of the affine velocity, sum_i w_i m r_i (C r_i)^T:
    spin: np.ndarray  # [n, dim, dim] kg m^2/s

    @property
    def visible_position(self) -> np.ndarray:
        """[n, dim] m; NaN of particles that were deleted, which have no mass."""
        return np.where(self.mass[:, None] > 0, self.position, np.nan)

    @property
    def speed(self) -> np.ndarray:
        """[n] m/s."""
        return np.linalg.norm(self.velocity, axis=1)

    @property
    def density(self) -> np.ndarray:
        """[n] kg/m^3."""
        return self.mass / (self.initial_volume * self.volume_ratio)

    @property
    def pressure(self) -> np.ndarray:
        """- tr(sigma) / 3 [n] Pa."""
        return -np.trace(self.cauchy_stress, axis1=1, axis2=2) / 3

    @property
    def von_mises_stress(self) -> np.ndarray:
        """sqrt(3/2 dev(sigma) : dev(sigma)) [n] Pa."""
        deviator = self.cauchy_stress + self.pressure[:, None, None] * np.eye(3)
        return np.sqrt(1.5 * (deviator**2).sum(axis=(1, 2)))


def host_bytes(dim: int, real: int) -> int:
    """Per particle, the most that output takes on the host, beside the fields: a Snapshot with the
    places at the start, float64, and the table it is made from, in numbers of `real` bytes."""
    return 8 * (3 * dim + 2 * dim**2 + 14) + real * (3 * dim + 3 * dim**2 + 4)


def take_snapshot(solver, constant: dict[str, np.ndarray], time: float, step: int) -> Snapshot:
    """`constant`: `mass` and `initial_volume`, which do not change."""
    dim, n = solver.grid.dim, solver.particles.count
    values = evaluate(solver.particles, solver.grid, solver.basis)
    sizes = {
        "position": (dim,),
        "velocity": (dim,),
        "deformation_gradient": (dim, dim),
        "cauchy_stress": (3, 3),
        "energy_density": (),
        "volume_ratio": (),
        "plastic_strain": (),
        "spin": (dim, dim),
    }
    whole = {name: np.zeros((n, *size)) for name, size in sizes.items()}
    for begin in range(0, n, BLOCK):
        part = slice(begin, begin + BLOCK)
        of_part = {name: value[part].astype(float) for name, value in values.items()}
        for name, value in _derived(solver, of_part).items():
            whole[name][part] = value
    return Snapshot(time=time, step=step, **whole, **constant)


def _derived(solver, values):
    """What a Snapshot has of some particles."""
    grid, dim = solver.grid, solver.grid.dim
    F = values["H"] + np.eye(dim)
    sigma = np.zeros((len(F), 3, 3))
    sigma[:, :dim, :dim] = values["tau"]
    if dim == 2:
        sigma[:, 2, 2] = values["tau_zz"]
    sigma /= values["J"][:, None, None]
    derived = {
        "position": values["x"],
        "velocity": values["v"],
        "deformation_gradient": F,
        "cauchy_stress": sigma,
        "energy_density": values["psi"],
        "volume_ratio": values["J"],
        "plastic_strain": values["plastic_strain"],
    }
    if solver.transfer.affine:
        # A = m C, in the MLS form (where D is one number) plus a symmetric stress: no skew part.
        D = values["D"]
        if solver.transfer.moments:
            D = np.full_like(D, 1 / (solver.basis.inverse_moment or 1.0))
        moments = grid.dx**2 * D[:, :, None] * values["A"].swapaxes(1, 2)
        derived["spin"] = 0.5 * (moments - moments.swapaxes(1, 2))
    return derived
