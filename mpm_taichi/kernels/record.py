"""For recordings: what is kept of each particle, in float32 and in the order of the scene."""

from typing import TYPE_CHECKING, Any

import numpy as np
import taichi as ti

from ..runtime import Template
from .rows import vector
from .update_stress import load_state

if TYPE_CHECKING:
    Singles = Any
else:
    Singles = ti.types.ndarray(dtype=ti.f32, ndim=2)


@ti.kernel
def record_particles(
    particles: Template, law: Template, material: int, dim: Template, begin: int, end: int,
    position: Singles, velocity: Singles, scalars: Singles, plastic: Template,
):  # fmt: skip
    """Row id of position and velocity, column id of the scalars."""
    for p in range(begin, end):
        c, H, id, m = law.constants[material], particles.H[p], particles.id[p], particles.m[p]
        x, v = particles.x[p], vector(particles.rows, p, 0, dim) / m
        for d in ti.static(range(dim)):
            position[id, d] = ti.cast(x[d], ti.f32)
            velocity[id, d] = ti.cast(v[d], ti.f32)
        still = ti.Matrix.zero(float, dim, dim)
        H_same, s, tau = law.kind.update(c, H, still, 0.0, load_state(law, p))
        J = law.kind.volume_ratio(c, H_same, s)
        normal, shear = ti.Vector.zero(float, 3), 0.0
        for d in ti.static(range(dim)):
            normal[d] = tau[d, d]
            for e in ti.static(range(d)):
                shear += tau[d, e] * tau[d, e]
        if ti.static(dim == 2):
            normal[2] = law.kind.out_of_plane_stress(c, H_same, s)
        mises = 3.0 * shear
        for d in ti.static(range(3)):
            mises += 0.5 * (normal[d] - normal[(d + 1) % 3]) ** 2
        scalars[0, id] = ti.cast(-(normal[0] + normal[1] + normal[2]) / (3.0 * J), ti.f32)
        scalars[1, id] = ti.cast(ti.sqrt(mises) / abs(J), ti.f32)
        scalars[2, id] = ti.cast(m / (particles.V0[p] * J), ti.f32)
        if ti.static(plastic):
            scalars[3, id] = ti.cast(law.kind.plastic_strain(c, H_same, s), ti.f32)


def record(particles, plastic: bool) -> dict[str, np.ndarray]:
    """position [n, dim] (m), velocity [n, dim] (m/s), pressure and von Mises stress [n] (Pa),
    density [n] (kg/m^3) and, if asked, the equivalent plastic_strain [n]."""
    n, dim = particles.count, particles.dim
    position, velocity = (np.empty((n, dim), np.float32) for _ in range(2))
    scalars = np.empty((3 + plastic, n), np.float32)
    for group in particles.groups:
        record_particles(
            particles, group.law, group.number, dim, group.begin, group.end, position, velocity,
            scalars, plastic,
        )  # fmt: skip
    names = ("pressure", "stress", "density", "plastic_strain")
    return {"position": position, "velocity": velocity} | dict(zip(names, scalars, strict=False))
