"""Sand: Drucker-Prager plasticity without dilation and with volume correction; see
mpm_taichi/materials/drucker_prager.py for the sources."""

import numpy as np

from .flowing import Flowing, across, flowed
from .hencky import Hencky
from .invariants import exp_less_one
from .principal import assembled, logarithmic_strains


class DruckerPrager(Flowing):
    """f = |dev tau| - A p - B <= 0 with p = - tr tau / 3; no stress where tr e >= B / (A K)."""

    @staticmethod
    def update(c, H, L, dt, s):
        trial, V = logarithmic_strains(H, across(H, s))
        closing = c.correction * s.opened
        volume = trial.sum() + closing
        deviator = trial - trial.sum() / 3
        size = np.linalg.norm(deviator)
        largest = (c.strength - c.slope * (c.lam + 2 / 3 * c.mu) * volume) / (2 * c.mu)
        e, flows = trial, False
        if volume >= (c.tear if s.opened == 0 else 0.0):
            s.opened = s.opened + trial.sum()
            e, flows = np.zeros(3), True
        elif size > largest or closing > 0:
            s.opened = s.opened - closing
            part = min(1.0, largest / size)
            s.plastic_strain = s.plastic_strain + np.sqrt(2 / 3) * (1 - part) * size
            e, flows = part * deviator + volume / 3, True
        if flows:
            s.dissipated = s.dissipated + Hencky.energy_of(c, trial) - Hencky.energy_of(c, e)
            H, s = flowed(H, V, e - trial, s)
        return H, s, assembled(Hencky.principal_stress(c, e), V)

    @staticmethod
    def volume_ratio(c, H, s):
        return Flowing.volume_ratio(c, H, s) * (1 + exp_less_one(s.opened))

    @staticmethod
    def dissipated_energy(c, H, s):
        return s.dissipated

    @staticmethod
    def plastic_strain(c, H, s):
        return s.plastic_strain
