"""H12: a bar is pulled until its particles lose each other.

Exact: P = mu (F - 1 / F), neo-Hookean with nu = 0, whatever the stretch.  The bar bears until the
reaction falls 5 % below it, and the run must tell of it before.

hard_cases.md asks for 0.6 of the stretch at which two particles, half a cell apart, share no node
any more: 1.2 (linear), 1.8 (GIMP), 2.4 (quadratic), 3.6 (cubic), its least certain bound.  No basis
can bear so much: a lattice under tension is unstable from about one particle per cell on, where
nodes that move to and fro strain no particle, but shift where its tension acts.  The eigenvalues of
one step of a stretched lattice (lattice_stability.py) have these growth rates [c / cell]:

    stretch           1.2    1.4    1.8    1.9    2.0    2.4
    quadratic MLS    .002   .000   .002    .16    .30    .68
    quadratic APIC   .003   .02    .01     .10    .31    .43
    quadratic FLIP   .004   .04    .06     .57    .92   1.6
      under MUSL     .02    .07    .12     .60    .92   1.6
    cubic MLS        .000   .000   .000    .03    .11    .24
    cubic FLIP       .000   .002   .000    .23    .51   1.0

and the bar breaks there: at 1.98 (quadratic MLS), 1.83 (FLIP), 2.02 (cubic MLS), 1.79 (GIMP APIC).
So the bound is 1.7 of these, and the run tells of it from a spacing of 0.8 cells on, a stretch of
1.6.  Linear must fail: particles cross cells (numerics.md, chapter 3, row 1), the reaction is 5 %
too small from 1.05 on, which no stretch tells.  So must quadratic FLIP under MUSL: it grows early,
and a pull that takes some thousand times as long as a wave from cell to cell gives it the time; it
is 5 % too weak from 1.3 on.

Grips of 4 cells at both ends are drawn apart by springs, b = k (where they should be - x), from
rest and so slowly (150 times as long as a wave takes through the bar) that all is in balance; the
force of the springs is the reaction, and the stretch that of the gauge between the grips.
Reactions are means over 9 outputs."""

import numpy as np
from experiments import schemes

from mpm_taichi.errors import RunError

from .case import Case, Draw, Figure, Found
from .scenes import along, body, clamps, simulate, solid, strip

GAUGE, GRIP, STRETCH, SPRING = 8, 4, 3.0, 0.09
BEARS = {"linear": 1.2, "gimp": 1.7, "quadratic": 1.7, "cubic": 1.7}
APART = {"linear": 2, "gimp": 3, "quadratic": 4, "cubic": 6}
"""Stretch at which particles share no node."""

MEAN, SEEN_FROM = 9, 1.05
"""Below that stretch the reaction is too small to be compared."""


def measure(scheme, draw: Draw) -> Found:
    """At each of 8 places in the cells (one with --quick); the earliest counts."""
    axis, _ = draw.axis()
    places = draw.offsets(1 if draw.quick else 8, 1)[:, 0]
    found = [pulled(scheme, place, axis, draw) for place in places]
    breaks, told = np.array([each[:2] for each in found]).T
    figures = [
        Figure("stretch that bears", breaks.min(), BEARS[scheme.basis], at_least=True),
        Figure("of that where nodes part", breaks.min() / APART[scheme.basis], np.inf),
        Figure("told / stretch that bears", (told / breaks).max(), 1.0),
    ]
    return Found(figures, found[0][2])


def pulled(scheme, place, axis, draw):
    """The stretch up to which the bar bears 95 % of P, that at which the run tells that particles
    part (infinite: never), and what was clamped."""
    dim, letter = draw.dimension, "XYZ"[axis]
    material = solid(0.0) | {"type": "neo_hookean"}
    mu = 0.5  # of E = 1
    tension = mu * (STRETCH - 1 / STRETCH)
    way = float(1.2 * ((STRETCH - 1) * (GAUGE + GRIP) / 2 + tension / (GRIP * SPRING)))
    room = int(np.ceil(way)) + 3
    low, high = room, room + GAUGE + 2 * GRIP
    cells, domain = strip(high + room, axis, dim)
    end = (50 if draw.quick else 150) * (GAUGE + 2 * GRIP)
    drawn = f"{way!r} * (1 - cos(pi * t / {float(end)!r})) / 2"
    left, right = low + GRIP, high - GRIP
    off = f"{letter} + {float(place)!r} - {letter.lower()}"
    grip = (
        f"{SPRING} * where({letter} < {left}, {off} - {drawn}, "
        f"where({letter} > {right}, {off} + {drawn}, 0))"
    )
    bar = body(
        "bar", along(axis, dim, low), along(axis, dim, high, 1.0),
        displacement=along(axis, dim, float(place)),
    )  # fmt: skip
    simulation = simulate(
        scheme, cells, [bar], material, end, domain=domain, body_force=along(axis, dim, grip),
        output={"every": end / 400},
    )  # fmt: skip
    mass = simulation.snapshot.mass
    X = simulation.initial_position[:, axis]
    ends = [left > X, right < X]
    inner = (left < X) & (right > X)
    edges = [inner & (left + 0.4 > X), inner & (right - 0.4 < X)]
    stretches, forces, told = [], [], np.inf
    try:
        for now in simulation.frames():
            x = now.snapshot.position[:, axis]
            far = way * (1 - np.cos(np.pi * now.time / end)) / 2
            pulls = [
                sign * SPRING * (mass * (X + place + sign * far - x))[grip].sum()
                for sign, grip in zip((-1, 1), ends, strict=True)
            ]
            between = [values[edges[1]].mean() - values[edges[0]].mean() for values in (x, X)]
            stretches.append(between[0] / between[1])
            forces.append(np.mean(pulls))
            if np.isinf(told) and simulation.lookout.parting:
                told = stretches[-1]
            law = mu * (stretches[-1] - 1 / stretches[-1])
            is_broken = stretches[-1] > SEEN_FROM and np.mean(forces[-MEAN:]) < 0.5 * law
            if is_broken or stretches[-1] > 1.05 * STRETCH:
                break
    except RunError:
        pass
    mean, most = np.ones(MEAN) / MEAN, 1 + int(np.argmax(stretches))  # a gauge shortens as it snaps
    stretch, force = (np.convolve(values[:most], mean, "valid") for values in (stretches, forces))
    fallen = (force < 0.95 * mu * (stretch - 1 / stretch)) & (stretch > SEEN_FROM)
    bears = stretch[fallen.argmax()] if fallen.any() else max(stretches)
    return min(bears, STRETCH), told, clamps(simulation)


CASE = Case(
    "H12", "Numerical fracture", measure,
    schemes(
        "linear: flip musl; gimp: flip, apic; quadratic: flip, flip musl, apic, mls",
        "cubic: flip, mls",
    ),
    schemes("quadratic: mls"), dimensions=(2, 3),
    fails=dict.fromkeys(("linear flip musl", "quadratic flip musl"), "stretch that bears"),
)  # fmt: skip
