"""A law led along given motions, without a grid."""

import numpy as np


def follow(group, rates, dt):
    """Particles that start as the group does through velocity gradients `rates` [steps, n, dim,
    dim] (1/s), each for dt [s].  After each step, [steps, n, ...]: H, tau [Pa], psi (stored) and
    lost energy per reference volume [J/m^3], J, plastic_strain, the moduli `wave` and `lone` [Pa]
    and, in plane strain, tau_zz [Pa].  On return the group holds the last history."""
    law, c, dim = group.law, group.constants, rates.shape[-1]
    H, tau = np.zeros(rates.shape), np.zeros(rates.shape)
    names = "psi", "lost", "J", "plastic_strain", "wave", "lone", "tau_zz"
    scalars = {name: np.zeros(rates.shape[:2]) for name in names}
    for k, p in enumerate(group.members):
        now, s = np.zeros((dim, dim)), group.state[p]
        for n, L in enumerate(rates[:, k]):
            now, s, tau[n, k] = law.update(c, now + dt * (L + L @ now), L, dt, s)
            H[n, k] = now
            scalars["psi"][n, k] = law.energy_density(c, now, s)
            scalars["lost"][n, k] = law.dissipated_energy(c, now, s)
            scalars["J"][n, k] = law.volume_ratio(c, now, s)
            scalars["plastic_strain"][n, k] = law.plastic_strain(c, now, s)
            scalars["wave"][n, k], scalars["lone"][n, k] = law.moduli(c, now, s)
            group.state[p] = s
            if dim == 2:
                scalars["tau_zz"][n, k] = law.out_of_plane_stress(c, now, s)
    return {"H": H, "tau": tau, **scalars}
