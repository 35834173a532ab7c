"""Hencky solids that flow: F is that of what is stored elastically, and in plane strain the elastic
stretch across the plane is part of the history, so that yield surfaces are those of 3D."""

from .hencky import Hencky
from .invariants import exp_less_one, volume_strain
from .law import MaterialLaw
from .principal import compound, logarithmic_strains, strained


def across(H, s):
    """Elastic stretch across the plane, less one; 0 in 3D, where there is none."""
    return s.out_of_plane if len(H) == 2 else 0.0


def flowed(H, V, change, s):
    """H and history after principal strains [3] along the axes V have changed."""
    if len(H) == 2:
        s.out_of_plane = compound(s.out_of_plane, exp_less_one(change[2]))
    return strained(H, V, change), s


class Flowing(MaterialLaw):
    @staticmethod
    def energy_density(c, H, s):
        return Hencky.energy_of(c, logarithmic_strains(H, across(H, s))[0])

    @staticmethod
    def volume_ratio(c, H, s):
        return 1 + compound(volume_strain(H), across(H, s))

    @staticmethod
    def out_of_plane_stress(c, H, s):
        e, _ = logarithmic_strains(H, across(H, s))
        return Hencky.principal_stress(c, e)[2]
