"""A law led along given motions, without a grid."""

import numpy as np
import taichi as ti

from ..runtime import Array, Template
from .update_stress import load_state, store_state


@ti.kernel
def follow_each(law: Template, material: int, dim: Template, rates: Array, dt: float, table: Array):
    """Row n, p of the table: H, tau, psi, lost energy, J, plastic strain, both moduli, tau_zz."""
    for p in range(rates.shape[1]):
        c, H, s = law.constants[material], ti.Matrix.zero(float, dim, dim), load_state(law, p)
        for n in range(rates.shape[0]):
            L = ti.Matrix.zero(float, dim, dim)
            for d, e in ti.static(ti.ndrange(dim, dim)):
                L[d, e] = rates[n, p, d, e]
            H_new, s_new, tau = law.kind.update(c, H + dt * (L + L @ H), L, dt, s)
            H, s = H_new, s_new
            for d, e in ti.static(ti.ndrange(dim, dim)):
                table[n, p, d * dim + e] = H[d, e]
                table[n, p, dim * dim + d * dim + e] = tau[d, e]
            last = ti.static(2 * dim * dim)
            table[n, p, last] = law.kind.energy_density(c, H, s)
            table[n, p, last + 1] = law.kind.dissipated_energy(c, H, s)
            table[n, p, last + 2] = law.kind.volume_ratio(c, H, s)
            table[n, p, last + 3] = law.kind.plastic_strain(c, H, s)
            wave, lone = law.kind.moduli(c, H, s)
            table[n, p, last + 4], table[n, p, last + 5] = wave, lone
            if ti.static(dim == 2):
                table[n, p, last + 6] = law.kind.out_of_plane_stress(c, H, s)
        store_state(law, p, s)


def follow(group, rates, dt):
    """Particles that start as the group does, whose law is its own, through velocity gradients
    `rates` [steps, n, dim, dim] (1/s), each for dt [s].  After each step, [steps, n, ...]: H, tau
    [Pa], psi (stored) and lost energy per reference volume [J/m^3], J, plastic_strain, the moduli
    `wave` and `lone` [Pa] and, in plane strain, tau_zz [Pa].  On return the law holds the
    last history."""
    steps, n, dim = rates.shape[:3]
    table = np.zeros((steps, n, 2 * dim**2 + 7), rates.dtype)
    follow_each(group.law, group.number, dim, rates, dt, table)
    table, shape = table.astype(float), (steps, n, dim, dim)
    names = "psi", "lost", "J", "plastic_strain", "wave", "lone", "tau_zz"
    scalars = {name: table[..., k - 7] for k, name in enumerate(names)}
    H, tau = table[..., : dim**2].reshape(shape), table[..., dim**2 : -7].reshape(shape)
    return {"H": H, "tau": tau, **scalars}
