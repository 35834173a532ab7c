"""For output: motion, stress and energy of each particle, in the order of the scene."""

import numpy as np
import taichi as ti

from ..runtime import Array, Template
from .rows import columns, vector
from .stencil import moment, weigh
from .update_stress import load_state


@ti.kernel
def evaluate_particles(
    particles: Template, law: Template, material: int, grid: Template, basis: Template,
    begin: int, end: int, table: Array,
):  # fmt: skip
    """Row id of the table: x, v, D, H, tau, A, psi, J, plastic strain, tau_zz."""
    dim = ti.static(grid.dim)
    matrix = ti.static(dim * dim)
    for p in range(begin, end):
        c, g = law.constants[material], grid.constants[None]
        x, H, id = particles.x[p], particles.H[p], particles.id[p]
        v = vector(particles.rows, p, 0, dim) / particles.m[p]
        A = columns(particles.rows, p, particles.layout.affine, dim) * g.inv_dx
        _base, a, w, _dw = weigh(p, particles, grid, basis)
        D = moment(w, a)
        still = ti.Matrix.zero(float, dim, dim)
        H_same, s, tau = law.kind.update(c, H, still, 0.0, load_state(law, p))
        for d in ti.static(range(dim)):
            table[id, d] = x[d]
            table[id, dim + d] = v[d]
            table[id, 2 * dim + d] = D[d]
            for e in ti.static(range(dim)):
                at = ti.static(3 * dim + d * dim + e)
                table[id, at] = H_same[d, e]
                table[id, at + matrix] = tau[d, e]
                table[id, at + 2 * matrix] = A[d, e]
        last = ti.static(3 * dim + 3 * matrix)
        table[id, last] = law.kind.energy_density(c, H_same, s)
        table[id, last + 1] = law.kind.volume_ratio(c, H_same, s)
        table[id, last + 2] = law.kind.plastic_strain(c, H_same, s)
        if ti.static(dim == 2):
            table[id, last + 3] = law.kind.out_of_plane_stress(c, H_same, s)


def evaluate(particles, grid, basis):
    """x [m], v [m/s], D (moment of each axis, dx^2) [n, dim]; H, tau (Kirchhoff stress, Pa), A
    (affine momentum, kg/s; if a basis has moments that vary, times D) [n, dim, dim]; psi (stored
    energy per reference volume, J/m^3), J (volume ratio), plastic_strain (equivalent) and, in plane
    strain, tau_zz [n]; all in the precision of the run."""
    n, dim = particles.count, grid.dim
    table = np.zeros((n, 3 * dim + 3 * dim**2 + 4), particles.dtype)
    for group in particles.groups:
        evaluate_particles(
            particles, group.law, group.number, grid, basis, group.begin, group.end, table
        )
    vectors = {"x": 0, "v": dim, "D": 2 * dim}
    matrices = {"H": 3 * dim, "tau": 3 * dim + dim**2, "A": 3 * dim + 2 * dim**2}
    scalars = {"psi": -4, "J": -3, "plastic_strain": -2, "tau_zz": -1}
    return (
        {name: table[:, at : at + dim] for name, at in vectors.items()}
        | {name: table[:, at : at + dim**2].reshape(n, dim, dim) for name, at in matrices.items()}
        | {name: table[:, at] for name, at in scalars.items()}
    )
