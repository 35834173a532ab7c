"""Weakly compressible fluid: Tait's equation with Newton's viscosity; see
mpm_taichi/materials/fluid.py for the sources."""

import numpy as np

from .invariants import exp_less_one, isotropic, log_volume_ratio, volume_strain
from .law import MaterialLaw


class Fluid(MaterialLaw):
    """p = K / gamma (J^-gamma - 1), at least - p_t;  tau = J (- p I + 2 eta dev sym L)."""

    @staticmethod
    def pressure(c, strain):
        return c.bulk_modulus / c.exponent * exp_less_one(-c.exponent * log_volume_ratio(strain))

    @staticmethod
    def update(c, H, L, dt, s):
        one, strain = np.eye(len(H)), volume_strain(H)
        if strain > c.torn:
            s.cut_off = s.cut_off + 1
            s.dissipated = s.dissipated + c.tension * (strain - c.torn)
            strain = c.torn
        slower = L.trace() / 3
        D = 0.5 * (L + L.T) - slower * one
        squares = (D**2).sum() + (slower**2 if len(H) == 2 else 0.0)
        s.dissipated = s.dissipated + dt * 2 * c.viscosity * (1 + strain) * squares
        tau = 2 * c.viscosity * (1 + strain) * D - (1 + strain) * Fluid.pressure(c, strain) * one
        return isotropic(H, strain), s, tau

    @staticmethod
    def moduli(c, H, s):
        """rho0 c^2 = K J^(1 - gamma); for a lone particle the pressure comes off, J p per axis."""
        strain = volume_strain(H)
        power = 1 + exp_less_one((1 - c.exponent) * log_volume_ratio(strain))
        pressure = (power - 1 - strain) / c.exponent
        return c.bulk_modulus * power, len(H) * c.bulk_modulus * (power - pressure)

    @staticmethod
    def energy_density(c, H, s):
        """int p d(-J) from J = 1."""
        strain = volume_strain(H)
        series = 1.0
        for k in range(9, 2, -1):
            series = 1 - strain * (c.exponent + k - 2) / k * series
        stored = 0.5 * strain**2 * series
        if abs(strain) > 0.02:
            power = exp_less_one((1 - c.exponent) * log_volume_ratio(strain))
            stored = (power / (c.exponent - 1) + strain) / c.exponent
        return c.bulk_modulus * stored

    @staticmethod
    def dissipated_energy(c, H, s):
        return s.dissipated

    @staticmethod
    def out_of_plane_stress(c, H, s):
        """Of the pressure."""
        strain = volume_strain(H)
        return -(1 + strain) * Fluid.pressure(c, strain)
