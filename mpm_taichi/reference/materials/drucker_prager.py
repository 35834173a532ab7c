"""Sand: Drucker-Prager plasticity without dilation and with volume correction; see
mpm_taichi/materials/drucker_prager.py for the sources."""

import numpy as np

from .flowing import Flowing
from .hencky import Hencky
from .invariants import exp_less_one


class DruckerPrager(Flowing):
    """f = |dev tau| - A p - B <= 0 with p = - tr tau / 3; no stress where tr e >= B / (A K)."""

    @staticmethod
    def update(c, H, L, dt, s):
        e, e_zz, trial = Flowing.strain(H, s)
        D, D_zz, size = Flowing.deviator(e, e_zz, trial)
        closing = c.correction * s.opened
        volume, part, flows = trial + closing, 1.0, False
        largest = (c.strength - c.slope * (c.lam + 2 / 3 * c.mu) * volume) / (2 * c.mu)
        if volume >= (c.tear if s.opened == 0 else 0.0):
            s.opened = s.opened + trial
            volume, part, flows = 0.0, 0.0, True
        elif size > largest or closing > 0:
            s.opened = s.opened - closing
            part, flows = largest / size if size > largest else 1.0, True
            s.plastic_strain = s.plastic_strain + np.sqrt(2 / 3) * (1 - part) * size
        if flows:
            sheared = 2 * c.mu * part * (1 - part) * size**2
            opened = (c.lam + 2 / 3 * c.mu) * volume * (trial - volume)
            s.dissipated = s.dissipated + sheared + opened
            swelling = (volume - trial) / 3
            change = (part - 1) * D + swelling * np.eye(len(H))
            H, s = Flowing.flowed(H, s, change, (part - 1) * D_zz + swelling)
            e = e + change
        return H, s, Hencky.stress(c, e, volume)

    @staticmethod
    def moduli(c, H, s):
        """Flow without dilation is stiffer than no flow where sand expands and is sheared back."""
        wave, lone = Flowing.moduli(c, H, s)
        extra = (c.slope * (c.lam + 2 / 3 * c.mu)) ** 2 / (8 * c.mu)
        return wave + extra, lone + len(H) * extra

    @staticmethod
    def volume_ratio(c, H, s):
        return Flowing.volume_ratio(c, H, s) * (1 + exp_less_one(s.opened))

    @staticmethod
    def dissipated_energy(c, H, s):
        return s.dissipated

    @staticmethod
    def plastic_strain(c, H, s):
        return s.plastic_strain
