"""From which stretch on is a bar unstable for want of particles?

    python benchmarks/lattice_stability.py

A lattice of particles under uniform tension, two per cell before it was stretched, in a row of
cells that closes on itself: 1D, neo-Hookean with nu = 0, E = rho = dx = 1.  The largest eigenvalue
of one short step, USL where nothing is said, whose Jacobian is taken by differences, worst of
several places in the cells, gives the growth rate of what was disturbed [c / cell].  NumPy alone,
written for this: hard case H12 is judged by it."""

import numpy as np
from tables import markdown

CELLS, PER_CELL, PLACES, COURANT, SMALL = 24, 2, 6, 0.1, 1e-6
STRETCHES = (1.0, 1.2, 1.4, 1.8, 1.9, 2.0, 2.4, 3.0)
INVERSE_MOMENT = {"quadratic": 4.0, "cubic": 3.0}


def quadratic(x):
    """First nodes, weights and slopes."""
    first = np.floor(x - 0.5)
    a = x - first
    w = [0.5 * (1.5 - a) ** 2, 0.75 - (a - 1) ** 2, 0.5 * (a - 0.5) ** 2]
    return first.astype(int), w, [a - 1.5, 2 - 2 * a, a - 0.5]


def cubic(x):
    first = np.floor(x) - 1
    t = x - first - 1
    w = [(1 - t) ** 3, 3 * t**3 - 6 * t**2 + 4, -3 * t**3 + 3 * t**2 + 3 * t + 1, t**3]
    dw = [-((1 - t) ** 2) / 2, 1.5 * t**2 - 2 * t, -1.5 * t**2 + t + 0.5, t**2 / 2]
    return first.astype(int), [each / 6 for each in w], dw


def step(state, basis, transfer, dt):
    """x, v, C, F of the particles, one after the other."""
    x, v, C, F = state.reshape(4, -1)
    first, w, dw = {"quadratic": quadratic, "cubic": cubic}[basis](x)
    D_inverse, m = INVERSE_MOMENT[basis], 1 / PER_CELL
    impulse = -dt * m * 0.5 * (F**2 - 1)
    nodes = [((first + k) % CELLS, first + k - x, w[k], dw[k]) for k in range(len(w))]
    mass, momentum, pushed = np.zeros((3, CELLS))
    for i, r, wk, dwk in nodes:
        np.add.at(mass, i, wk * m)
        np.add.at(momentum, i, wk * m * (v + C * r))
        np.add.at(pushed, i, impulse * (D_inverse * r * wk if transfer == "mls" else dwk))
    old, new = momentum / mass, (momentum + pushed) / mass
    moved = sum(wk * new[i] for i, r, wk, dwk in nodes)
    moment = D_inverse * sum(wk * new[i] * r for i, r, wk, dwk in nodes)
    L = moment if transfer == "mls" else sum(dwk * new[i] for i, r, wk, dwk in nodes)
    if "flip" in transfer:
        v, moment = v + sum(wk * (new - old)[i] for i, r, wk, dwk in nodes), 0 * v
    else:
        v = moved
    if "musl" in transfer:
        again = np.zeros(CELLS)
        for i, _, wk, _ in nodes:
            np.add.at(again, i, wk * m * v)
        L = sum(dwk * (again / mass)[i] for i, r, wk, dwk in nodes)
    return np.concatenate([x + dt * moved, v, moment, F * (1 + dt * L)])


def growth(basis, transfer, stretch) -> float:
    """[c / cell]"""
    count = round(CELLS * PER_CELL / stretch)
    stretch, dt, worst = CELLS * PER_CELL / count, COURANT / stretch, 0.0
    for place in np.arange(PLACES) / PLACES + 0.01:
        x = (np.arange(count) + place) * CELLS / count
        state = np.concatenate([x, np.zeros(2 * count), np.full(count, stretch)])
        changes = SMALL * np.eye(len(state))
        columns = [
            (step(state + d, basis, transfer, dt) - step(state - d, basis, transfer, dt))
            for d in changes
        ]
        values = np.linalg.eigvals(np.array(columns).T / (2 * SMALL))
        worst = max(worst, float(np.log(np.abs(values).max()) / dt))
    return worst


if __name__ == "__main__":
    print(markdown(
        ("growth [c / cell] at stretch", *(f"{stretch:g}" for stretch in STRETCHES)),
        [
            [f"{basis} {transfer}", *(f"{growth(basis, transfer, s):.3f}" for s in STRETCHES)]
            for basis in INVERSE_MOMENT for transfer in ("mls", "apic", "flip", "flip musl")
        ],
    ))  # fmt: skip
