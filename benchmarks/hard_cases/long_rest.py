"""H6: a block rests on a slip floor for 1e6 steps, in f32: does it creep?

Edge 8 cells of 1 cm, E = 1e5 Pa, rho = 1e3 kg/m^3, g = 9.81 m/s^2, nu = 0; in units of the suite
g = rho g dx / E = 9.81e-4.  It begins in the exact equilibrium of P = E (F - 1):
u = - g (H Y - Y^2 / 2) along the height Y, and nothing across.  In 3D it is 2 cells across, and
rests for 2e5 steps.

Drift at most 1e-3 cells in 1e5 steps, along any axis, without a trend that chance would make in
less than one of 500 runs; |v| <= 1e-4 sqrt(g H) (hard_cases.md, H6).  What the grid makes of the
equilibrium differs from it, so that the block first swings, which USL damps: of FLIP in 3D |v| is
2.1e-4 sqrt(g H) after 5e3 steps, 1.0e-4 after 3e4, 5e-5 after 6e4.  The first fifth does not
count."""

from typing import Any

import numpy as np
from experiments import schemes

from .case import Case, Draw, Figure, Found
from .scenes import along, body, clamps, simulate, solid, vector
from .trend import CHANCE, trend

EDGE, G, STEP = 8, 9.81e-4, 0.3
ACROSS = {2: 8, 3: 2}
"""Edges of the floor [cells]."""

STEPS, QUICK = {2: 1_000_000, 3: 200_000}, 10_000
"""The latter with --quick."""


def measure(scheme, draw: Draw) -> Found:
    dim, across = draw.dimension, ACROSS[draw.dimension]
    shift = vector(draw.offsets(1, dim - 1)[0] - 0.5)
    steps = QUICK if draw.quick else STEPS[dim]
    sag = f"{-G!r} * ({EDGE} * Y - Y * Y / 2)"
    low, high = along(1, dim, 0, 4), along(1, dim, EDGE, 4 + across)
    block = body("block", low, high, displacement=[shift[0], sag, *shift[1:]])
    sections: dict[str, Any] = {
        "gravity": along(1, dim, -G), "domain": {"walls": {"bottom": "slip"}},
        "time": {"step": STEP, "enforce": False}, "output": {"every": STEP * steps / 200},
    }  # fmt: skip
    cells = along(1, dim, EDGE + 3, across + 8)
    simulation = simulate(scheme, cells, [block], solid(0.0), STEP * steps, **sections)
    places, fastest = [], []
    for now in simulation.frames():
        places.append(now.snapshot.position.mean(axis=0))
        fastest.append(now.snapshot.speed.max())
    settled = slice(len(places) // 5, None)
    slopes, chances = zip(*(trend(x) for x in np.array(places)[settled].T), strict=True)
    drift = np.abs(slopes).max() * 1e5 / (0.8 * steps)
    figures = [
        Figure("drift in 1e5 steps", drift, 1e-3),
        Figure("t of the trend", np.abs(chances).max(), CHANCE),
        Figure("|v| / sqrt(g H)", max(fastest[settled]) / np.sqrt(G * EDGE), 1e-4),
    ]
    return Found(figures, clamps(simulation))


CASE = Case(
    "H6", "Long rest", measure,
    schemes("linear: flip; gimp: flip; quadratic: flip, apic, mls; cubic: flip, mls"),
    schemes("quadratic: mls"), reported=("linear flip",),
    dimensions=(2, 3),
)  # fmt: skip
