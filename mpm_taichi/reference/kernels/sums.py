"""For reports: what is conserved and where the energy is, added up body by body."""

import numpy as np

from .stencil import moment, weigh
from .tally import TURNS


def spin_moments(p, particles, grid, basis, transfer):
    """M = sum_i w_i r_i (A r_i)^T = D A^T [kg m^2/s]; a basis with moments that vary has D in A."""
    if transfer.moments:
        return particles.A[p].T * grid.dx**2 / (basis.inverse_moment or 1.0)
    _, a, w, _ = weigh(p, particles, grid, basis)
    return (particles.A[p] * moment(w, a)).T * grid.dx**2


def sums(particles, grid, basis, transfer, ranges):
    """Over each body, whose particles are ranges[b] to ranges[b + 1]: mass_moment (sum m x),
    momentum (sum m v), angular_momentum about the origin (sum x x m v and the moments of the affine
    velocity), kinetic_energy, elastic_energy (sum V0 psi, what the laws store), dissipated_energy
    (what they have lost)."""
    bodies, dim = len(ranges) - 1, grid.dim
    found = {
        "mass_moment": np.zeros((bodies, dim)),
        "momentum": np.zeros((bodies, dim)),
        "angular_momentum": np.zeros((bodies, len(TURNS[dim]))),
        "kinetic_energy": np.zeros(bodies),
        "elastic_energy": np.zeros(bodies),
        "dissipated_energy": np.zeros(bodies),
    }
    for group in particles.groups:
        for p in group.members:
            b = np.searchsorted(ranges, p, side="right") - 1
            m, x, v = particles.m[p], particles.x[p], particles.v[p]
            answers = group.constants, particles.H[p], group.state[p]
            M = np.outer(x, m * v)
            if transfer.affine:
                M += spin_moments(p, particles, grid, basis, transfer)
            found["mass_moment"][b] += m * x
            found["momentum"][b] += m * v
            found["angular_momentum"][b] += [M[d, e] - M[e, d] for d, e in TURNS[dim]]
            found["kinetic_energy"][b] += 0.5 * m * v @ v
            V0 = particles.V0[p]
            found["elastic_energy"][b] += V0 * group.law.energy_density(*answers)
            found["dissipated_energy"][b] += V0 * group.law.dissipated_energy(*answers)
    return found
