"""All that a run shows of one moment, in the order of the scene and in float64."""

from dataclasses import dataclass

import numpy as np

from .kernels.evaluate import evaluate


@dataclass(frozen=True)
class Snapshot:
    """Particles at `time` [s] after `step` steps; n particles in `dim` dimensions."""

    time: float
    step: int
    position: np.ndarray  # [n, dim] m
    velocity: np.ndarray  # [n, dim] m/s
    mass: np.ndarray  # [n] kg
    initial_volume: np.ndarray  # [n] m^dim
    deformation_gradient: np.ndarray  # [n, dim, dim]
    cauchy_stress: np.ndarray  # [n, 3, 3] Pa; in plane strain with its out-of-plane component
    energy_density: np.ndarray  # [n] J/m^3, elastic, per reference volume
    # Skew part of the moments of the affine velocity, sum_i w_i m r_i (C r_i)^T:
    spin: np.ndarray  # [n, dim, dim] kg m^2/s

    @property
    def speed(self) -> np.ndarray:
        """[n] m/s."""
        return np.linalg.norm(self.velocity, axis=1)

    @property
    def pressure(self) -> np.ndarray:
        """- tr(sigma) / 3 [n] Pa."""
        return -np.trace(self.cauchy_stress, axis1=1, axis2=2) / 3

    @property
    def von_mises_stress(self) -> np.ndarray:
        """sqrt(3/2 dev(sigma) : dev(sigma)) [n] Pa."""
        deviator = self.cauchy_stress + self.pressure[:, None, None] * np.eye(3)
        return np.sqrt(1.5 * (deviator**2).sum(axis=(1, 2)))


def take_snapshot(solver, constant: dict[str, np.ndarray], time: float, step: int) -> Snapshot:
    """`constant`: `mass` and `initial_volume`, which do not change."""
    grid, dim = solver.grid, solver.grid.dim
    values = evaluate(solver.particles, grid, solver.basis)
    F = values["H"] + np.eye(dim)
    sigma = np.zeros((len(F), 3, 3))
    sigma[:, :dim, :dim] = values["tau"]
    if dim == 2:
        sigma[:, 2, 2] = values["tau_zz"]
    sigma /= np.linalg.det(F)[:, None, None]
    spin = np.zeros_like(F)
    if solver.transfer.affine:
        # A = m C, in the MLS form (where D is one number) plus a symmetric stress: no skew part.
        D = values["D"]
        if solver.transfer.moments:
            D = np.full_like(D, 1 / (solver.basis.inverse_moment or 1.0))
        moments = grid.dx**2 * D[:, :, None] * values["A"].swapaxes(1, 2)
        spin = 0.5 * (moments - moments.swapaxes(1, 2))
    return Snapshot(
        time=time,
        step=step,
        position=values["x"],
        velocity=values["v"],
        deformation_gradient=F,
        cauchy_stress=sigma,
        energy_density=values["psi"],
        spin=spin,
        **constant,
    )
