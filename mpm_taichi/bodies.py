"""Bodies of a scene as particles: where they start, how fast, and how far deformed."""

import numpy as np

from .errors import InputError
from .particles import BodyPoints
from .seeding import refuse_outside
from .time_step import Motion


def body_points(scene, index, X, V0) -> BodyPoints:
    """The particles of a body at the start: X [n, dim] (m) are their places before the displacement
    that the scene gives, V0 [n] their volumes."""
    body = scene.bodies[index]
    material, still = scene.materials[body.material], [0.0] * scene.dimension
    x, H = X, None
    if body.displacement is not None:
        u = scene.field(body.displacement)
        x, H = X + u.value(X), u.gradient(X)
        refuse_outside(x, f"bodies[{index}].displacement", body.name, scene.domain)
    velocity = scene.field(body.velocity or still)
    v, L = velocity.value(X), velocity.gradient(X)
    for key, values in (("velocity", v), ("displacement", x)):
        if not np.isfinite(values).all():
            bad = X[~np.isfinite(values).all(axis=1)][0].tolist()
            raise InputError(f"bodies[{index}].{key} ({body.name}): is no number at {bad}")
    if H is not None:
        F = H + np.eye(scene.dimension)
        folded = ~(np.linalg.det(F) > 0)
        if folded.any():
            raise InputError(
                f"bodies[{index}].displacement ({body.name}): turns the material inside out at "
                f"{X[folded][0].tolist()}, where det(I + grad u) is not above 0"
            )
        L = L @ np.linalg.inv(F)
    return BodyPoints(material, x, v, V0, X, H, L if L.any() else None)


def first_motion(bodies: list[BodyPoints]) -> Motion:
    """Of all bodies at the start."""
    speeds = np.concatenate([np.linalg.norm(body.v, axis=1) for body in bodies])
    rates = np.concatenate([np.linalg.norm(body.velocity_gradient, axis=(1, 2)) for body in bodies])
    fastest, steepest = int(speeds.argmax()), int(rates.argmax())
    return Motion(
        float(speeds[fastest]), float(rates[steepest]), fastest=fastest, steepest=steepest
    )


def half_width(bodies: list[BodyPoints], scene) -> float:
    """Of the smallest particle [cells].  InputError where a basis that takes particles as extended
    would reach further than its stencil."""
    edges = np.concatenate([body.V0 for body in bodies]) ** (1 / scene.dimension)
    half = 0.5 * edges / scene.cell_size
    basis = scene.method.basis_class
    if basis.extended and half.max() > 0.5 * (1 + 1e-9):
        raise InputError(
            f"method.basis: {basis.name} takes particles up to a cell wide, and one is "
            f"{2 * half.max():.3g} cells wide: take more particles, or fewer, larger cells"
        )
    return float(half.min())
