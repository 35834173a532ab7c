"""Hencky solids that flow: F is that of what is stored elastically, and in plane strain the elastic
stretch across the plane is part of the history, so that yield surfaces are those of 3D."""

from typing import Any

import taichi as ti

from .elastic import Elastic
from .hencky import Hencky
from .invariants import exp_less_one, volume_strain
from .principal import compound, logarithmic_strains, strained


@ti.func
def across(H, s):
    """Elastic stretch across the plane, less one; 0 in 3D, where there is none."""
    stretch = 0.0
    if ti.static(H.n == 2):
        stretch = s.out_of_plane
    return stretch


@ti.func
def flowed(H, V, change, s):
    """H and history after principal strains [3] along the axes V have changed."""
    if ti.static(H.n == 2):
        s.out_of_plane = compound(s.out_of_plane, exp_less_one(change[2]))
    return strained(H, V, change), s


class Flowing(Elastic):
    def state(self, dim: int) -> dict[str, Any]:
        """out_of_plane: the elastic stretch across the plane, less one [-]."""
        return {"out_of_plane": 0.0} if dim == 2 else {}

    @staticmethod
    @ti.func
    def energy_density(c, H, s):
        e, _V = logarithmic_strains(H, across(H, s))
        return Hencky.energy_of(c, e)

    @staticmethod
    @ti.func
    def volume_ratio(c, H, s):
        """Of the elastic part: that of all where the flow keeps the volume."""
        return 1.0 + compound(volume_strain(H), across(H, s))

    @staticmethod
    @ti.func
    def out_of_plane_stress(c, H, s):
        e, _V = logarithmic_strains(H, across(H, s))
        return Hencky.principal_stress(c, e)[2]
