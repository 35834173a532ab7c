"""H21: a fluid under pressure, J = 0.9, that fills a closed box and rests, its particles displaced
at random by up to 0.4 of their spacing.

The continuum is in equilibrium; particles out of place press on nodes unevenly.  Waves that nodes
see and particles keep, or the other way round, can feed on the pressure (ringing, Brackbill 1988,
J. Comput. Phys. 75): FLIP heats up to a tenth of the speed of sound, which hard_cases.md expects
of hat functions and leaves open for the others.  MLS and APIC settle: after a transient, a third of
the time, the logarithm of the kinetic energy has no rising trend, and |v| <= 0.05 c (1 - J).  The
fluid carries any tension here: what is cut off would be a clamp, and it calms."""

from typing import Any

import numpy as np
from experiments import schemes

from .case import Case, Draw, Figure, Found
from .scenes import body, clamps, simulate
from .trend import CHANCE, trend

PER_CELL, J, JITTER = 2, 0.9, 0.4
EDGE = {2: 8, 3: 4}
"""Of the box [cells]."""

STEPS = {True: 10_000, False: 100_000}
"""Of 0.3 times the cell over the speed of sound at rest; with --quick, and without."""

FLUID = {"type": "fluid", "density": 1, "bulk_modulus": 1, "tension": 1}


def measure(scheme, draw: Draw) -> Found:
    walls: dict[str, Any] = {"domain": {"walls": "slip"}}
    cells, end = [EDGE[draw.dimension]] * draw.dimension, 0.3 * STEPS[draw.quick]
    box = body("box", [0] * draw.dimension, cells, PER_CELL)
    simulation = simulate(scheme, cells, [box], FLUID, end, **walls)
    press(simulation, draw)
    kinetic, fastest = [], []
    for now in simulation.frames():
        speed = now.snapshot.speed
        kinetic.append(now.snapshot.mass @ speed**2)
        fastest.append(speed.max())
    settled = slice(len(kinetic) // 3, None)
    _slope, t = trend(np.log(kinetic[settled]))
    figures = [
        Figure("t of the slope of ln KE", t, CHANCE),
        Figure("|v| / c", max(fastest[settled]), 0.05 * (1 - J)),
    ]
    return Found(figures, clamps(simulation))


def press(simulation, draw: Draw) -> None:
    """Out of place, and under pressure from the second step on."""
    particles = simulation.solver.particles
    x = particles.x.to_numpy()
    jitter = draw.rng.uniform(-JITTER, JITTER, x.shape) / PER_CELL
    particles.x.from_numpy((x + jitter).astype(x.dtype))
    dim = draw.dimension
    H = np.tile((J ** (1 / dim) - 1) * np.eye(dim), (len(x), 1, 1))
    particles.H.from_numpy(H.astype(x.dtype))
    simulation.time_step.see(simulation.solver.stiffness())


CASE = Case(
    "H21", "Fluid at rest", measure,
    schemes("linear: flip; gimp: flip, apic; quadratic: flip, apic, mls; cubic: flip, apic, mls"),
    schemes("linear: flip; quadratic: mls"), fails={"linear flip": "|v| / c"},
    reported=("gimp flip", "gimp apic", "quadratic flip", "cubic flip"), dimensions=(2, 3),
)  # fmt: skip
