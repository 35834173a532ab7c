"""For output: motion, stress and energy of each particle, in the order of the scene."""

import numpy as np

from .stencil import moment, weigh


def evaluate(particles, grid, basis):
    """x [m], v [m/s], D (moment of each axis, dx^2) [n, dim]; H, tau (Kirchhoff stress, Pa), A
    (affine momentum, kg/s; if a basis has moments that vary, times D) [n, dim, dim]; psi (stored
    energy per reference volume, J/m^3), J (volume ratio), plastic_strain (equivalent) and, in plane
    strain, tau_zz [n]."""
    D = np.zeros_like(particles.x)
    for p in range(particles.count):
        _, a, w, _ = weigh(p, particles, grid, basis)
        D[p] = moment(w, a)
    tau = np.zeros((particles.count, grid.dim, grid.dim))
    tau_zz, psi, J, plastic_strain = np.zeros((4, particles.count))
    for group in particles.groups:
        for p in group.members:
            c, H, still = group.constants, particles.H[p], np.zeros((grid.dim, grid.dim))
            H_same, s, tau[p] = group.law.update(c, H, still, 0.0, group.state[p])
            psi[p] = group.law.energy_density(c, H_same, s)
            J[p] = group.law.volume_ratio(c, H_same, s)
            plastic_strain[p] = group.law.plastic_strain(c, H_same, s)
            if grid.dim == 2:
                tau_zz[p] = group.law.out_of_plane_stress(c, H_same, s)
    carried = {name: getattr(particles, name) for name in ("x", "v", "H", "A")}
    scalars = {"psi": psi, "J": J, "plastic_strain": plastic_strain, "tau_zz": tau_zz}
    return carried | scalars | {"tau": tau, "D": D}
