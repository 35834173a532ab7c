"""Mass, momentum, angular momentum and free fall, 2D and 3D, f64 with fast-math as users run it.

Sub-cell offsets are drawn at run time.  Bounds: numerics.md, chapter 6: n steps add n k u, with u =
1.1e-16 and k of the order of a hundred contributions to a node."""

import numpy as np
import pytest

from mpm_taichi.bases import GIMP, CubicBSpline, Linear, QuadraticBSpline
from mpm_taichi.kernels.clear import clear
from mpm_taichi.kernels.p2g import p2g
from mpm_taichi.particles import BodyPoints
from mpm_taichi.reference import bases as twin_bases
from mpm_taichi.reference import transfers as twin_transfers
from mpm_taichi.reference.solver import Solver as TwinSolver
from mpm_taichi.transfers import APIC, FLIP, MLS, PIC, TPIC

from ..cases import CASES
from .motions import JELLY, Living, advance, ball_points, momenta, snapshot

SIZES = {2: (20, 0.2), 3: (12, 0.22)}

pytestmark = pytest.mark.xdist_group("conservation")


@pytest.fixture(scope="module")
def living():
    return Living()


def start(living, rng, dim, basis, transfer, omega=0.0, **options):
    """A ball somewhere in the box, with uniform and rotating velocity."""
    cells, radius = SIZES[dim]
    x, V0 = ball_points(dim, cells, radius, 0.1 * (rng.random(dim) - 0.5))
    v = np.tile(rng.normal(size=dim), (len(x), 1)) * (0.0 if omega else 0.2)
    r = x - x.mean(axis=0)
    v[:, 0] -= omega * r[:, 1]
    v[:, 1] += omega * r[:, 0]
    return living.solver(x, v, V0, cells, basis, transfer, **options), x, v


@pytest.mark.parametrize(("dim", "basis", "transfer"), CASES)
def test_mass_and_momentum(living, rng, dim, basis, transfer):
    """A moving, compressed ball springs back: 100 steps keep the momentum to 1e-13 of sum m |v| per
    step (k u), and the nodes hold the mass of the particles to 1e-13."""
    mpm, x, v = start(living, rng, dim, basis, transfer)
    mpm.particles.H.from_numpy(np.tile(-0.05 * np.eye(dim), (len(x), 1, 1)))
    before = snapshot(mpm).mass @ v
    dt = 2e-4
    advance(mpm, dt, 100)
    scale = snapshot(mpm).mass @ np.linalg.norm(v, axis=1)
    if basis.steepness is not None or not mpm.grid.cut[None]:
        assert np.abs(momenta(mpm)[0] - before).max() < 100 * 1e-13 * scale
    assert np.abs(momenta(mpm)[0]).max() > 0.1 * np.abs(before).max()
    clear(mpm.grid)
    p2g(mpm.particles, mpm.grid, mpm.basis, mpm.transfer)
    nodes = mpm.grid.node.to_numpy()[: mpm.grid.nodes, dim].sum()
    assert nodes == pytest.approx(snapshot(mpm).mass.sum(), rel=1e-13)


@pytest.mark.parametrize(
    ("dim", "basis", "transfer"),
    [
        (2, QuadraticBSpline, MLS),
        (2, QuadraticBSpline, APIC),
        (2, GIMP, APIC),
        (2, CubicBSpline, MLS),
        pytest.param(3, QuadraticBSpline, MLS, marks=pytest.mark.slow),
        pytest.param(3, QuadraticBSpline, APIC, marks=pytest.mark.slow),
    ],
)
def test_spinning_ball_keeps_angular_momentum(living, rng, dim, basis, transfer):
    """APIC conserves sum x x m v + sum m axial(B) where the stencil is whole (Jiang et al. 2015):
    1e-11 after 400 steps of a soft ball that widens as it spins."""
    mpm, _, _ = start(living, rng, dim, basis, transfer, omega=2.0)
    mpm.start(1e-3)
    mpm.step(0.0, 1e-3, 1e-3)  # the affine velocity starts at 0 and is formed here
    _, before = momenta(mpm)
    for _ in range(400):
        mpm.step(0.0, 1e-3, 1e-3)
    _, after = momenta(mpm)
    assert np.abs(after - before).max() < 1e-11 * np.abs(before).max()


@pytest.mark.parametrize("basis", [Linear, QuadraticBSpline])
def test_tpic_keeps_the_angular_momentum_of_rigid_motion(living, rng, basis):
    """TPIC carries L instead of moments, and sum m axial(L D) is the angular momentum of affine
    motion alone: 1e-11 per step for a ball that spins as a rigid body, started with its L."""
    mpm, x, v = start(living, rng, 2, basis, TPIC, omega=2.0)
    L = np.tile([[0.0, -2.0], [2.0, 0.0]], (len(x), 1, 1))
    rows = mpm.particles.gathered(mpm.particles.to_numpy("m"), v, L)
    mpm.particles.rows.from_numpy(rows)
    mpm.start(1e-5)
    _, before = momenta(mpm)
    mpm.step(0.0, 1e-5, 1e-5)
    _, after = momenta(mpm)
    assert np.abs(after - before).max() < 1e-8 * np.abs(before).max()


def test_pic_loses_angular_momentum(living, rng):
    """The control: PIC has no affine part and must lose angular momentum, or the test above could
    not fail."""
    mpm, _, _ = start(living, rng, 2, QuadraticBSpline, PIC, omega=2.0)
    advance(mpm, 1e-3, 1)
    _, before = momenta(mpm)
    advance(mpm, 1e-3, 100)
    _, after = momenta(mpm)
    assert after[0] < 0.9 * before[0]


@pytest.mark.parametrize(("dim", "basis", "transfer"), CASES)
def test_free_fall_is_exact(living, rng, dim, basis, transfer):
    """Under g alone, symplectic Euler gives v = v0 + n dt g and x = x0 + n dt v0 + n (n + 1)/2
    dt^2 g for every particle: sums of weights are 1, so rounding errors of 100 steps remain.  F
    stays I: |F - I| <= n s k u |v| dt / dx."""
    g = list(rng.normal(size=dim))
    mpm, x, v = start(living, rng, dim, basis, transfer, gravity=g)
    n, dt = 100, 1e-3
    advance(mpm, dt, n)
    now = snapshot(mpm)
    assert np.abs(now.velocity - (v + n * dt * np.array(g))).max() < 1e-12
    fallen = n * (n + 1) / 2 * dt**2 * np.array(g)
    assert np.abs(now.position - (x + n * dt * v + fallen)).max() < 1e-13
    tolerance = 1e-11 if basis.steepness(0.25) else 1e-8  # hat functions: gradients at tiny weights
    assert np.abs(now.deformation_gradient - np.eye(dim)).max() < tolerance


def test_breathing_ball_keeps_its_energy(living, rng):
    """A ball with v = a r breathes: kinetic energy turns into elastic energy and back, while the
    sum stays within 10 % (USL dissipates at the ragged surface of a ball of 8 cells; numerics.md 3,
    row 10) and rises by at most 1.5 % (symplectic Euler: omega dt / 2).  A wrong factor in an
    energy, a force or a volume breaks it."""
    _, x, v = start(living, rng, 2, QuadraticBSpline, FLIP)
    v = 0.3 * (x - x.mean(axis=0))
    mpm = living.solver(
        x, v, np.full(len(x), 0.25 / SIZES[2][0] ** 2), SIZES[2][0], QuadraticBSpline, FLIP
    )
    dt = 0.05 / SIZES[2][0] / JELLY.wave_speed()
    mpm.start(dt)

    def energies():
        now = snapshot(mpm)
        kinetic = 0.5 * now.mass @ (now.velocity**2).sum(axis=1)
        return kinetic, now.initial_volume @ now.energy_density

    total = sum(energies())
    shares = []
    for _ in range(480):
        mpm.step(0.0, dt, dt)
        kinetic, elastic = energies()
        assert 0.9 < (kinetic + elastic) / total < 1.015
        shares.append(elastic / total)
    assert max(shares) > 0.8
    assert min(shares[np.argmax(shares) :]) < 0.2


@pytest.mark.parametrize("order", ["usf", "musl"])
@pytest.mark.parametrize("past", [0.0, 1e-15])
def test_a_node_barely_touched_moves_along(order, past):
    """Four particles fly, the foremost on a node or just past it.  Hats have their whole slope for
    the next node there, so that this must move as they do, and F = I stays: 1e-14, by the NumPy
    twin.  (Taken as empty it stands still, and strains them by v dt / dx = 0.02.)"""
    x = np.array([[3.5, 3.5], [4.0, 3.5], [3.5, 4.0], [4.0, 4.0]]) + past
    v = np.tile([0.2, 0.1], (4, 1))
    twin = TwinSolver(
        [BodyPoints(JELLY, x, v, np.full(4, 0.25))], (8, 8), 1.0, twin_bases.Linear,
        twin_transfers.FLIP, (), [0.0, 0.0], stress_update=order,
    )  # fmt: skip
    twin.start(0.1)
    twin.step(0.0, 0.1, 0.1)
    assert np.abs(twin.particles.H).max() < 1e-14
