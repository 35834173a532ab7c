"""H8: the outermost particles of a slab lie 1e-3 cells past a node, which sees little else.

Under USL with the linear basis they have a limit of their own, dt <= sqrt(2 x (1 - x)) dx / c with
x = 1e-3: C = 0.045 of FLIP, 0.063 of APIC; MUSL has none, smooth bases one far above C = 0.4.  In
free vibration E <= 1.05 E0 for 1e4 steps (hard_cases.md, H8).  GIMP takes the automatic step."""

import numpy as np
from experiments import schemes

from .case import Case, Draw, Figure, Found
from .scenes import body, clamps, energies, simulate, solid, vector

N, PAST, STRAIN, COURANT, STEPS, CELLS = 8, 1e-3, 1e-3, 0.4, 10_000, 16


def measure(scheme, draw: Draw) -> Found:
    """A slab of 8 x 4 cells, of which one end, drawn, lies so along an axis that is drawn too."""
    axis = int(np.abs(draw.orientation(2)[:, 0]).argmax())
    letter, growth = "XY"[axis], 0.0
    low, high = np.full(2, 4.0), np.full(2, 8.0)
    high[axis] = 4 + N
    shift = draw.rng.choice([-1, 1]) * (0.25 + PAST)  # particles are 0.25 from the edge
    draw.said += f"; shift {shift:g}"
    v, moved = [0.0, 0.0], [0.0, 0.0]
    v[axis], moved[axis] = f"{STRAIN} * cos(pi * ({letter} - 4) / {N})", shift
    bodies = [body("slab", low, high, displacement=vector(moved), velocity=vector(v))]
    given = {} if scheme.basis == "gimp" else {"step": COURANT, "enforce": False}
    end = STEPS * COURANT
    simulation = simulate(
        scheme, [CELLS] * 2, bodies, solid(), end, time=given, output={"every": end / 500}
    )
    first = sum(energies(simulation)).sum()
    for now in simulation.frames():
        growth = max(growth, sum(energies(now)).sum() / first)
        if growth > 1e3:
            break
    return Found([Figure("E / E0", growth, 1.05)], clamps(simulation))


CASE = Case(
    "H8", "Sliver at a node", measure,
    schemes(
        "linear: flip, flip musl; gimp: flip, apic; quadratic: flip, apic, mls; cubic: flip, mls"
    ),
    schemes("linear: flip; quadratic: mls"), fails={"linear flip": "E / E0"},
)  # fmt: skip
