"""Particles that leave the domain: stop, delete, clamp, and the edges of the closed box."""

from itertools import product

import numpy as np
import pytest

from mpm_taichi import Simulation, load_scene
from mpm_taichi.errors import MotionError
from tests.command_line import SCENES

LATTICE = SCENES / "two_disks_lattice.yaml"


def thrown(rule: str, *changes: str):
    """The lower disk flies to the left, out of the domain, at 2 m/s; the upper one stays where it
    is.  Neither has a stress."""
    words = ("bodies[0].velocity=[-2, 0.3]", "bodies[1].velocity=[0, 0]", "time.end=0.4")
    return Simulation(load_scene(LATTICE, [f"domain.outside={rule}", *words, *changes]))


@pytest.mark.slow
@pytest.mark.parametrize("method", ["{basis: linear, transfer: {type: flip}}", "{}"])
def test_deleted_particles_leave_a_ledger(method):
    """All of the lower disk has left after 0.4 s / 2 m/s: 208 particles, 130 kg.  Mass inside plus
    ledger is the mass of the start to the last bit of sums, no particle of the upper disk has
    moved by more than rounding, and a snapshot, a history row and a picture need no special case:
    what is gone has no mass and no place."""
    simulation = thrown("delete", f"method={method}")
    masses = [float(now.body_mass.sum()) for now in simulation.frames()]
    assert (np.diff(masses) <= 0).all()
    snapshot = simulation.snapshot
    gone = snapshot.mass == 0
    assert gone.tolist() == [True] * 208 + [False] * 208
    assert np.isnan(snapshot.visible_position[gone]).all()
    assert masses[0] - masses[-1] == pytest.approx(208 * 0.625, rel=1e-13)
    warning = "particles deleted at the border of the domain, 130 kg"
    assert simulation.warnings()[warning] == 208
    assert np.abs(snapshot.position - simulation.initial_position)[~gone].max() < 1e-12


@pytest.mark.slow
def test_clamped_particles_stay_at_the_border():
    """Nothing is lost: the mass is that of the start, no position lies outside, and the lower disk
    ends in a heap at x = 0, where each arrival was counted."""
    simulation = thrown("clamp", "method={}", "time.end=0.15")
    simulation.run()
    snapshot = simulation.snapshot
    assert snapshot.mass.sum() == pytest.approx(260, rel=1e-14)
    assert (snapshot.position >= 0).all()
    assert (snapshot.position <= 1).all()
    assert (snapshot.position[:208, 0] == 0).sum() > 20
    count = simulation.warnings()["times that a particle was clamped to the border of the domain"]
    assert count > 20


def test_the_box_is_closed_and_ends_there():
    """A particle at exactly 0 or L is inside; one at -1e-18, at the next number after L, or beyond
    all bounds is outside, and is named; none reaches memory that is not the grid's, with the
    stencils of every place around the corners.  Seen in two steps after it was put there."""
    still = ("bodies[0].velocity=[0, 0]", "bodies[1].velocity=[0, 0]")
    simulation = Simulation(load_scene(LATTICE, [*still, "method={}"]))
    state = simulation.state()
    start = {name: field.to_numpy() for name, field in simulation.solver.stored.items()}
    particles = simulation.solver.particles
    place = int(np.flatnonzero(particles.id.to_numpy() == 300)[0])
    for x, inside in (
        (0.0, True), (1.0, True), (-1e-18, False), (np.nextafter(1, 2), False),
        (-1e30, False), (1e30, False), (5.0, False),
    ):  # fmt: skip
        for corner in ([x, x], [x, 0.5], [0.5, x]):
            simulation.restore(state, start)
            positions = particles.x.to_numpy()
            positions[place] = corner
            particles.x.from_numpy(positions)
            particles.rows[place, 0] = [0, 0, particles.m[place], 0]
            if inside:
                simulation.advance(2)
                continue
            with pytest.raises(MotionError, match=r"particle 300 \(body upper.* has left the dom"):
                simulation.advance(2)


@pytest.mark.parametrize("precision", ["f32", "f64"])
def test_what_is_put_in_is_found(precision, rng):
    """NaN, an infinity or 1e30 in the position, deformation or rows of a particle drawn at random:
    a look at all particles names it, with fast-math on.  (1e30 is a place outside and a speed
    beyond the domain; as a deformation it is none.)"""
    simulation = Simulation(load_scene(LATTICE, ["method={}"]), precision=precision)
    simulation.step()
    particles = simulation.solver.particles
    for name, value in product(("x", "H", "rows"), (np.nan, np.inf, -np.inf, 1e30)):
        if value == 1e30 and name != "H":
            continue
        particle = int(rng.integers(416))
        place = int(np.flatnonzero(particles.id.to_numpy() == particle)[0])
        field = getattr(particles, name)
        whole = field.to_numpy()
        spoiled = whole.copy()
        spoiled[place].flat[rng.integers(spoiled[place].size)] = value
        field.from_numpy(spoiled)
        with pytest.raises(MotionError, match=rf"particle {particle} \(") as found:
            simulation.lookout.at_particles()
        assert found.value.particle == particle
        field.from_numpy(whole)
        simulation.lookout.at_particles()
