"""Taylor particle-in-cell: Nakamura, Matsumura and Mizutani (2023), CMAME 403:115720."""

from math import sqrt

from .apic import APIC


class TPIC(APIC):
    """v_p = sum_i w_i v_i and C = L = sum_i v_i grad w_i^T: the first-order Taylor series of the
    nodal velocity.  Needs no moment D, so it serves every basis."""

    moments = False

    @staticmethod
    def isolated_limit(basis, half) -> float | None:
        """2 / sqrt(H): a lone particle keeps L, so it is the oscillator of MLS with H for D^-1."""
        steepness = basis.steepness(half)
        return 2 / sqrt(steepness) if steepness else None

    @staticmethod
    def gradients(B, S, D_inverse):
        return S, S
