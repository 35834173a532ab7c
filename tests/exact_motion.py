"""How far a run is from the motion that its scene gives as exact."""

import numpy as np

from mpm_taichi.expressions import Expressions


def exact_displacement(scene) -> Expressions:
    """u_ex(X, t), m."""
    field = scene.field(scene.exact.displacement)
    assert field is not None
    return field


def distances(simulation) -> np.ndarray:
    """u - u_ex of each particle now [n, dim], m; along periodic axes to the nearest image."""
    scene, now = simulation.scene, simulation.snapshot
    X = simulation.initial_position
    off = now.position - X - exact_displacement(scene).value(X, t=now.time)
    for axis in scene.domain.periodic:
        off[:, axis] -= scene.domain.size[axis] * np.rint(off[:, axis] / scene.domain.size[axis])
    return off


def root_mean_square(off: np.ndarray) -> float:
    """Of vectors [n, dim]."""
    return float(np.sqrt((off**2).sum(axis=1).mean()))


def orders(errors) -> np.ndarray:
    """log2 of the ratio of neighbors along the last axis, each with half the cells of the next."""
    errors = np.asarray(errors)
    return np.log2(errors[..., :-1] / errors[..., 1:])
