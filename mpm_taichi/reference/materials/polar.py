"""Polar decomposition F = R S by NumPy's singular value decomposition."""

import numpy as np


def rotation(H):
    """R - I of F = I + H, det R = 1: the least singular value takes the sign of det F."""
    one = np.eye(len(H))
    U, _s, Wt = np.linalg.svd(one + H)
    U[:, -1] *= np.sign(np.linalg.det(U @ Wt))
    return U @ Wt - one
