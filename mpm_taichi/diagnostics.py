"""Sums over all particles: what is conserved, and where the energy is.

NumPy sums in the order of the scene: they do not depend on threads or sorting."""

import numpy as np


def momentum(snapshot):
    """sum m v [kg m/s], shape [dim]."""
    return (snapshot.mass[:, None] * snapshot.velocity).sum(axis=0)


def angular_momentum(snapshot):
    """About the origin [kg m^2/s], shape [1] in 2D and [3] in 3D: sum x x m v, and the moments of
    the affine velocity (Jiang et al. 2015)."""
    mv = snapshot.mass[:, None] * snapshot.velocity
    moments = np.einsum("pa,pb->ab", snapshot.position, mv) + snapshot.spin.sum(axis=0)
    axial = moments - moments.T
    if len(axial) == 2:
        return np.array([axial[0, 1]])
    return np.array([axial[1, 2], axial[2, 0], axial[0, 1]])


def kinetic_energy(snapshot):
    """sum m |v|^2 / 2 [J]."""
    return 0.5 * (snapshot.mass * (snapshot.velocity**2).sum(axis=1)).sum()


def elastic_energy(snapshot):
    """sum V0 psi [J]."""
    return (snapshot.initial_volume * snapshot.energy_density).sum()


def body_motion(snapshot, ranges):
    """Center of mass [m] and mean velocity [m/s] of each body, shape [bodies, dim] each; body b
    has the particles ranges[b] to ranges[b + 1]."""
    m = snapshot.mass[:, None]
    total = np.add.reduceat(m, ranges[:-1])
    center = np.add.reduceat(m * snapshot.position, ranges[:-1]) / total
    velocity = np.add.reduceat(m * snapshot.velocity, ranges[:-1]) / total
    return center, velocity
