"""Hencky solids that flow: F is that of what is stored elastically, and in plane strain the elastic
stretch across the plane is part of the history, so that yield surfaces are those of 3D."""

from typing import Any

import taichi as ti

from .elastic import Elastic
from .hencky import Hencky
from .invariants import exp_less_one, log_volume_ratio, volume_strain
from .symmetric import exponential


class Flowing(Elastic):
    """Strains are e in the plane or in space, and e_zz across the plane, in space 0."""

    def state(self, dim: int) -> dict[str, Any]:
        """strain_across: e_zz [-]."""
        return {"strain_across": 0.0} if dim == 2 else {}

    @staticmethod
    @ti.func
    def strain(H, s):
        """e, e_zz, and their trace."""
        e, e_zz = Hencky.strain(H), 0.0
        if ti.static(H.n == 2):
            e_zz = s.strain_across
        return e, e_zz, e.trace() + e_zz

    @staticmethod
    @ti.func
    def deviator(e, e_zz, volume):
        """Of the strain: in the plane or in space, across the plane, and its norm."""
        D, D_zz = e, 0.0
        for d in ti.static(range(e.n)):
            D[d, d] -= volume / 3.0
        if ti.static(e.n == 2):
            D_zz = e_zz - volume / 3.0
        return D, D_zz, ti.sqrt(D.norm_sqr() + D_zz * D_zz)

    @staticmethod
    @ti.func
    def energy(c, size, volume):
        """psi of a strain whose deviator has the norm `size`."""
        return c.mu * size * size + (0.5 * c.lam + c.mu / 3.0) * volume * volume

    @staticmethod
    @ti.func
    def flowed(H, s, change, change_zz):
        """H and history after the elastic strain has changed along its own axes."""
        if ti.static(H.n == 2):
            s.strain_across += change_zz
        G = exponential(change)
        return H + G + G @ H, s

    @staticmethod
    @ti.func
    def moduli(c, H, s):
        """Of the elastic part: flow is softer."""
        volume = log_volume_ratio(volume_strain(H))
        if ti.static(H.n == 2):
            volume += s.strain_across
        return Hencky.moduli_at(c, H, volume)

    @staticmethod
    @ti.func
    def energy_density(c, H, s):
        e, e_zz, volume = Flowing.strain(H, s)
        _e, _e_zz, size = Flowing.deviator(e, e_zz, volume)
        return Flowing.energy(c, size, volume)

    @staticmethod
    @ti.func
    def volume_ratio(c, H, s):
        """Of the elastic part: that of all where the flow keeps the volume."""
        strain = volume_strain(H)
        if ti.static(H.n == 2):
            strain += (1.0 + strain) * exp_less_one(s.strain_across)
        return 1.0 + strain

    @staticmethod
    @ti.func
    def out_of_plane_stress(c, H, s):
        log_J = log_volume_ratio(volume_strain(H))
        return 2.0 * c.mu * s.strain_across + c.lam * (log_J + s.strain_across)
