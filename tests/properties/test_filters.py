"""What transfers do with a velocity that the nodes do not see."""

from types import SimpleNamespace

import numpy as np
import pytest

from mpm_taichi import bases, diagnostics
from mpm_taichi.reference import bases as twins
from mpm_taichi.reference.kernels.stencil import stencil
from mpm_taichi.transfers import APIC, FLIP, MLS, PIC, TPIC, XPIC, FLIPBlend, FLIPChoice, FlipPart

from ..verification.motions import Living, snapshot

CELLS, DX = 8, 1 / 8
DT = 1e-3


pytestmark = pytest.mark.xdist_group("filters")


@pytest.fixture
def living():
    """Taichi afresh for each method: fields are part of a kernel's name in the cache, and those of
    a second solver are others."""
    return Living()


def block():
    """4 x 4 particles in each of 3 x 3 cells."""
    x = (np.indices((12, 12)).reshape(2, -1).T + 0.5) * DX / 4 + 2 * DX
    return x, np.full(len(x), (DX / 4) ** 2)


def unseen_velocity(rng, basis):
    """A velocity field with sum_p w_ip v_p = 0 at every node i, |v|^2 = 1 in the mean: random in
    the null space of the weights, from their singular vectors (particles of equal mass)."""
    x, V0 = block()
    twin = getattr(twins, basis.__name__)
    half = 0.125 if basis.extended else 0.0
    particles = SimpleNamespace(x=x, half_width=np.full((len(x), 1), half))
    grid = SimpleNamespace(dim=2, dx=DX, ghost=twin.support, cells=(CELLS, CELLS), walled=())
    n = CELLS + 1 + 2 * twin.support
    W = np.zeros((n, n, len(x)))
    for p in range(len(x)):
        for i, _, w, _ in stencil(p, particles, grid, twin):
            W[(*i, p)] += w
    _, singular, vectors = np.linalg.svd(W.reshape(-1, len(x)))
    unseen = vectors[(singular > 1e-10).sum() :]
    assert len(unseen) > len(x) / 2  # 16 particles for each cell, and some 2 nodes
    v = unseen.T @ rng.normal(size=(len(unseen), 2))
    return x, v / np.sqrt((v**2).sum(axis=1).mean()), V0


def decay(living, rng, basis, transfer, steps, dt=DT, **options):
    """Kinetic energy after each step over that at the start, without any force."""
    x, v, V0 = unseen_velocity(rng, basis)
    mpm = living.solver(x, v, V0, CELLS, basis, transfer, **options)
    energy = [diagnostics.kinetic_energy(snapshot(mpm))]
    mpm.start(dt)
    for step in range(steps):
        mpm.step(step * dt, dt, dt)
        energy.append(diagnostics.kinetic_energy(snapshot(mpm)))
    return np.array(energy[1:]) / energy[0]


@pytest.mark.parametrize("basis", [bases.Linear, bases.QuadraticBSpline], ids=lambda b: b.name)
def test_blend_takes_its_share_in_each_step(living, rng, basis):
    """FLIP part alpha = 0.99: v shrinks by alpha in each step, nodes stay at rest, so the energy
    after n steps is alpha^(2 n) to n rounding errors (0.9801 after 1, 0.8179 after 10)."""
    found, n = decay(living, rng, basis, FLIPBlend, 10, flip_part=FlipPart(0.99)), np.arange(1, 11)
    print(f"relative {np.abs(found / 0.99 ** (2 * n) - 1).max():.1e}; {found}")
    assert (np.abs(found / 0.99 ** (2 * n) - 1) < 1e-13 * (n + 1)).all()


def test_blend_by_a_time_does_not_depend_on_the_step(living, rng):
    """relaxation_time = 25 ms: after 10 ms v is down to exp(-0.4) in 10 steps as in 40, and the
    energy to exp(-0.8), to rounding errors; with a ratio it would be alpha^20 or alpha^80."""
    choice = FLIPChoice(type="flip", relaxation_time=0.025)
    for steps in (10, 40):
        found = decay(
            living, rng, bases.QuadraticBSpline, choice.transfer, steps, 0.01 / steps,
            flip_part=choice.flip_part,
        )  # fmt: skip
        assert found[-1] == pytest.approx(np.exp(-0.8), rel=1e-13 * (steps + 1))


def test_flip_keeps_it(living, rng):
    """The control, and the reason for filters: pure FLIP keeps all of it."""
    assert decay(living, rng, bases.QuadraticBSpline, FLIP, 10)[-1] == pytest.approx(1, rel=1e-12)


@pytest.mark.parametrize(
    ("transfer", "options"),
    [
        (PIC, {}),
        (XPIC, {"filter_order": 2}),
        (XPIC, {"filter_order": 5}),
        (APIC, {}),
        (TPIC, {}),
        (MLS, {}),
    ],
    ids=["pic", "xpic 2", "xpic 5", "apic", "tpic", "mls"],
)
def test_filters_remove_it_in_one_step(living, rng, transfer, options):
    """Every transfer that reads velocities from nodes loses it at once: what is left is the
    rounding error of v, 1e-16 of it and some digits, squared: 1e-28."""
    (found,) = decay(living, rng, bases.QuadraticBSpline, transfer, 1, **options)
    print(f"left: {found:.1e}")
    assert found < 1e-28
