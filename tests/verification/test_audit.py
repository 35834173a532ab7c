"""What walls, gravity and body forces give, and what each stage loses: the books of runs close.

f64 with fast-math as users run it.  Rounding: 1e-12 of sqrt(2 m (K + E)) and the impulses, after
some tens of steps (numerics.md, chapter 6).  Seeds are drawn at run time."""

import numpy as np
import pytest

from mpm_taichi import boundaries, runtime
from mpm_taichi.bases import GIMP, CubicBSpline, Linear, QuadraticBoundary, QuadraticBSpline
from mpm_taichi.boundaries import Wall
from mpm_taichi.expressions import Expressions
from mpm_taichi.kernels.sums import sums
from mpm_taichi.ledger import begin_ledger, ledger
from mpm_taichi.particles import BodyPoints
from mpm_taichi.solver import Solver
from mpm_taichi.transfers import APIC, FLIP, MLS, PIC, TPIC, FLIPBlend, FlipPart

from .motions import JELLY, restart

RULES = {
    "sticky": ("Sticky",) * 6,
    "slip": ("Slip",) * 6,
    "separate": ("Separate",) * 6,
    "unlike": ("Slip", "Separate", "Sticky", "Slip", "Sticky", "Separate"),
}
SLOW = [pytest.mark.slow]
CAMPAIGN = [pytest.mark.slow, pytest.mark.campaign]
CASES = [
    pytest.param(dim, basis, transfer, rules, marks=marks,
                 id=f"{dim}D-{basis.name}-{transfer.__name__}-{rules}")
    for dim, basis, transfer, rules, marks in (
        (2, QuadraticBSpline, MLS, "unlike", []),
        (2, QuadraticBSpline, FLIPBlend, "separate", SLOW),
        (2, Linear, FLIP, "sticky", CAMPAIGN),
        (2, GIMP, APIC, "slip", CAMPAIGN),
        (2, QuadraticBoundary, TPIC, "unlike", CAMPAIGN),
        (2, QuadraticBSpline, PIC, "slip", CAMPAIGN),
        (2, QuadraticBSpline, MLS, "sticky", CAMPAIGN),
        (2, QuadraticBSpline, MLS, "slip", CAMPAIGN),
        (2, QuadraticBSpline, MLS, "separate", CAMPAIGN),
        (2, QuadraticBSpline, FLIP, "unlike", CAMPAIGN),
        (2, CubicBSpline, MLS, "unlike", CAMPAIGN),
        (3, QuadraticBSpline, MLS, "unlike", CAMPAIGN),
        (3, QuadraticBSpline, FLIP, "slip", CAMPAIGN),
    )
]  # fmt: skip


def jelly(rng, dim, basis, transfer, rules, cells=0, threads=1, audited=True):
    """A cloud in a corner of a box that is flung at its walls, with gravity and a body force."""
    cells = cells or {2: 10, 3: 7}[dim]
    h = 0.5 / cells
    x = (np.indices((cells,) * dim).reshape(dim, -1).T + 0.2 + 0.6 * rng.random()) * h
    x[:, 0] = 1 - x[:, 0]
    v = np.array([2.0, -1.5, -1.0][:dim]) + 0.5 * np.sin(9 * x[:, ::-1])
    sides = [(axis, upper) for axis in range(dim) for upper in (False, True)]
    walls = tuple(
        Wall(*side, getattr(boundaries, rule))
        for side, rule in zip(sides, RULES[rules], strict=False)
    )
    b = Expressions(["5*sin(9*y)", "x - 40*t", "2*x"][:dim], dim=dim)
    return Solver(
        [BodyPoints(JELLY, x, v, np.full(len(x), h**dim))], (cells,) * dim, 1 / cells, basis,
        transfer, walls, [1.0, -9.0, 2.0][:dim], body_force=b,
        flip_part=FlipPart(0.9 if transfer is FLIPBlend else 1.0),
        audited=audited, threads=threads,
    )  # fmt: skip


def added(solver):
    found = sums(
        solver.particles, solver.grid, solver.basis, solver.transfer, [0, solver.particles.count]
    )
    return {name: values.sum(axis=0) for name, values in found.items()}


def advance(solver, steps):
    """Steps of a tenth of the acoustic limit.  Returns their length."""
    dt = 0.1 * solver.grid.dx / JELLY.wave_speed()
    for n in range(steps):
        solver.step(n * dt, dt, dt)
    return dt


def counted(solver, steps):
    """From the start: sums before and after, the ledger, and the time."""
    solver.start(0.1 * solver.grid.dx / JELLY.wave_speed())
    before = added(solver)
    begin_ledger(solver, before)
    dt = advance(solver, steps)
    after = added(solver)
    return before, after, ledger(solver, after), steps * dt


def vector(columns, name, dim):
    return np.array([columns[f"{name}_{axis}"] for axis in "xyz"[:dim]])


@pytest.mark.parametrize(("dim", "basis", "transfer", "rules"), CASES)
def test_momentum_is_what_walls_gravity_and_body_force_give(rng, dim, basis, transfer, rules):
    """80 steps of a jelly flung into a corner: 1e-12 of the momentum that turns over, so a wall
    impulse that is off by a node shows.  APIC keeps angular momentum too.  Energy: all but 1e-3 of
    it is in a row of the ledger (what is left is the trapezoidal rule of the work of the stress).
    The walls give much of the momentum at the start.  P2G and G2P of PIC and APIC are averages, and
    only lose (Jensen; numerics.md, chapter 6)."""
    runtime.start("cpu", "f64", threads=1)
    solver = jelly(rng, dim, basis, transfer, rules)
    before, after, columns, time = counted(solver, 80)
    m = solver.particles.to_numpy("m").sum()
    gravity = time * m * solver.gravity.to_numpy().ravel()
    walls, pushed = (vector(columns, f"{name}_impulse", dim) for name in ("wall", "body"))
    given = walls + pushed + gravity - vector(columns, "cut_impulse", dim)
    scale = np.sqrt(2 * m * (before["kinetic_energy"] + before["elastic_energy"]))
    residual = after["momentum"] - before["momentum"] - given
    print(f"walls {walls}, body force {pushed}, residual {residual / scale}")
    assert np.abs(residual).max() < 1e-12 * scale
    assert np.linalg.norm(walls) > 0.5 * np.linalg.norm(before["momentum"])
    assert np.linalg.norm(pushed) > 1e-3 * np.linalg.norm(before["momentum"])
    if transfer.moments:
        turn = sum(
            np.array([value for name, value in columns.items() if name.startswith(f"{part}_turn")])
            for part in ("wall", "body", "gravity")
        )
        off = after["angular_momentum"] - before["angular_momentum"] - turn
        assert np.abs(off).max() < 1e-12 * scale
    assert abs(columns["energy_residual"]) < 1e-3 * before["kinetic_energy"]
    assert transfer.increment or min(columns["loss_p2g"], columns["loss_g2p"]) > 0


def closing(columns, before, after):
    """What the rows leave of the energy."""
    energy = sum(after[name] - before[name] for name in ("elastic_energy", "dissipated_energy"))
    energy += columns["particle_kinetic_energy"] - before["kinetic_energy"]
    rows = {name: value for name, value in columns.items() if name.startswith(("work", "loss"))}
    given = sum(value if name.startswith("work") else -value for name, value in rows.items())
    return energy - given - columns["energy_residual"]


@pytest.mark.parametrize("transfer", [MLS, pytest.param(FLIP, marks=CAMPAIGN)])
def test_rows_add_up_for_any_number_of_threads(rng, transfer):
    """The rows of the ledger add up to the change of the energy, to rounding; 1, 2 and 4 threads
    count the same bytes, of three blocks of particles; and these move as without an audit, to
    rounding."""
    runtime.start("cpu", "f64", threads=4)
    seed, tables, places = rng.integers(2**31), set(), []
    solver, plain = (
        jelly(np.random.default_rng(seed), 2, QuadraticBSpline, transfer, "unlike", 36, 4, audited)
        for audited in (True, False)
    )
    x, V0 = solver.particles.to_numpy("x"), solver.particles.to_numpy("V0")
    v = rng.normal(size=x.shape)
    for threads in (1, 2, 4):
        restart(solver, x, v, V0)
        solver.grid.threads = threads
        for field in solver.tally.stored.values():
            field.fill(0.0)
        before, after, columns, _ = counted(solver, 20)
        assert abs(closing(columns, before, after)) < 1e-12 * before["kinetic_energy"]
        stored = solver.tally.stored.values()
        tables.add(b"".join(field.to_numpy().tobytes() for field in stored))
        places.append(solver.particles.to_numpy("x"))
    assert len(tables) == 1
    restart(plain, x, v, V0)
    plain.start(0.1 * plain.grid.dx / JELLY.wave_speed())
    advance(plain, 20)
    assert np.abs(plain.particles.to_numpy("x") - places[0]).max() < 1e-12
