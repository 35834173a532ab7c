"""For recordings: what is kept of each particle, in float32 and in the order of the scene."""

import numpy as np


def record(particles, plastic):
    """position [n, dim] (m), velocity [n, dim] (m/s), pressure and von Mises stress [n] (Pa),
    density [n] (kg/m^3) and, if asked, the equivalent plastic_strain [n]."""
    n, dim = particles.count, particles.dim
    pressure, stress, density, plastic_strain = np.zeros((4, n))
    for group in particles.groups:
        for p in group.members:
            c, H, still = group.constants, particles.H[p], np.zeros((dim, dim))
            H_same, s, tau = group.law.update(c, H, still, 0.0, group.state[p])
            sigma, J = np.zeros((3, 3)), group.law.volume_ratio(c, H_same, s)
            sigma[:dim, :dim] = tau / J
            if dim == 2:
                sigma[2, 2] = group.law.out_of_plane_stress(c, H_same, s) / J
            deviator = sigma - np.trace(sigma) / 3 * np.eye(3)
            pressure[p] = -np.trace(sigma) / 3
            stress[p] = np.sqrt(1.5 * (deviator * deviator).sum())
            density[p] = particles.m[p] / (particles.V0[p] * J)
            plastic_strain[p] = group.law.plastic_strain(c, H_same, s)
    found = {"position": particles.x, "velocity": particles.v}
    found |= {"pressure": pressure, "stress": stress, "density": density}
    if plastic:
        found["plastic_strain"] = plastic_strain
    return {name: values.astype(np.float32) for name, values in found.items()}
