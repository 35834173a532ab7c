"""H20: velocities that nodes do not see, v in the null space of P2G.

Nodes get no momentum: PIC and APIC lose all of it in one step, FLIP keeps it, and a blend keeps the
part alpha^(2 n) of the energy after n steps (hard_cases.md, H20)."""

import numpy as np
from experiments import schemes

from mpm_taichi.reference import bases
from mpm_taichi.scene import Method

from .case import Case, Draw, Figure, Found
from .scenes import body, clamps, simulate, solid, vector

PER_CELL, STEPS = 2, 10


def measure(scheme, draw: Draw) -> Found:
    dim = draw.dimension
    shift = draw.offsets(1, dim)[0]
    edge = 3 if dim == 3 and scheme.basis != "cubic" else 4  # of 3 cells cubic splines see all
    low = np.indices([edge * PER_CELL] * dim).reshape(dim, -1).T / PER_CELL + edge
    h, cells = 1 / PER_CELL, 3 * edge
    v = draw.rng.normal(size=(len(low), dim))
    null = null_vectors(low + h / 2 + shift, cells, scheme)
    v = null @ (null.T @ v)
    bodies = [
        body(k, x, x + h, PER_CELL, displacement=vector(shift), velocity=vector(w))
        for k, (x, w) in enumerate(zip(low, v, strict=True))
    ]
    time = {"step": 1e-3}
    simulation = simulate(scheme, [cells] * dim, bodies, solid(), 1.0, time=time)
    start = (simulation.snapshot.velocity**2).sum()
    steps = 1 if scheme.transfer in ("pic", "apic", "mls") else STEPS
    for _ in range(steps):
        simulation.step()
    ratio = (simulation.snapshot.velocity**2).sum() / start
    if scheme.transfer == "flip":
        figure = Figure("|KE ratio - 1|", abs(ratio - 1), 1e-12)
    elif scheme.transfer == "flip 0.99":
        figure = Figure("|KE ratio - a^(2n)|", abs(ratio - 0.99 ** (2 * STEPS)), 1e-9)
    else:
        figure = Figure("KE ratio", ratio, 1e-12)
    return Found([figure], clamps(simulation))


def null_vectors(x, cells, scheme) -> np.ndarray:
    """[particles, n]: v with sum_p w_ip v_p = 0 for all nodes i, the particles having one mass."""
    twin = getattr(bases, Method.model_validate(scheme.method).basis_class.__name__)
    P2G = np.ones((1, len(x)))
    for axis in range(x.shape[1]):
        first = twin.first(x[:, axis])
        w = twin.weights(x[:, axis] - first, 0.5 / PER_CELL)
        rows = np.zeros((cells + 4, len(x)))
        for k, weight in enumerate(w):
            rows[first.astype(int) + k, np.arange(len(x))] += weight
        P2G = (P2G[:, None] * rows[None]).reshape(-1, len(x))
    P2G = P2G[P2G.any(axis=1)]
    _, s, V = np.linalg.svd(P2G)
    return V[(s > 1e-12 * s[0]).sum() :].T


CASE = Case(
    "H20", "Null space", measure,
    schemes(
        "linear: pic, flip, flip 0.99; gimp: flip, apic",
        "quadratic: pic, flip, flip 0.99, apic, mls; cubic: flip, mls",
    ),
    schemes("quadratic: flip 0.99, mls"), precisions=("f64",), dimensions=(2, 3),
)  # fmt: skip
