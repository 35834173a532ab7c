"""APIC in the form of moving least squares (MLS-MPM): Hu et al. (2018)."""

from math import sqrt

from .apic import APIC


class MLS(APIC):
    """The stress joins the affine momentum, A = m C - dt V0 tau D^-1, and C serves as L: one walk
    over the stencil carries everything.  Needs a basis whose moment D is constant."""

    gradient = False

    @staticmethod
    def isolated_limit(basis, half) -> float | None:
        """2 / sqrt(D^-1)."""
        return 2 / sqrt(basis.inverse_moment)

    @staticmethod
    def affine_momentum(m, C, T, D_inverse):
        return m * C + D_inverse * T

    @staticmethod
    def gradients(B, S, D_inverse):
        return D_inverse * B, D_inverse * B
