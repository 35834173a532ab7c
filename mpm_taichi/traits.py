"""What kind of experiment a scene is, before it runs: how far its particles travel, how much they
are strained, of what they are."""

from typing import NamedTuple

import numpy as np

from .refinement import strips
from .seeding import seed

MOMENTS, PLACES = 41, 2000
"""Times and particles, about, at which an exact solution is looked at."""


class Traits(NamedTuple):
    """`dimension` counts the axes that matter (a periodic strip does not); `laws` are the types of
    the materials; `per_axis` are particles per cell and axis, `across` is the smallest edge of a
    box around a body [cells], `motion` the longest way of a particle [cells], `strain` the largest
    change of a principal stretch.

    `known` tells whether motion and strain are those of an exact solution; else they are estimates:

        motion  |v| T + 1/2 |a| T^2, no longer than the domain
        strain  the largest of |stretch - 1| at the start, |v - mean v| / c, |a| L / c^2

    with T the duration, v and a the speed at the start and gravity with the body force at start and
    end, L the longest edge of the body and c its wave speed.  Without walls, a is the deviation
    from its mean: free fall strains nothing."""

    dimension: int
    laws: tuple[str, ...]
    per_axis: float
    across: float
    motion: float
    strain: float
    walls: bool
    bodies: int
    known: bool


def traits(scene) -> Traits:
    """InputError where the scene cannot be seeded."""
    points, reports = seed(scene)
    exact = scene.exact is not None and scene.exact.displacement is not None
    motion, strain = (_exact if exact else _estimated)(scene, points)
    thin, dx = strips(scene.domain), scene.cell_size
    across = min(
        np.ptp(p.x[:, axis]) + p.V0.max() ** (1 / scene.dimension)
        for p in points
        for axis in range(scene.dimension)
        if axis not in thin or len(thin) == scene.dimension
    )
    used = dict.fromkeys(scene.materials[body.material].type for body in scene.bodies)
    return Traits(
        dimension=max(1, scene.dimension - len(thin)),
        laws=tuple(used),
        per_axis=float(np.mean([r.particles_per_cell for r in reports]) ** (1 / scene.dimension)),
        across=float(across / dx),
        motion=motion / dx,
        strain=float(strain),
        walls=bool(scene.domain.rules),
        bodies=len(scene.bodies),
        known=exact,
    )


def _exact(scene, points):
    """Longest way [m] and largest strain of the exact displacement."""
    X = np.concatenate([p.x for p in points])
    X = X[:: -(-len(X) // PLACES)]
    u = scene.field(scene.exact.displacement)
    times = np.linspace(0, scene.time.end, MOMENTS)
    start = u.value(X, t=0.0)
    motion = max(_largest(u.value(X, t=t) - start) for t in times)
    return motion, max(_stretching(u.gradient(X, t)) for t in times)


def _estimated(scene, points):
    """The same, of what the scene starts with."""
    T, still = scene.time.end, [0.0] * scene.dimension
    moving = []
    strain = 0.0
    for body, p in zip(scene.bodies, points, strict=True):
        u = scene.field(body.displacement or still)
        strain = max(strain, _stretching(u.gradient(p.x)))
        v = scene.field(body.velocity or still).value(p.x)
        b, x = scene.field(scene.body_force or still), p.x + u.value(p.x)
        a = [b.value(p.x, x, t) + scene.gravity_vector for t in (0.0, T)]
        moving.append((scene.materials[body.material].wave_speed(), p, v, a))
    mean = np.concatenate([v for _, _, v, _ in moving]).mean(axis=0)
    fall = np.concatenate([np.concatenate(a) for _, _, _, a in moving]).mean(axis=0)
    farthest = 0.0
    for c, p, v, a in moving:
        L = np.ptp(p.x, axis=0).max()
        pressing = max(_largest(each - (0 if scene.domain.rules else fall)) for each in a)
        strain = max(strain, _largest(v - mean) / c, pressing * L / c**2)
        farthest = max(farthest, _largest(v) * T + 0.5 * max(map(_largest, a)) * T**2)
    return min(farthest, float(np.linalg.norm(scene.domain.size))), strain


def _largest(vectors) -> float:
    """Euclidean norm; formulas that give no number count as 0."""
    return float(np.linalg.norm(np.nan_to_num(vectors, posinf=0, neginf=0), axis=1).max())


def _stretching(H) -> float:
    H = np.nan_to_num(H, posinf=0, neginf=0)
    return float(np.abs(np.linalg.svd(H + np.eye(H.shape[-1]), compute_uv=False) - 1).max())
