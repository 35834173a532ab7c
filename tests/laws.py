"""A material of each law, and what it answers along motions without a grid."""

from types import SimpleNamespace
from typing import Any

import numpy as np
from taichi.lang import impl

from mpm_taichi import runtime
from mpm_taichi.kernels.follow import follow
from mpm_taichi.materials import (
    DruckerPrager,
    FixedCorotated,
    Fluid,
    Gas,
    Hencky,
    Hypoelastic,
    LinearElastic,
    NeoHookean,
    Snow,
    VonMises,
)
from mpm_taichi.particles import groups_of
from mpm_taichi.reference import materials as twin_materials
from mpm_taichi.reference.kernels.follow import follow as follow_twin

MODULUS = 1e5
STIFF: dict[str, Any] = {"density": 1000.0, "youngs_modulus": MODULUS, "poissons_ratio": 0.3}
LAWS = [
    LinearElastic(type="linear_elastic", **STIFF),
    Hypoelastic(type="hypoelastic", **STIFF),
    NeoHookean(type="neo_hookean", **STIFF),
    FixedCorotated(type="fixed_corotated", **STIFF),
    Hencky(type="hencky", **STIFF),
    VonMises(type="von_mises", yield_stress=5e3, hardening=2e3, **STIFF),
    DruckerPrager(type="drucker_prager", friction_angle=30.0, cohesion=500.0, **STIFF),
    Snow(type="snow", critical_compression=0.025, critical_stretch=0.0075, hardening=10.0, **STIFF),
    Fluid(type="fluid", density=1000.0, bulk_modulus=MODULUS),
    Gas(type="gas", density=1.0, pressure=MODULUS, quadratic_viscosity=0.0, linear_viscosity=0.0),
]
"""Without viscosity: what rests on the deformation alone."""

BY_NAME = {law.type: law for law in LAWS}
VISCOUS = [
    Fluid(type="fluid", density=1000.0, bulk_modulus=MODULUS, viscosity=30.0, tension=1e3),
    Gas(type="gas", density=1.0, pressure=MODULUS),
]
ROOM = 384
"""Particles that a call can follow."""

DX = 0.1


def response(material, F, precision="f64"):
    """What `followed` has after one step from I to F [n, dim, dim], without a step of time."""
    found = followed(material, (F - np.eye(F.shape[1]))[None], precision=precision)
    return SimpleNamespace(**{name: values[0] for name, values in vars(found).items()})


class Compiled:
    """A group of ROOM particles for each law and dimension, of the Taichi that runs now: all
    materials of a law share a kernel."""

    def __init__(self):
        self.precision, self.runtime, self.groups = "", None, {}

    def group(self, material, dim, precision):
        """Of fresh particles of the material.  Taichi starts anew only for another precision, or
        where another test has started it.  In f64 its own optimization is off, which takes most of
        the time of compiling a law."""
        if precision != self.precision or self.runtime is not impl.get_runtime():
            optimized = precision == "f32"
            runtime.start(
                "cpu", precision, threads=2, fast_math=False, advanced_optimization=optimized
            )
            self.precision, self.runtime, self.groups = precision, impl.get_runtime(), {}
        key, still = (type(material), dim), np.zeros((ROOM, dim, dim))
        if key not in self.groups:
            (self.groups[key],) = groups_of([material], dim, DX, [still])
        law = self.groups[key].law
        for name, number in material.constants(DX).items():
            law.constants[0][name] = number
        for name, values in material.start(still).items():
            law.state.get_member_field(name).from_numpy(values)
        return self.groups[key]


COMPILED = Compiled()


def followed(material, rates, dt=1.0, precision="f64"):
    """What `follow` gives for velocity gradients [steps, n, dim, dim] from a fresh state, and the
    counts of the law."""
    steps, n, dim = rates.shape[:3]
    group = COMPILED.group(material, dim, precision)
    found = follow(group, rates.astype(runtime.real_type()), dt)
    counts = {
        name: np.broadcast_to(group.law.state.get_member_field(name).to_numpy()[:n], (steps, n))
        for name in material.counters
    }
    return SimpleNamespace(**found, **counts)


def followed_by_twin(material, rates, dt=1.0):
    n, dim = rates.shape[1:3]
    start = material.start(np.zeros((n, dim, dim)))
    group = SimpleNamespace(
        law=getattr(twin_materials, type(material).__name__),
        constants=SimpleNamespace(**material.constants(DX)),
        members=range(n),
        state=[SimpleNamespace(**{k: np.array(v[p]) for k, v in start.items()}) for p in range(n)],
    )
    return SimpleNamespace(**follow_twin(group, rates, dt))


def rotations(rng, n, dim):
    Q, R = np.linalg.qr(rng.normal(size=(n, dim, dim)))
    Q = Q * np.sign(np.diagonal(R, axis1=1, axis2=2))[:, None, :]
    Q[:, :, 0] *= np.sign(np.linalg.det(Q))[:, None]
    return Q


def deformations(rng, n, dim, middle=1.1, width=1.0):
    """F with random axes and singular values within `width` about `middle`."""
    stretch = middle + width * (rng.random((n, dim)) - 0.5)
    return rotations(rng, n, dim) @ (stretch[:, :, None] * rotations(rng, n, dim))


def rates_of(F):
    """Velocity gradients of the motion through F [steps, n, dim, dim] from I, in steps of 1 s."""
    before = np.concatenate([np.broadcast_to(np.eye(F.shape[-1]), F[:1].shape), F[:-1]])
    return F @ np.linalg.inv(before) - np.eye(F.shape[-1])


def stress_in_space(found):
    """tau [..., 3, 3]; in plane strain with tau_zz."""
    dim = found.tau.shape[-1]
    if dim == 3:
        return found.tau
    tau = np.zeros((*found.tau.shape[:-2], 3, 3))
    tau[..., :2, :2], tau[..., 2, 2] = found.tau, found.tau_zz
    return tau
