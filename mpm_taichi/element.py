"""A law along given deformations, without a grid: what a single element tells of a material."""

from typing import NamedTuple

import numpy as np

from .kernels.follow import follow
from .materials import Material
from .particles import groups_of
from .runtime import real_type

PATHS = {
    "uniaxial": "F = I + s e_x e_x",
    "biaxial": "F = I + s (e_x e_x + e_y e_y)",
    "shear": "F = I + s e_x e_y",
    "volumetric": "J = 1 + s, F = J^(1/dim) I",
}


class Response(NamedTuple):
    """Of n elements after each step; energies are per reference volume."""

    cauchy_stress: (
        np.ndarray
    )  # [steps, n, 3, 3] Pa; in plane strain with its out-of-plane component
    energy_density: np.ndarray  # [steps, n] J/m^3, stored
    dissipated_energy: np.ndarray  # [steps, n] J/m^3, since the start
    volume_ratio: np.ndarray  # [steps, n]
    plastic_strain: np.ndarray  # [steps, n]


def cycle(strain: float, steps: int = 100) -> np.ndarray:
    """s from 0 to `strain`, to 0, to -`strain`, to 0: [4 steps + 1], both ends included."""
    return np.interp(np.arange(4 * steps + 1) / steps, range(5), [0, strain, 0, -strain, 0])


def deformation(path: str, s: np.ndarray, dim: int) -> np.ndarray:
    """F [n, dim, dim] of a path of PATHS at its strains s [n] > -1."""
    F = np.tile(np.eye(dim), (len(s), 1, 1))
    if path == "volumetric":
        return F * (1 + s[:, None, None]) ** (1 / dim)
    for row, column in {"uniaxial": [(0, 0)], "biaxial": [(0, 0), (1, 1)], "shear": [(0, 1)]}[path]:
        F[:, row, column] += s
    return F


class Elements:
    """`count` elements of a material, in fields of their own.  Taichi has to run (`runtime.start`).

    The artificial viscosity of a gas is that of cells of `cell_size` [m]."""

    def __init__(self, material: Material, dim: int, count: int, cell_size: float = 1e-3):
        self.material = material
        self.undeformed = np.zeros((count, dim, dim))
        (self.group,) = groups_of([material], dim, cell_size, [self.undeformed])

    def lead(self, F: np.ndarray, dt: float = 1.0, compression: float = 0.0) -> Response:
        """From F = I and a fresh history through F [steps, count, dim, dim], each reached from the
        one before with one velocity gradient L = (F F_before^-1 - I) / dt, dt [s].

        With compression c, J goes from 1 to 1 - c first, in 100 steps that are not returned, and F
        is what comes on top."""
        dim = F.shape[-1]
        if compression:
            squeeze = deformation("volumetric", -compression * np.linspace(0, 1, 101), dim)[:, None]
            ramp = np.broadcast_to(squeeze, (101, *F.shape[1:]))
            whole = self.lead(np.concatenate([ramp, F @ squeeze[-1]]), dt)
            return Response(*(values[len(ramp) :] for values in whole))
        before = np.concatenate([self.undeformed[None] + np.eye(dim), F[:-1]])
        rates = (F @ np.linalg.inv(before) - np.eye(dim)) / dt
        for name, values in self.material.start(self.undeformed).items():
            self.group.law.state.get_member_field(name).from_numpy(values)
        found = follow(self.group, rates.astype(real_type()), dt)
        sigma = np.zeros((*F.shape[:2], 3, 3))
        sigma[..., :dim, :dim] = found["tau"]
        if dim == 2:
            sigma[..., 2, 2] = found["tau_zz"]
        J = found["J"]
        return Response(
            sigma / J[..., None, None], found["psi"], found["lost"], J, found["plastic_strain"]
        )

    def first_flow(self, compression: float = 0.0) -> float | None:
        """The shear [-] up to which the material is elastic, within 10 %; None where that is more
        than 0.3, or where it flows from the start."""
        count, dim = self.undeformed.shape[:2]
        s = np.geomspace(1e-5, 0.3, 110)
        F = np.repeat(deformation("shear", s, dim)[:, None], count, axis=1)
        lost = self.lead(F, compression=compression).dissipated_energy[:, 0]
        flows = lost > lost[0]
        return float(s[flows.argmax()]) if flows.any() and not flows[1] else None
