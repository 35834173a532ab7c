"""Principal axes of symmetric matrices by NumPy, and strains along them."""

import numpy as np

from .invariants import left_strain, log_volume_ratio


def eigen(A):
    """Values and vectors, columns of V, of a symmetric matrix: A = V diag(l) V^T."""
    return np.linalg.eigh(A)


def assembled(values, V):
    """V diag(values) V^T, of the first dim values."""
    return V @ np.diag(values[: len(V)]) @ V.T


def logarithmic_strains(H, out_of_plane):
    """Principal strains ln s_i [3] of F = I + H, in 2D the last of them ln(1 + out_of_plane), and
    their axes V in space, in the plane in 2D."""
    stretches, V = eigen(left_strain(H))
    e = np.array([0.0, 0.0, log_volume_ratio(out_of_plane)])
    e[: len(H)] = [0.5 * log_volume_ratio(stretch) for stretch in stretches]
    return e, V


def strained(H, V, e):
    """H of V diag(exp e_i) V^T (I + H): stretched by e [3] (logarithmic) along the axes V."""
    G = assembled(np.expm1(e), V)
    return H + G + G @ H


def compound(a, b):
    """(1 + a) (1 + b) - 1."""
    return a + b + a * b
