"""What every law keeps, on the fast form: independent truths, not the twin.

States are random H with singular values of F between 0.6 and 1.6."""

from types import SimpleNamespace

import numpy as np
import pytest
import taichi as ti

from mpm_taichi import runtime
from mpm_taichi.materials import FixedCorotated, LinearElastic, NeoHookean
from mpm_taichi.materials.invariants import log_volume_ratio, volume_strain
from mpm_taichi.particles import groups_of
from mpm_taichi.reference import materials as twin_materials
from mpm_taichi.runtime import Array, Template

LAWS = [
    NeoHookean(type="neo_hookean", density=1000, youngs_modulus=1e5, poissons_ratio=0.3),
    FixedCorotated(type="fixed_corotated", density=1000, youngs_modulus=1e5, poissons_ratio=0.3),
    LinearElastic(type="linear_elastic", density=1000, youngs_modulus=1e5, poissons_ratio=0.3),
]
ROTATING = LAWS[:2]
"""Laws whose stress turns with the body: objective, with an energy that depends on F alone."""

PRECISIONS = {"f64": 1e-12, "f32": 2e-5}
"""Rounding of a stress of order E, relative to E: about 100 rounding errors."""


@ti.kernel
def apply(law: Template, dim: Template, F_minus_one: Array,
          L_dt: Array, tau: Array, psi: Array,
          tau_zz: Array):  # fmt: skip
    for p in range(psi.shape[0]):
        c = law.constants[0]
        H, L = ti.Matrix.zero(float, dim, dim), ti.Matrix.zero(float, dim, dim)
        for d, e in ti.static(ti.ndrange(dim, dim)):
            H[d, e] = F_minus_one[p, d, e]
            L[d, e] = L_dt[p, d, e]
        state = 0
        if ti.static(law.has_state):
            H_new, s, stress = law.kind.update(c, H, L, 1.0, law.state[p])
            psi[p] = law.kind.energy_density(c, H_new, s)
            tau_zz[p] = law.kind.out_of_plane_stress(c, H_new, s)
            for d, e in ti.static(ti.ndrange(dim, dim)):
                tau[p, d, e] = stress[d, e]
        else:
            H_new, s, stress = law.kind.update(c, H, L, 1.0, state)
            psi[p] = law.kind.energy_density(c, H_new, s)
            tau_zz[p] = law.kind.out_of_plane_stress(c, H_new, s)
            for d, e in ti.static(ti.ndrange(dim, dim)):
                tau[p, d, e] = stress[d, e]


def response(material, F, dt_L=None):
    """tau, psi, tau_zz of deformation gradients F [n, dim, dim], from a fresh state.  Each call
    compiles the law: ask for all at once."""
    n, dim = F.shape[:2]
    (group,) = groups_of([material], dim, 0.1, [np.zeros_like(F)])
    dtype = ti.field(float, ()).to_numpy().dtype
    H = (F - np.eye(dim)).astype(dtype)
    L = (np.zeros_like(F) if dt_L is None else dt_L).astype(dtype)
    tau, psi, tau_zz = np.zeros(F.shape, dtype), np.zeros(n, dtype), np.zeros(n, dtype)
    apply(group.law, dim, H, L, tau, psi, tau_zz)
    return tau.astype(float), psi.astype(float), tau_zz.astype(float)


def rotations(rng, n, dim):
    Q, R = np.linalg.qr(rng.normal(size=(n, dim, dim)))
    Q = Q * np.sign(np.diagonal(R, axis1=1, axis2=2))[:, None, :]
    Q[:, :, 0] *= np.sign(np.linalg.det(Q))[:, None]
    return Q


def deformations(rng, n, dim):
    stretch = 0.6 + rng.random((n, dim))
    return rotations(rng, n, dim) @ (stretch[:, :, None] * rotations(rng, n, dim))


@pytest.mark.parametrize("precision", PRECISIONS)
@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("material", LAWS, ids=lambda m: m.type)
def test_no_stress_at_rest(material, dim, precision):
    """F = I, fresh state: tau = 0 and psi = 0 exactly."""
    runtime.start("cpu", precision)
    tau, psi, tau_zz = response(material, np.eye(dim)[None])
    assert not tau.any() and not psi.any() and not tau_zz.any()


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("material", ROTATING, ids=lambda m: m.type)
def test_stress_is_the_derivative_of_the_energy(exact, rng, material, dim):
    """tau = dpsi/dF F^T by central differences with h = 1e-5: error h^2 and u / h, 1e-8 of E."""
    F, h = deformations(rng, 20, dim), 1e-5
    steps = h * np.eye(dim**2).reshape(-1, 1, dim, dim)  # of one component each
    tau, psi, _ = response(material, np.concatenate([F, *(F + steps), *(F - steps)]))
    tau, ahead, behind = tau[:20], *psi[20:].reshape(2, dim, dim, 20)
    P = ((ahead - behind) / 2 / h).transpose(2, 0, 1)
    assert np.abs(P @ F.swapaxes(1, 2) - tau).max() < 1e-8 * material.youngs_modulus


@pytest.mark.parametrize("precision", PRECISIONS)
@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("material", ROTATING, ids=lambda m: m.type)
def test_objective_and_isotropic(rng, material, dim, precision):
    """tau(Q F) = Q tau(F) Q^T and tau(F Q) = tau(F) for rotations Q."""
    runtime.start("cpu", precision, fast_math=False)
    F, Q = deformations(rng, 20, dim), rotations(rng, 20, dim)
    together = response(material, np.concatenate([F, Q @ F, F @ Q]))[0]
    tau, turned, relabeled = together.reshape(3, 20, dim, dim)
    scale = np.abs(tau).max()
    assert np.abs(turned - Q @ tau @ Q.swapaxes(1, 2)).max() < PRECISIONS[precision] * scale
    assert np.abs(relabeled - tau).max() < PRECISIONS[precision] * scale


@pytest.mark.parametrize("precision", PRECISIONS)
@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("material", LAWS, ids=lambda m: m.type)
def test_small_strain_is_hookes_law(rng, material, dim, precision):
    """At strains of 1e-6 tau = 2 mu eps + lam tr(eps) I to 1e-5 (the next order of the strain, and
    in f32 a few rounding errors): H = F - I loses no digits."""
    runtime.start("cpu", precision)
    H = 1e-6 * rng.normal(size=(20, dim, dim))
    c = SimpleNamespace(**material.constants(0.1))
    eps = 0.5 * (H + H.swapaxes(1, 2))
    hooke = 2 * c.mu * eps + c.lam * np.trace(eps, axis1=1, axis2=2)[:, None, None] * np.eye(dim)
    dtype = {"f32": np.float32, "f64": np.float64}[precision]
    (group,) = groups_of([material], dim, 0.1, [np.zeros_like(H)])
    tau, psi, tau_zz = np.zeros(H.shape, dtype), np.zeros(len(H), dtype), np.zeros(len(H), dtype)
    apply(group.law, dim, H.astype(dtype), H.astype(dtype), tau, psi, tau_zz)
    assert np.abs(tau - hooke).max() < 1e-5 * np.abs(hooke).max()
    lateral = c.lam * np.trace(eps, axis1=1, axis2=2)
    assert np.abs(tau_zz - lateral).max() < 1e-5 * np.abs(lateral).max()


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("material", LAWS, ids=lambda m: m.type)
def test_twin_gives_the_same(exact, rng, material, dim):
    """tau, psi, tau_zz equal to 1e-12 of the largest; wave speeds from Lame's constants."""
    F, dt_L = deformations(rng, 20, dim), 0.1 * rng.normal(size=(20, dim, dim))
    tau, psi, tau_zz = response(material, F, dt_L)
    law = getattr(twin_materials, type(material).__name__)
    c = SimpleNamespace(**material.constants(0.1))
    for p in range(len(F)):
        s = SimpleNamespace(**{n: np.array(v) for n, v in material.state(dim).items()})
        H, s, stress = law.update(c, F[p] - np.eye(dim), dt_L[p], 1.0, s)
        assert np.abs(stress - tau[p]).max() < 1e-12 * np.abs(tau).max()
        assert abs(law.energy_density(c, H, s) - psi[p]) < 1e-12 * np.abs(psi).max()
        assert abs(law.out_of_plane_stress(c, H, s) - tau_zz[p]) < 1e-12 * np.abs(tau).max()


@ti.kernel
def logarithms(strain: Array, result: Array):
    for p in range(strain.shape[0]):
        result[p] = log_volume_ratio(strain[p])


@ti.kernel
def volumes(H: Array, result: Array):
    for p in range(H.shape[0]):
        M = ti.Matrix.zero(float, 3, 3)
        for d, e in ti.static(ti.ndrange(3, 3)):
            M[d, e] = H[p, d, e]
        result[p] = volume_strain(M)


@pytest.mark.parametrize(("precision", "bound"), [("f64", 4e-16), ("f32", 3e-7)])
def test_logarithm_keeps_small_strains(rng, precision, bound):
    """ln(1 + e) to a few rounding errors of the result for |e| from 1e-12 to 0.9, fast-math on."""
    runtime.start("cpu", precision)
    dtype = {"f32": np.float32, "f64": np.float64}[precision]
    strain = (10 ** rng.uniform(-12, -0.05, 2000) * rng.choice([-1, 1], 2000)).astype(dtype)
    result = np.zeros_like(strain)
    logarithms(strain, result)
    truth = np.log1p(strain.astype(float))
    assert np.abs(result / truth - 1).max() < 4 * bound


def test_volume_strain_keeps_small_strains(exact, rng):
    """J - 1 of H = 1e-9 times a random matrix, against tr H + order 2 computed in full: det(I + H)
    - 1 would keep 7 digits only."""
    H = 1e-9 * rng.normal(size=(50, 3, 3))
    result = np.zeros(50)
    volumes(H, result)
    trace = np.trace(H, axis1=1, axis2=2)
    second = 0.5 * (trace**2 - np.trace(H @ H, axis1=1, axis2=2))
    assert np.abs(result - (trace + second)).max() < 1e-13 * np.abs(trace).max()
