"""Stress and energy of given deformations, apart from the particles of a run."""

import numpy as np
import taichi as ti

from ..runtime import Array, Template
from .update_stress import load_state


@ti.kernel
def respond_each(law: Template, material: int, dim: Template, gradients: Array, table: Array):
    """Row p of the table: tau, psi, tau_zz."""
    for p in range(table.shape[0]):
        c, still = law.constants[material], ti.Matrix.zero(float, dim, dim)
        H = ti.Matrix.zero(float, dim, dim)
        for d, e in ti.static(ti.ndrange(dim, dim)):
            H[d, e] = gradients[p, d, e]
        H_same, s, tau = law.kind.update(c, H, still, 0.0, load_state(law, law.begin + p))
        for d, e in ti.static(ti.ndrange(dim, dim)):
            table[p, d * dim + e] = tau[d, e]
        table[p, dim * dim] = law.kind.energy_density(c, H_same, s)
        if ti.static(dim == 2):
            table[p, dim * dim + 1] = law.kind.out_of_plane_stress(c, H_same, s)


def respond(group, H, start):
    """tau [n, dim, dim] (Kirchhoff stress, Pa), psi [n] (elastic energy per reference volume,
    J/m^3) and, in plane strain, tau_zz [n], of H = F - I [n, dim, dim] by the law of the group,
    with the history `start`: name -> values [n, ...].  The group has its law to itself, and loses
    its own history."""
    for name, values in start.items():
        group.law.state.get_member_field(name).from_numpy(values)
    n, dim = H.shape[:2]
    table = np.zeros((n, dim**2 + 2), H.dtype)
    respond_each(group.law, group.number, dim, H, table)
    table = table.astype(float)
    return table[:, : dim**2].reshape(n, dim, dim), table[:, -2], table[:, -1]
