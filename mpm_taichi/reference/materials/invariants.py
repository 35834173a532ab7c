"""Strain measures of H = F - I that lose no digits when H is small."""

import numpy as np


def left_strain(H):
    """b - I = H + H^T + H H^T."""
    return H + H.T + H @ H.T


def volume_strain(H):
    """J - 1 = tr H + (second invariant) + det H; in 2D the second invariant is det H."""
    if len(H) == 2:
        return H.trace() + np.linalg.det(H)
    return H.trace() + 0.5 * (H.trace() ** 2 - (H @ H).trace()) + np.linalg.det(H)


def squared_stretches(H):
    """A lower and an upper bound of the principal values of b = F F^T."""
    n, b = len(H), np.eye(len(H)) + left_strain(H)
    mean, J = b.trace() / n, 1 + volume_strain(H)
    spread = np.sqrt((n - 1) / n * ((b - mean * np.eye(n)) ** 2).sum())
    if n == 2:
        return J**2 / (mean + spread), mean + spread
    return max(mean - spread, (J / (1.5 * mean)) ** 2), mean + spread


def log_volume_ratio(strain):
    """ln(1 + strain); NaN from -1 down."""
    return np.log1p(strain) if strain > -1 else np.nan


def exp_less_one(y):
    """exp(y) - 1."""
    return np.expm1(y)


def isotropic(H, strain):
    """H of F = (1 + strain)^(1/dim) I."""
    return exp_less_one(log_volume_ratio(strain) / len(H)) * np.eye(len(H))
