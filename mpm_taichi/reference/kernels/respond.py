"""Stress and energy of given deformations, apart from the particles of a run."""

from types import SimpleNamespace

import numpy as np


def respond(group, H, start):
    """tau [n, dim, dim] (Kirchhoff stress, Pa), psi [n] (elastic energy per reference volume,
    J/m^3) and, in plane strain, tau_zz [n], of H = F - I [n, dim, dim] by the law of the group,
    with the history `start`: name -> values [n, ...]."""
    c, still = group.constants, np.zeros(H.shape[1:])
    tau, (psi, tau_zz) = np.zeros(H.shape), np.zeros((2, len(H)))
    for p in range(len(H)):
        state = SimpleNamespace(**{name: values[p] for name, values in start.items()})
        H_same, s, tau[p] = group.law.update(c, H[p], still, 0.0, state)
        psi[p] = group.law.energy_density(c, H_same, s)
        if len(still) == 2:
            tau_zz[p] = group.law.out_of_plane_stress(c, H_same, s)
    return tau, psi, tau_zz
