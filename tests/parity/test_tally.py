"""What the audit adds up, against the twin, f64 with fast-math off."""

import numpy as np
import pytest

from mpm_taichi.expressions import Expressions

from .states import build
from .test_stages import DT, three_steps

CAMPAIGN = [pytest.mark.slow, pytest.mark.campaign]
CASES = [
    (2, "QuadraticBSpline", "MLS", "usl"),
    pytest.param(2, "QuadraticBSpline", "FLIPBlend", "musl", marks=CAMPAIGN),
    pytest.param(2, "GIMP", "APIC", "usf", marks=CAMPAIGN),
    pytest.param(2, "QuadraticBoundary", "TPIC", "usl", marks=CAMPAIGN),
    pytest.param(3, "Linear", "FLIP", "usl", marks=CAMPAIGN),
    pytest.param(3, "CubicBSpline", "MLS", "usl", marks=CAMPAIGN),
]


@pytest.mark.parametrize(("dim", "basis", "transfer", "order"), CASES)
def test_tallies_equal_the_twin(exact, rng, dim, basis, transfer, order):
    """Three steps of unequal length of two clouds between walls of every kind, under gravity and a
    body force: energies to 1e-12 of the largest, momenta to 1e-12 of sum m |v|."""
    force = Expressions(["3*sin(X + 2*y) - t", "x*Y + 40*t**2", "x"][:dim], dim=dim)
    fast, twin = build(
        rng, dim, basis, transfer, stress_update=order, body_force=force, audited=True
    )
    three_steps(fast, twin, DT * (0.5 + rng.random(4)))
    ours, theirs = fast.tally.totals(), twin.tally.totals()
    particles = twin.particles
    scale = {
        "energy": theirs["given"][0],
        "momentum": particles.m @ np.linalg.norm(particles.v, axis=1),
    }
    energies = {"given", "held", "end", "cut", "work", "kinetics", "kinetic", "pushing", "images"}
    assert {name for name in ours if ours[name].size} == {n for n in theirs if theirs[n].size}
    for name in ours:
        largest = scale["energy" if name in energies else "momentum"]
        assert np.abs(ours[name] - theirs[name]).max() < 1e-12 * largest, name
    assert all(theirs[name].any() for name in ("given", "work", "impulse", "turn", "push", "path"))
