"""Hencky solids that flow: F is that of what is stored elastically, and in plane strain the elastic
stretch across the plane is part of the history, so that yield surfaces are those of 3D."""

import numpy as np

from .hencky import Hencky
from .invariants import exp_less_one, log_volume_ratio, volume_strain
from .law import MaterialLaw
from .symmetric import exponential


class Flowing(MaterialLaw):
    """Strains are e in the plane or in space, and e_zz across the plane, in space 0."""

    @staticmethod
    def strain(H, s):
        e, e_zz = Hencky.strain(H), s.strain_across if len(H) == 2 else 0.0
        return e, e_zz, e.trace() + e_zz

    @staticmethod
    def deviator(e, e_zz, volume):
        D = e - volume / 3 * np.eye(len(e))
        D_zz = e_zz - volume / 3 if len(e) == 2 else 0.0
        return D, D_zz, np.sqrt((D**2).sum() + D_zz**2)

    @staticmethod
    def energy(c, size, volume):
        return c.mu * size**2 + (0.5 * c.lam + c.mu / 3) * volume**2

    @staticmethod
    def flowed(H, s, change, change_zz):
        if len(H) == 2:
            s.strain_across = s.strain_across + change_zz
        G = exponential(change)
        return H + G + G @ H, s

    @staticmethod
    def moduli(c, H, s):
        """Of the elastic part: flow is softer."""
        volume = log_volume_ratio(volume_strain(H)) + (s.strain_across if len(H) == 2 else 0.0)
        return Hencky.moduli_at(c, H, volume)

    @staticmethod
    def energy_density(c, H, s):
        e, e_zz, volume = Flowing.strain(H, s)
        _, _, size = Flowing.deviator(e, e_zz, volume)
        return Flowing.energy(c, size, volume)

    @staticmethod
    def volume_ratio(c, H, s):
        strain = volume_strain(H)
        if len(H) == 2:
            strain += (1 + strain) * exp_less_one(s.strain_across)
        return 1 + strain

    @staticmethod
    def out_of_plane_stress(c, H, s):
        log_J = log_volume_ratio(volume_strain(H))
        return 2 * c.mu * s.strain_across + c.lam * (log_J + s.strain_across)
