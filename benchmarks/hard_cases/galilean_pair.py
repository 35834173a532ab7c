"""H2: the same free bar, at rest in the grid and riding through 60 cells.

P = E (F - 1), E = 100, rho = 1, L = 1, N = 20, mode 1 with a strain of 1 %, C = 0.3, 5 periods of
2 L / c.  Both bars must tell the same story: root mean square of the difference at most 0.03 of the
amplitude, energy at most 1.05 of its start.  Linear: 2.9 (FLIP, USF), 4.7 (MUSL), 0.65 (USL) of the
amplitude (hard_cases.md, H2, measured in 1D).  Here in cells: L = 20, c = 1."""

import numpy as np
from experiments import schemes

from .case import Case, Draw, Figure, Found
from .scenes import body, by_body, clamps, energies, simulate, solid, vector

N, STRAIN, PERIODS, RIDE, APART = 20, 0.01, 5, 60, 4
AMPLITUDE = STRAIN * N / np.pi


def measure(scheme, draw: Draw) -> Found:
    """8 offsets, each at rest and riding, in rows that share no node."""
    offsets = draw.offsets(8, 2)
    turn = draw.orientation(2)
    end = PERIODS * 2 * N
    V, bodies = RIDE / end, []
    length, width = N + RIDE + 8, 16 * APART
    axis = int(np.abs(turn[:, 0]).argmax())
    forth = turn[axis, 0]
    cells = [width, width]
    cells[axis] = length
    for k in range(16):
        low, high = np.zeros(2), np.zeros(2)
        low[axis] = 3 if forth > 0 else length - N - 4
        high[axis] = low[axis] + N
        low[1 - axis], high[1 - axis] = APART * k + 1, APART * k + 2
        shift = offsets[k // 2] - 0.5
        shift[1 - axis] *= 0.49
        v = np.zeros(2).tolist()
        letter = "XY"[axis]
        mode = f"{STRAIN} * cos(pi * ({letter} - {float(low[axis])!r}) / {N})"
        v[axis] = f"{float(V * forth * (k % 2))!r} + {mode}"
        bodies.append(body(k, low, high, displacement=vector(shift), velocity=vector(v)))
    simulation = simulate(
        scheme, cells, bodies, solid(0.0), end, time={"step": 0.3, "enforce": False}
    )
    X, worst, growth = simulation.snapshot.position, 0.0, 0.0
    first = sum(energies(simulation))
    count = np.diff(simulation.ranges)[0]
    for now in simulation.frames():
        u = now.snapshot.position - X
        u[:, axis] -= forth * V * now.time * (now.body_of_particle % 2)
        rest, riding = u.reshape(8, 2, count, 2).swapaxes(0, 1)
        off = ((riding - rest) ** 2).sum(axis=-1).mean(axis=-1)
        worst = max(worst, np.sqrt(off.max()) / AMPLITUDE)
        growth = max(growth, np.max(sum(energies(now)) / first))
    mass = by_body(simulation, simulation.snapshot.mass)
    assert np.ptp(mass) < 1e-6 * mass.max()
    return Found(
        [Figure("|u_move - u_rest| / amp", worst, 0.03), Figure("E / E0", growth, 1.05)],
        clamps(simulation),
    )


CASE = Case(
    "H2", "Galilean pair", measure,
    schemes(
        "linear: flip, flip musl, flip usf; gimp: flip, flip musl, apic",
        "quadratic: flip, flip musl, apic, mls; cubic: flip, apic, mls",
    ),
    schemes("linear: flip; quadratic: flip, mls"),
    fails={f"linear flip{order}": "|u_move - u_rest| / amp" for order in ("", " musl", " usf")},
)  # fmt: skip
