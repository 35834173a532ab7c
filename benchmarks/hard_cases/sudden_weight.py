"""H4: gravity is switched on at once for a bar of P = E (F - 1) that stands on its fixed end.

Exact: a particle falls freely, u = - g t^2 / 2, until the wave from the wall is there; the tip turns
at 2 H / c, at g H^2 / c^2, and is back at 4 H / c.  g H / c^2, the strain at the foot at rest, is
1 % and 30 %.  Tip within 6 %, energy within 3 % of the work scale, and after 10 periods u = 0 to 0.1
of the static displacement g H^2 / 2 c^2 (hard_cases.md, H4, measured in 1D).  In cells: H = 20,
c = 1; two bars in one grid."""

import numpy as np
from experiments import schemes

from .case import Case, Draw, Figure, Found
from .scenes import body, by_body, clamps, energies, simulate, solid

H, PERIODS, APART = 20, 10, 6
STRAINS = (0.01, 0.30)


def measure(scheme, draw: Draw) -> Found:
    """Along an axis drawn at run time."""
    axis = int(np.abs(draw.orientation(2)[:, 0]).argmax())
    across = "XY"[1 - axis]
    cells = [2 * APART] * 2
    cells[axis] = H + 4
    bodies = []
    for k in range(len(STRAINS)):
        low, high = np.zeros(2), np.full(2, float(H))
        low[1 - axis], high[1 - axis] = APART * k + 2, APART * k + 3
        bodies.append(body(k, low, high))
    g = np.array(STRAINS) / H
    pull: list = [0.0, 0.0]
    pull[axis] = f"-where({across} < {APART}, {float(g[0])!r}, {float(g[1])!r})"
    simulation = simulate(
        scheme, cells, bodies, solid(0.0), PERIODS * 4 * H,
        domain={"walls": {("left", "bottom")[axis]: "sticky"}}, body_force=pull,
        output={"every": H / 20},
    )  # fmt: skip
    X, mass = simulation.snapshot.position, simulation.snapshot.mass
    tips = [np.flatnonzero((simulation.body_of_particle == k) & (X[:, axis] > H - 0.5))
            for k in range(len(STRAINS))]  # fmt: skip
    deepest, residual = np.zeros(2), np.zeros(2)
    scale = by_body(simulation, mass) * g * (2 / 3 * g * H**2)  # the most that gravity does
    u = np.zeros_like(X[:, axis])
    for now in simulation.frames():
        u = X[:, axis] - now.snapshot.position[:, axis]
        if now.time <= 4 * H:
            deepest = np.maximum(deepest, [u[tip].mean() for tip in tips])
        work = g * by_body(now, mass * u)
        kinetic = 0.5 * by_body(now, mass * (now.snapshot.velocity**2).sum(axis=1))
        residual = np.maximum(residual, abs(kinetic + energies(now)[1] - work) / scale)
    left = np.sqrt(by_body(simulation, u**2) / np.diff(simulation.ranges)) / (g * H**2 / 2)
    exact = g * (H**2 - 0.25**2)  # of the particle a quarter of a cell below the end
    figures = []
    for k, strain in enumerate(STRAINS):
        figures += [
            Figure(f"tip ({strain:.0%})", abs(deepest[k] / exact[k] - 1), 0.06),
            Figure(f"energy ({strain:.0%})", residual[k], 0.03),
            Figure(f"u at 10 T ({strain:.0%})", left[k], 0.1),
        ]
    return Found(figures, clamps(simulation))


CASE = Case(
    "H4", "Sudden self-weight", measure,
    schemes(
        "linear: flip; gimp: flip; quadratic: pic, flip musl, flip usf, apic, mls",
        "cubic: flip, mls",
    ),
    schemes("linear: flip; quadratic: pic, mls"),
    fails={
        "linear flip": "energy (1%)", "gimp flip": "energy (30%)", "quadratic pic": "energy (1%)",
        "quadratic flip usf": "u at 10 T (30%)",
    },
    reported=("quadratic apic",),
)  # fmt: skip
