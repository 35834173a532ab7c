"""Every stage and whole steps: the fast form against the twin, f64 with fast-math off.

Both add the same terms in another order, so they differ by a few rounding errors of the largest
term: 1e-12 of the field's largest value leaves room for about a thousand of them."""

from itertools import pairwise

import numpy as np
import pytest

from mpm_taichi.expressions import Expressions
from mpm_taichi.kernels import (
    clear,
    evaluate,
    g2p,
    ghosts,
    grid_update,
    p2g,
    record,
    sort,
    stiffness,
    sums,
    update_stress,
    wrap,
)  # fmt: skip
from mpm_taichi.reference.kernels import clear as twin_clear
from mpm_taichi.reference.kernels import evaluate as twin_evaluate
from mpm_taichi.reference.kernels import fastest as twin_fastest
from mpm_taichi.reference.kernels import g2p as twin_g2p
from mpm_taichi.reference.kernels import ghosts as twin_ghosts
from mpm_taichi.reference.kernels import grid_update as twin_grid_update
from mpm_taichi.reference.kernels import p2g as twin_p2g
from mpm_taichi.reference.kernels import record as twin_record
from mpm_taichi.reference.kernels import slivers as twin_slivers
from mpm_taichi.reference.kernels import stiffness as twin_stiffness
from mpm_taichi.reference.kernels import sums as twin_sums
from mpm_taichi.reference.kernels import update_stress as twin_update_stress
from mpm_taichi.reference.kernels import wrap as twin_wrap

from ..cases import ALL_CASES
from .states import CELLS, DX, build, largest_difference, nodes, particle_fields, reachable

TOLERANCE = 1e-12
DT = 2.5e-4


def three_steps(fast, twin, lengths):
    for solver in (fast, twin):
        solver.start(lengths[0])
        time = 0.0
        for dt, dt_next in pairwise(lengths):
            solver.step(time, dt, dt_next)
            time += dt


def assert_equal(fast, twin, when):
    fields = particle_fields(fast, twin)
    if fast.stress_update == "usf":
        del fields["T"]  # spent within the step
    for name, (ours, theirs) in fields.items():
        assert largest_difference(ours, theirs) < TOLERANCE, f"{name} {when}"


@pytest.mark.parametrize(("dim", "basis", "transfer"), ALL_CASES)
def test_steps_and_stages_equal_the_twin(exact, rng, dim, basis, transfer):
    """Three steps of unequal length, then one compared after each stage."""
    fast, twin = build(rng, dim, basis.__name__, transfer.__name__)
    lengths = DT * (0.5 + rng.random(4))
    three_steps(fast, twin, lengths)
    dt = lengths[-1]
    P, G, Q, N = fast.particles, fast.grid, twin.particles, twin.grid
    lanes = list(range(dim))

    sort.sort(P, G, fast.basis)
    reached = reachable(twin)
    assert_equal(fast, twin, "after three steps and a sort")

    clear.clear(G)
    twin_clear.clear(N)
    p2g.p2g(P, G, fast.basis, fast.transfer)
    twin_p2g.p2g(Q, N, twin.basis, twin.transfer)
    ghosts.fold_ghosts(G, fast.walls, fast.gravity, dt)
    twin_ghosts.fold_ghosts(N, twin.walls, twin.gravity, dt)
    momentum, impulse = nodes(G, lanes)
    assert largest_difference(nodes(G, dim)[0], N.m) < TOLERANCE
    assert largest_difference(momentum + impulse, N.mv + N.impulse) < TOLERANCE

    grid_update.grid_update(G, fast.walls, fast.gravity, dt)
    twin_grid_update.grid_update(N, twin.walls, twin.gravity, dt)
    ghosts.fill_ghosts(G, fast.walls, fast.gravity)
    twin_ghosts.fill_ghosts(N, twin.walls, twin.gravity)
    v, increment = nodes(G, lanes)
    assert largest_difference(v[reached], N.v[reached]) < TOLERANCE
    if fast.transfer.increment:
        assert largest_difference(increment[reached], (N.v - N.v_old)[reached]) < TOLERANCE
    assert G.cut[None] == N.cut

    g2p.g2p(P, G, fast.basis, fast.transfer)
    twin_g2p.g2p(Q, N, twin.basis, twin.transfer)
    v_pic = P.to_numpy("rows")[:, P.layout.pic, :dim]
    assert largest_difference(v_pic, Q.v_pic) < TOLERANCE

    for group, twin_group in zip(P.groups, Q.groups, strict=True):
        update_stress.update_stress(P, group, G, fast.transfer, dt, 0.7 * dt)
        twin_update_stress.update_stress(Q, twin_group, N, twin.transfer, dt, 0.7 * dt)
    assert_equal(fast, twin, "after a step by hand")
    assert G.speed_squared[None] == pytest.approx(N.speed_squared, rel=TOLERANCE)
    assert G.rate_squared[None] == pytest.approx(N.rate_squared, rel=TOLERANCE)
    assert G.compression[None] == pytest.approx(N.compression, rel=TOLERANCE)
    for group, twin_group in zip(P.groups, Q.groups, strict=True):
        ours = stiffness.stiffest(P, group, G)
        assert ours == pytest.approx(twin_stiffness.stiffest(Q, twin_group, N), rel=TOLERANCE)

    shown = twin_evaluate.evaluate(Q, N, twin.basis)
    for name, ours in evaluate.evaluate(P, G, fast.basis).items():
        assert largest_difference(ours, shown[name]) < TOLERANCE, name
    ranges = np.array([0, *sorted(rng.choice(np.arange(1, P.count), 3, replace=False)), P.count])
    added = twin_sums.sums(Q, N, twin.basis, twin.transfer, ranges)
    for name, ours in sums.sums(P, G, fast.basis, fast.transfer, ranges).items():
        assert largest_difference(ours, added[name]) < TOLERANCE, name
    assert P.lost[None] == Q.lost
    assert np.isfinite(P.to_numpy("x")).all()


@pytest.mark.parametrize("dim", [2, 3])
def test_a_record_equals_the_twin(exact, rng, dim):
    """To float32, in which both are given; the twin takes the stress from its deviator."""
    fast, twin = build(rng, dim, "QuadraticBSpline", "MLS")
    three_steps(fast, twin, DT * (0.5 + rng.random(3)))
    theirs = twin_record.record(twin.particles, True)
    for name, ours in record.record(fast.particles, True).items():
        assert ours.dtype == theirs[name].dtype == np.float32
        assert largest_difference(ours, theirs[name]) < 3e-7, name


ORDERS = [
    *((2, "QuadraticBSpline", order, "FLIP") for order in ("musl", "usf")),
    *(
        pytest.param(*case, marks=[pytest.mark.slow])
        for case in (
            (2, "QuadraticBSpline", "musl", "TPIC"),
            (3, "Linear", "musl", "FLIP"),
            (3, "Linear", "usf", "PIC"),
        )
    ),
    *(
        pytest.param(dim, "QuadraticBSpline", order, transfer, marks=pytest.mark.campaign)
        for dim in (2, 3)
        for order in ("musl", "usf")
        for transfer in ("PIC", "FLIP", "APIC", "TPIC", "XPIC")
        if dim == 3 or transfer in ("PIC", "APIC", "XPIC") or (order, transfer) == ("usf", "TPIC")
    ),
]


@pytest.mark.parametrize(("dim", "basis", "order", "transfer"), ORDERS)
def test_stress_orders_equal_the_twin(exact, rng, dim, basis, order, transfer):
    """Three steps with the stress updated first, or last after a second mapping."""
    fast, twin = build(rng, dim, basis, transfer, stress_update=order)
    three_steps(fast, twin, DT * (0.5 + rng.random(4)))
    assert_equal(fast, twin, "after three steps")


CLOSED = [
    pytest.param(dim, axes, basis, transfer, id=f"{dim}D-{axes}-{basis}-{transfer}",
                 marks=[] if dim == 2 else [pytest.mark.slow])
    for dim, axes, basis, transfer in (
        (2, (0,), "QuadraticBSpline", "MLS"),
        (2, (1,), "CubicBSpline", "XPIC"),
        (2, (0, 1), "Linear", "FLIP"),
        (3, (0, 2), "QuadraticBSpline", "FLIP"),
    )
]  # fmt: skip


@pytest.mark.parametrize(("dim", "axes", "basis", "transfer"), CLOSED)
def test_periodic_axes_equal_the_twin(exact, rng, dim, axes, basis, transfer):
    """Three steps in a box that closes on itself, with clouds that lie across its ends; positions
    are compared after both have come back into the box."""
    fast, twin = build(rng, dim, basis, transfer, periodic=axes, ends=axes)
    assert any((twin.particles.x[:, d] > (CELLS[dim][d] - 0.5) * DX).any() for d in axes)
    three_steps(fast, twin, DT * (0.5 + rng.random(4)))
    wrap.wrap(fast.particles, fast.grid)
    twin_wrap.wrap(twin.particles, twin.grid)
    assert_equal(fast, twin, "after three steps")


@pytest.mark.parametrize("transfer", ["MLS", pytest.param("FLIP", marks=pytest.mark.campaign)])
def test_body_forces_equal_the_twin(exact, rng, transfer):
    """Three steps under a force that depends on time and on places before and after deformation."""
    force = Expressions(["3*sin(X + 2*y) - t", "x*Y + 40*t**2"], dim=2)
    fast, twin = build(rng, 2, "QuadraticBSpline", transfer, body_force=force)
    three_steps(fast, twin, DT * (0.5 + rng.random(4)))
    assert_equal(fast, twin, "after three steps")


@pytest.mark.parametrize(
    ("basis", "transfer"),
    [
        ("QuadraticBSpline", "MLS"),
        pytest.param("Linear", "FLIP", marks=pytest.mark.slow),
        pytest.param("GIMP", "TPIC", marks=pytest.mark.slow),
    ],
)
def test_the_fastest_are_named(exact, rng, basis, transfer):
    """After a step: the largest speed and velocity gradient gathered once more equal those that the
    step has found (but for the rounding of x - dt v, over a cell), and are of the particle that the
    twin names."""
    fast, twin = build(rng, 2, basis, transfer)
    lengths = DT * (0.5 + rng.random(4))
    three_steps(fast, twin, lengths)
    motion = fast.named_motion(lengths[2])
    speed, fastest, rate, steepest = twin_fastest.fastest(
        twin.particles, twin.grid, twin.basis, twin.transfer, lengths[2]
    )
    assert (motion.fastest, motion.steepest) == (fastest, steepest)
    assert motion.speed**2 == pytest.approx(speed, rel=1e-11)
    assert motion.rate**2 == pytest.approx(rate, rel=1e-11)
    assert motion.speed**2 == pytest.approx(fast.grid.speed_squared[None], rel=1e-11)
    assert motion.rate**2 == pytest.approx(fast.grid.rate_squared[None], rel=1e-11)


@pytest.mark.parametrize(
    ("transfer", "periodic"),
    [
        ("FLIP", (0, 1)),
        pytest.param("FLIP", (), marks=pytest.mark.slow),
        pytest.param("TPIC", (0,), marks=pytest.mark.slow),
    ],
)
def test_light_nodes_equal_the_twin(exact, rng, transfer, periodic):
    """As many nodes too light for a step as the twin finds, for steps from far below the limit of
    the clouds' lightest node (none) to far above that of the heaviest (all)."""
    fast, twin = build(rng, 2, "Linear", transfer, periodic=periodic, ends=periodic)
    lengths = DT * (0.5 + rng.random(4))
    three_steps(fast, twin, lengths)
    counts = []
    for dt in DX / 14.0 * np.geomspace(1e-3, 30, 12):  # the speed of sound is 10 to 16 m/s
        theirs = twin_slivers.slivers(
            twin.particles, twin.grid, twin.basis, twin.transfer, twin.walls, twin.gravity, dt
        )
        counts.append(fast.slivers(dt))
        assert counts[-1] == theirs
    assert counts == sorted(counts)
    assert counts[0] == 0
    assert counts[-1] == (twin.grid.m > 0).sum() > 20
