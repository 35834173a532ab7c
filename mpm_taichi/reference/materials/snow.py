"""Snow: Stomakhin et al. (2013); see mpm_taichi/materials/snow.py."""

from functools import reduce

import numpy as np

from .fixed_corotated import FixedCorotated
from .invariants import exp_less_one, left_strain, volume_strain
from .law import MaterialLaw
from .symmetric import assembled, eigen


class Snow(MaterialLaw):
    """Fixed-corotated, with mu and lam times exp(xi (1 - J_P)); stretches of the elastic part stay
    within [1 - theta_c, 1 + theta_s]."""

    @staticmethod
    def hardness(c, s):
        return 1 + exp_less_one(max(min(-c.hardening * s.plastic_volume, c.capped_at), -80.0))

    @staticmethod
    def energy_of(c, x, factor):
        return factor * (c.mu * (x**2).sum() + 0.5 * c.lam * volume_of(x) ** 2)

    @staticmethod
    def update(c, H, L, dt, s):
        squares, V = eigen(left_strain(H))
        x = squares / (1 + np.sqrt(1 + squares))
        y = np.clip(x, c.least, c.most)
        if (y != x).any():
            G = assembled((y - x) / (1 + x), V)
            H = H + G + G @ H
            before, kept = Snow.energy_of(c, x, Snow.hardness(c, s)), volume_of(y)
            s.plastic_volume = compound(s.plastic_volume, (volume_of(x) - kept) / (1 + kept))
            s.dissipated = s.dissipated + before - Snow.energy_of(c, y, Snow.hardness(c, s))
        s.capped = s.capped + float(-c.hardening * s.plastic_volume > c.capped_at)
        strain = volume_of(y)
        tau = 2 * c.mu * (y + y**2) + c.lam * strain * (1 + strain)
        return H, s, assembled(Snow.hardness(c, s) * tau, V)

    @staticmethod
    def moduli(c, H, s):
        """Those of fixed-corotated snow as hard as it is."""
        factor = Snow.hardness(c, s)
        wave, lone = FixedCorotated.moduli(c, H, s)
        return factor * wave, factor * lone

    @staticmethod
    def energy_density(c, H, s):
        squares, _ = eigen(left_strain(H))
        return Snow.energy_of(c, squares / (1 + np.sqrt(1 + squares)), Snow.hardness(c, s))

    @staticmethod
    def dissipated_energy(c, H, s):
        return s.dissipated

    @staticmethod
    def volume_ratio(c, H, s):
        return (1 + volume_strain(H)) * (1 + s.plastic_volume)

    @staticmethod
    def out_of_plane_stress(c, H, s):
        strain = volume_strain(H)
        return Snow.hardness(c, s) * c.lam * strain * (1 + strain)


def compound(a, b):
    """(1 + a) (1 + b) - 1."""
    return a + b + a * b


def volume_of(x):
    """J - 1 of principal stretches 1 + x [dim]."""
    return reduce(compound, x)
