"""H8: a slab whose last particles lie 1e-3 cells past a node.

That node has nearly no mass: hats give it w = 1e-3 of those particles, while the slope of w, and so
the force, is that of any other.  Under USL its velocity is taken for the strain at once,

    strain <- (1 - C^2 / w) strain + ...,     C = c dt / dx

which grows for C > sqrt(2 w) = 0.045 (FLIP; hard_cases.md, H8).  MUSL takes the strain from the
velocities of the particles, mapped to the nodes once more: w cancels.  Smooth bases have w of the
order of the slope squared.  C = 0.4 in all rows but those of GIMP, which take automatic steps; the
limit of FLIP is found from both sides too, at 0.98 and 1.02 of it, and above it the run tells of
the node.

The slab swings in its first mode, by less than 1e-5 cells: w stays.  Energy at most 1.05 of its
start for 1e4 steps (1e3 with --quick); it is 16 cells thick, since speeds lag half a step behind
strains, which makes E swing by (w dt / 2) / (1 - w dt / 2) = 4 % (numerics.md, chapter 6)."""

import numpy as np
from experiments import schemes

from mpm_taichi.errors import RunError

from .case import Case, Draw, Figure, Found
from .scenes import along, body, clamps, simulate, solid, strip

THICK, LOW, PAST, STRAIN, COURANT, STEPS = 16, 3, 1e-3, 1e-6, 0.4, 10_000
LAST = 0.25
"""Between the last particles and the face of the slab [cells]."""


def measure(scheme, draw: Draw) -> Found:
    axis, upwards = draw.axis()

    def swing(courant):
        return swinging(scheme, courant, axis, upwards, draw)

    largest, _, counts = swing(None if scheme.basis == "gimp" else COURANT)
    figures = [Figure("E / E0", largest, 1.05)]
    if str(scheme) == "linear flip":
        limit = np.sqrt(2 * PAST)
        largest, told, _ = swing(0.98 * limit)
        figures.append(Figure("E / E0 at 0.98 of sqrt(2 w)", largest, 1.05))
        figures.append(Figure("slivers told", told, 0))
        largest, told, _ = swing(1.02 * limit)
        figures.append(Figure("E / E0 at 1.02", largest, 10.0, at_least=True))
        figures.append(Figure("slivers told", told, 1, at_least=True))
    return Found(figures, counts)


def swinging(scheme, courant, axis, upwards, draw):
    """The largest energy over that of the start; how often slivers were told; what was clamped."""
    dim, length = draw.dimension, THICK + 2 * LOW
    cells, domain = strip(length, axis, dim)
    shift = PAST + LAST if upwards else -PAST - LAST
    slab = body(
        "slab", along(axis, dim, LOW), along(axis, dim, LOW + THICK, 1.0),
        displacement=along(axis, dim, shift),
        velocity=along(axis, dim, f"{STRAIN} * cos(pi * ({'XYZ'[axis]} - {LOW}) / {THICK})"),
    )  # fmt: skip
    steps = {} if courant is None else {"step": float(courant), "enforce": False}
    end = (STEPS // 10 if draw.quick else STEPS) * (courant or 0.1)
    simulation = simulate(
        scheme, cells, [slab], solid(0.0), end, time=steps, domain=domain,
        output={"every": end / 200},
    )  # fmt: skip
    first, largest = energy(simulation), 0.0
    try:
        for now in simulation.frames():
            largest = max(largest, energy(now) / first)
            if largest > 1e6:
                break
    except RunError:
        largest = np.inf
    return largest, simulation.lookout.slivers, clamps(simulation)


def energy(simulation) -> float:
    """[J], as sums over f64 terms of the device."""
    found = simulation.sums
    return float(found["kinetic_energy"].sum() + found["elastic_energy"].sum())


CASE = Case(
    "H8", "Sliver at a node", measure,
    schemes(
        "linear: flip, flip musl, flip usf; gimp: flip, apic",
        "quadratic: flip, flip musl, apic, mls; cubic: flip, apic, mls",
    ),
    schemes("linear: flip, flip musl; quadratic: mls"), fails={"linear flip": "E / E0"},
    dimensions=(2, 3),
)  # fmt: skip
