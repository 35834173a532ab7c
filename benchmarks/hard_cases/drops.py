"""H22: a drop that is torn in two, and water that is thrown from floor to ceiling.

The halves of a drop fly apart at 0.05 c each; without tension nothing but the first moments slows
them.  Once the gap between them is wider than a support they share no node: the speed of each
center of mass stays to 1e-6.

Gravity turns round ten times, and at the end the water lies on the floor again, h deep.  Its volume
is told by the height of its center of mass, h / 2, within 5 % (hard_cases.md, H22), and by J, the
mean of which lies between 0.95 and 1.05.  What tension was cut off is counted, as the document
asks.

The second half fails, whatever the scheme, by what the law says of itself (materials/fluid.py): J
leaves out the gaps that open, so that what closes them meets pressure at once.  Each impact throws
particles apart; where they fall back they press as if they filled the space between them.  A layer
4 cells deep comes to rest two to three times as deep, with J within 1 % of 1: particles are
right about their own volume and nobody asks for that of all."""

from typing import Any

import numpy as np
from experiments import schemes

from mpm_taichi.bases import BASES

from .case import Case, Draw, Figure, Found
from .scenes import body, clamps, simulate, vector

FLUID = {"type": "fluid", "density": 1, "bulk_modulus": 1}
THROWS = {True: 2, False: 10}
"""With --quick, and without."""


def measure(scheme, draw: Draw) -> Found:
    figures, counts = torn(scheme, draw)
    thrown_figures, more = thrown(scheme, draw)
    return Found(figures + thrown_figures, counts | more)


def torn(scheme, draw: Draw):
    cells, middle, v, end = (80, 16), 40, 0.05, 320.0
    shift = draw.offsets(1, 2)[0] - 0.5
    drop: dict[str, Any] = {
        "name": "drop", "material": "solid",
        "shape": {"type": "ball", "center": [middle, cells[1] / 2], "radius": 4},
        "particles": {"type": "lattice", "per_cell": 2}, "displacement": vector(shift),
        "velocity": [f"where(X < {middle}, {-v}, {v})", "0"],
    }  # fmt: skip
    simulation = simulate(scheme, cells, [drop], FLUID, end)
    right = simulation.snapshot.position[:, 0] > middle + shift[0]
    support = next(basis.support for basis in BASES if basis.name == scheme.basis)
    speeds, gap = [], 0.0
    for now in simulation.frames():
        x = now.snapshot.position[:, 0]
        gap = x[right].min() - x[~right].max()
        if gap > support:
            speeds.append([now.snapshot.velocity[half].mean(axis=0) for half in (right, ~right)])
    apart = np.ptp(speeds, axis=0).max() / v if len(speeds) > 1 else np.inf
    return [Figure("change of speed", apart, 1e-6)], clamps(simulation)


def thrown(scheme, draw: Draw):
    """Each throw lasts one and a half times as long as water falls to the other side."""
    width, depth, high, g = 16, 4, 12, 3e-4
    turn = 1.5 * np.sqrt(2 * (high - depth) / g)
    last = THROWS[draw.quick] * turn
    up = f"where(t / {2 * turn} - floor(t / {2 * turn}) < 0.5, {g}, {-g})"
    sections: dict[str, Any] = {
        "domain": {"walls": "separate"}, "body_force": ["0", f"where(t < {last}, {up}, {-g})"],
    }  # fmt: skip
    water = body("water", [0, 0], [width, depth])
    simulation = simulate(scheme, [width, high], [water], FLUID, last + 3 * turn, **sections)
    simulation.run()
    s = simulation.snapshot
    J = s.initial_volume @ s.volume_ratio / s.initial_volume.sum()
    figures = [
        Figure("|mean J - 1|", abs(J - 1), 0.05),
        Figure("volume", s.position[:, 1].mean() / (depth / 2) - 1, 0.05),
    ]
    return figures, clamps(simulation)


ALL = schemes("linear: flip; gimp: flip, apic; quadratic: pic, flip, apic, mls; cubic: flip, mls")
CASE = Case(
    "H22", "Drops in tension", measure, ALL, schemes("quadratic: mls"),
    fails=dict.fromkeys(map(str, ALL), "volume"), clamps=True,
)  # fmt: skip
