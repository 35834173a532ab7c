"""Sums over particles, and stress measures, against closed forms."""

from itertools import product
from math import log

import numpy as np
import pytest

from mpm_taichi import diagnostics
from mpm_taichi.bases import QuadraticBSpline
from mpm_taichi.snapshot import Snapshot
from mpm_taichi.transfers import MLS
from tests.verification import motions
from tests.verification.test_conservation import SIZES


def snapshot(x, v, m, **given) -> Snapshot:
    """Particles at x with velocities v and masses m; the rest is 0 where it is not given."""
    x, v = np.asarray(x, float), np.asarray(v, float)
    n, dim = x.shape
    empty = {
        "initial_volume": np.ones(n),
        "deformation_gradient": np.tile(np.eye(dim), (n, 1, 1)),
        "cauchy_stress": np.zeros((n, 3, 3)),
        "energy_density": np.zeros(n),
        "volume_ratio": np.ones(n),
        "plastic_strain": np.zeros(n),
        "spin": np.zeros((n, dim, dim)),
    }
    return Snapshot(
        time=0.0, step=0, position=x, velocity=v, mass=np.broadcast_to(m, n), **(empty | given)
    )


def under_stress(*sigma) -> Snapshot:
    """One particle under each stress tensor."""
    n = len(sigma)
    return snapshot(np.zeros((n, 3)), np.zeros((n, 3)), 1.0, cauchy_stress=np.array(sigma, float))


def rotating(dim, omega, V, c, m, a):
    """Masses m at the corners of a cube of edge 2 a about c; v = V + omega x r."""
    r = a * np.array(list(product([-1, 1], repeat=dim)), float)
    turn = omega[0] * np.stack([-r[:, 1], r[:, 0]], axis=1) if dim == 2 else np.cross(omega, r)
    return snapshot(c + r, V + turn, m)


def test_angular_momentum_of_a_rotating_square(rng):
    """L = M (c x V) + I omega about the origin, I = 4 m (a^2 + a^2) = 8 m a^2 of four masses; exact
    but for rounding.  So are M V and T = M V^2 / 2 + I omega^2 / 2."""
    V, c, (m, a), omega = rng.normal(size=2), rng.normal(size=2), rng.random(2), rng.normal(size=1)
    now = rotating(2, omega, V, c, m, a)
    M, inertia = 4 * m, 8 * m * a**2
    orbit = M * (c[0] * V[1] - c[1] * V[0])
    L = orbit + inertia * omega
    assert diagnostics.angular_momentum(now) == pytest.approx(L, abs=1e-13)
    assert diagnostics.momentum(now) == pytest.approx(M * V, abs=1e-13)
    energy = 0.5 * M * V @ V + 0.5 * inertia * omega[0] ** 2
    assert diagnostics.kinetic_energy(now) == pytest.approx(energy, rel=1e-12)


def test_angular_momentum_of_a_rotating_cube(rng):
    """Eight masses at the corners: I = 16 m a^2 about every axis, so L = M (c x V) + I omega for
    omega in any direction, each component with its sign."""
    V, c, omega, (m, a) = *rng.normal(size=(3, 3)), rng.random(2)
    now = rotating(3, omega, V, c, m, a)
    M, inertia = 8 * m, 16 * m * a**2
    expected = M * np.cross(c, V) + inertia * omega
    assert diagnostics.angular_momentum(now) == pytest.approx(expected, abs=1e-12)
    energy = 0.5 * M * V @ V + 0.5 * inertia * omega @ omega
    assert diagnostics.kinetic_energy(now) == pytest.approx(energy, rel=1e-12)


@pytest.mark.parametrize("dim", [2, 3])
def test_spin_of_the_affine_velocity(rng, dim):
    """Particles at rest at the origin whose affine velocity turns with omega hold D C^T each, D the
    moment of the basis: L = 2 m D omega, n times."""
    n, m, D = 5, rng.random(), rng.random()
    omega = rng.normal(size=3) if dim == 3 else np.array([0.0, 0.0, rng.normal()])
    C = np.array([np.cross(omega, e) for e in np.eye(3)]).T[:dim, :dim]  # C r = omega x r
    now = snapshot(np.zeros((n, dim)), np.zeros((n, dim)), m, spin=np.tile(m * D * C.T, (n, 1, 1)))
    expected = 2 * n * m * D * (omega if dim == 3 else omega[2:])
    assert diagnostics.angular_momentum(now) == pytest.approx(expected, rel=1e-13)


def test_spin_of_a_solver(fast, rng):
    """A turning disk after a step of MLS-MPM: the spin that a snapshot reads from the rows is m D
    C^T with C = [omega]_x and D = dx^2 / 4, m D omega each way.

    In the middle, as far from the surface as particles reach by way of nodes, 3 cells per axis, the
    lattice is symmetric about the nodes, and they and the particles reproduce a linear velocity
    exactly; a step turns the body by omega dt, of order 1e-6."""
    cells, radius = 20, 0.3
    x, V0 = motions.ball_points(2, cells, radius, 0.0)
    r, w = x - 0.5, rng.normal()
    v = np.zeros_like(x)
    v[:, 0], v[:, 1] = -w * r[:, 1], w * r[:, 0]
    mpm = motions.solver(x, v, V0, cells, QuadraticBSpline, MLS)
    motions.advance(mpm, 1e-6, 1)
    now = motions.snapshot(mpm)
    inner = np.linalg.norm(r, axis=1) < radius - 3 * 2**0.5 / cells
    assert inner.sum() > 20
    for a, b in ((0, 1), (1, 0)):
        expected = (b - a) * now.mass[inner] * 0.25 / cells**2 * w
        assert now.spin[inner, a, b] == pytest.approx(expected, rel=1e-5)


def test_stress_measures():
    """p = - tr(sigma) / 3 and von Mises: |s| under uniaxial stress s, sqrt(3) |t| under shear t, 0
    under pressure, |s1 - s2| for equal stresses s2 across; exact but for rounding."""
    s, t = -300.0, 40.0
    shear = np.zeros((3, 3))
    shear[0, 1] = shear[1, 0] = t
    across = np.diag([5.0, 2.0, 2.0])
    now = under_stress(np.diag([s, 0, 0]), shear, s * np.eye(3), across, np.zeros((3, 3)))
    assert now.pressure == pytest.approx([100.0, 0.0, 300.0, -3.0, 0.0], rel=1e-15)
    assert now.von_mises_stress == pytest.approx([300.0, 40.0 * 3**0.5, 0.0, 3.0, 0.0], rel=1e-15)


def test_stress_measures_do_not_turn(rng):
    """Both are invariants: the same for Q sigma Q^T, to rounding."""
    sigma = rng.normal(size=(3, 3))
    sigma += sigma.T
    Q, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    now = under_stress(sigma, Q @ sigma @ Q.T)
    for values in (now.pressure, now.von_mises_stress):
        assert values[0] == pytest.approx(values[1], rel=1e-13, abs=1e-14)


@pytest.mark.parametrize("dim", [2, 3])
def test_stress_of_a_stretched_particle(fast, dim):
    """F = diag(1 + e, 1, 1): sigma = (mu (b - I) + lam ln J I) / J, in plane strain with the
    out-of-plane lam ln J / J; psi = mu ((1 + e)^2 - 1) / 2 - mu ln J + lam (ln J)^2 / 2."""
    e, (cells, radius) = 0.1, SIZES[dim]
    x, V0 = motions.ball_points(dim, cells, radius, 0.0)
    mpm = motions.solver(x, 0 * x, V0, cells, QuadraticBSpline, MLS)
    H = np.zeros((len(x), dim, dim))
    H[:, 0, 0] = e
    mpm.particles.H.from_numpy(H)
    now = motions.snapshot(mpm)
    c = motions.JELLY.constants(1.0)
    J, b = 1 + e, (1 + e) ** 2
    side = c["lam"] * log(J) / J
    along = c["mu"] * (b - 1) / J + side
    psi = 0.5 * c["mu"] * (b - 1) - c["mu"] * log(J) + 0.5 * c["lam"] * log(J) ** 2
    for sigma in now.cauchy_stress[[0, -1]]:
        assert sigma == pytest.approx(np.diag([along, side, side]), rel=1e-13)
    assert now.pressure == pytest.approx(np.full(len(x), -(along + 2 * side) / 3), rel=1e-13)
    assert now.von_mises_stress == pytest.approx(np.full(len(x), along - side), rel=1e-12)
    assert diagnostics.elastic_energy(now) == pytest.approx(V0.sum() * psi, rel=1e-12)


def test_centers_of_bodies(rng):
    """Two bodies of 3 and 2 particles with masses of their own: centers and mean velocities are
    weighted by mass."""
    x, v, m = rng.normal(size=(5, 3)), rng.normal(size=(5, 3)), rng.random(5)
    now = snapshot(x, v, m)
    center, velocity = diagnostics.body_motion(now, np.array([0, 3, 5]))
    for body, part in enumerate((slice(0, 3), slice(3, 5))):
        assert center[body] == pytest.approx(np.average(x[part], axis=0, weights=m[part]))
        assert velocity[body] == pytest.approx(np.average(v[part], axis=0, weights=m[part]))
