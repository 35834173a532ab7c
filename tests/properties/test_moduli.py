"""The stiffness that a law tells of a state, against differences of its own stress; by the twin, to
which test_materials.py holds the fast form."""

from copy import copy
from types import SimpleNamespace

import numpy as np
import pytest

from mpm_taichi.materials import DruckerPrager, Gas
from mpm_taichi.reference import materials as twin_materials

from ..laws import DX, LAWS, deformations

STEP = 1e-6
"""Of strain: differences err by it times the next derivative, a few times the modulus."""

WITHIN = {
    "von_mises": (1.0, 0.01), "drucker_prager": (0.97, 0.005), "snow": (0.99, 0.02),
    "linear_elastic": (1.0, 0.1), "hypoelastic": (1.0, 0.1),
}  # fmt: skip
"""Middle and width of the stretches where these do not flow, or are meant for; others bear moderate
ones."""


def states(rng, material, dim):
    """Some F; without rotation, which is strain to linear elasticity."""
    for F in deformations(rng, 5, dim, *WITHIN.get(material.type, (1.0, 0.5))):
        squares, axes = np.linalg.eigh(F @ F.T)
        yield axes @ np.diag(np.sqrt(squares)) @ axes.T if material.type == "linear_elastic" else F


each = pytest.mark.parametrize("material", [pytest.param(law, id=law.type) for law in LAWS])
each_dim = pytest.mark.parametrize("dim", [2, 3])


def at(material, F):
    """What the law answers in a state that it has come to in one step: its moduli, tau [dim, dim],
    and a function that gives the change of tau per strain of rate L."""
    law = getattr(twin_materials, type(material).__name__)
    c, start = SimpleNamespace(**material.constants(DX)), material.start(np.zeros((1, *F.shape)))
    s = SimpleNamespace(**{name: np.array(values[0]) for name, values in start.items()})
    H = F - np.eye(len(F))
    H, s, tau = law.update(c, H, H, 1.0, s)

    def change(L, step=STEP):
        _, _, after = law.update(c, H + step * (L + L @ H), L, step, copy(s))
        return (after - law.update(c, H, 0 * L, 0.0, copy(s))[2]) / step

    return law.moduli(c, H, s), tau, change


def units(rng, n, dim):
    a = rng.normal(size=(n, dim))
    return a / np.linalg.norm(a, axis=1)[:, None]


def tangent(change, dim):
    """d tau_ij / d eps_kl by central differences [dim, dim, dim, dim]."""
    result = np.zeros((dim,) * 4)
    for k, l in np.ndindex(dim, dim):  # noqa: E741
        L = np.zeros((dim, dim))
        L[k, l] = 1.0
        result[:, :, k, l] = 0.5 * (change(L) + change(L, -STEP))
    return result


@each
@each_dim
def test_moduli_bound_the_tangent_closely(rng, material, dim):
    """Over 3000 directions and the principal ones, at stretches between 0.75 and 1.25: rho0 c^2 =
    a . (d tau[a n] - tau n a) n is at most the bound, which is at most 3 times the largest; so is
    the largest L : d tau[L] of unit L, by eigenvalues; 1e-5 for the differences.  A gas alone has
    (gamma - 1) p, which no one relies on: its bound is that of the wave."""
    for F in states(rng, material, dim):
        (wave, lone), tau, change = at(material, F)
        C = tangent(change, dim)
        axes = np.linalg.eigh(F @ F.T)[1].T
        a = np.concatenate([units(rng, 3000, dim), np.repeat(axes, dim, axis=0)])
        n = np.concatenate([units(rng, 3000, dim), np.tile(axes, (dim, 1))])
        found = np.einsum("pi,pj,ijkl,pk,pl->p", a, n, C, a, n)
        found -= (a * n).sum(axis=1) * np.einsum("pi,ij,pj->p", a, tau, n)
        assert found.max() <= wave * (1 + 1e-5)
        assert wave <= 3 * found.max()
        square = C.reshape(dim**2, dim**2)
        largest = np.linalg.eigvalsh(0.5 * (square + square.T)).max()
        assert largest <= lone * (1 + 1e-5)
        assert lone <= (4 if isinstance(material, Gas) else 3) * largest


@each_dim
@pytest.mark.parametrize("name", ["von_mises", "drucker_prager", "snow"])
def test_flow_is_softer(rng, name, dim):
    """Where a law flows, a small step along any of 100 waves adds no more than the bound either,
    in both senses."""
    (material,) = (law for law in LAWS if law.type == name)
    for F in deformations(rng, 5, dim, 0.95, 0.3):
        (wave, _), tau, change = at(material, F)
        for a, n in zip(units(rng, 100, dim), units(rng, 100, dim), strict=True):
            geometric = (a @ n) * (a @ tau @ n)
            for sign in (1, -1):
                found = sign * a @ change(sign * np.outer(a, n)) @ n - geometric
                assert found <= wave * (1 + 1e-4)


@each
@each_dim
def test_moduli_at_rest_are_those_of_the_material(material, dim):
    """rho c^2 and M_d of the undeformed material, to rounding; sand has what flow adds, here less
    than a fifth."""
    (wave, lone), _, _ = at(material, np.eye(dim))
    if isinstance(material, DruckerPrager):
        c = SimpleNamespace(**material.constants(DX))
        extra = (c.slope * (c.lam + 2 / 3 * c.mu)) ** 2 / (8 * c.mu)
        wave, lone = wave - extra, lone - dim * extra
        assert 0 < extra < 0.2 * wave
    assert wave == pytest.approx(material.density * material.wave_speed() ** 2, rel=1e-12)
    assert lone == pytest.approx(material.dilatation_modulus(dim), rel=1e-12)


@each
@each_dim
def test_moduli_grow_no_faster_than_is_told(rng, material, dim):
    """Over a small strain 1e-6 L along any of 100 motions, and of swelling and shrinking alike in
    all directions, at stretches between 0.75 and 1.25: moduli grow by at most `stiffening`; 1e-3 of
    it for the differences."""
    told = material.stiffening(dim)
    for F in states(rng, material, dim):
        now, _, _ = at(material, F)
        motions = [*rng.normal(size=(100, dim, dim)), np.eye(dim), -np.eye(dim)]
        for L in motions:
            rate = max(told[0] * np.linalg.norm(L), -told[1] * np.trace(L))
            later, _, _ = at(material, F + STEP * L @ F)
            for before, after in zip(now, later, strict=True):
                assert np.log(after / before) <= STEP * rate * (1 + 1e-3)
