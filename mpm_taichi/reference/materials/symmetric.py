"""Functions of symmetric matrices by NumPy."""

import numpy as np


def eigen(A):
    """Values and vectors, columns of V, of a symmetric matrix: A = V diag(l) V^T."""
    return np.linalg.eigh(A)


def assembled(values, V):
    """V diag(values) V^T."""
    return V @ np.diag(values) @ V.T


def logarithm(A):
    """ln(I + A)."""
    values, V = eigen(A)
    with np.errstate(invalid="ignore"):
        return assembled(np.log1p(values), V)


def exponential(A):
    """exp(A) - I."""
    values, V = eigen(A)
    return assembled(np.expm1(values), V)
