"""H1: a block without stress flies through at least 40 cells.

Exact: F = I, the center of mass moves by v t, and the kinetic energy stays.  Weights sum to 1 and
their gradients to 0 but for rounding, so that errors are n u after n steps (hard_cases.md, H1)."""

from typing import Any

import numpy as np
from experiments import schemes

from .case import Case, Draw, Figure, Found, U
from .scenes import body, by_body, clamps, simulate, solid, vector

WAY, EDGE, APART = 40, 8, 12  # cells
SPEED = 0.01


def measure(scheme, draw: Draw) -> Found:
    """Blocks of 8 offsets in one domain."""
    shifts = draw.offsets(8, 2)
    v = draw.orientation(2) @ [1.7 * SPEED, -0.9 * SPEED]
    places = np.stack(np.meshgrid(range(3), range(3)), axis=-1).reshape(-1, 2)[:8] * APART + 2
    end, bodies = WAY / (1.7 * SPEED), []
    for k, (low, shift) in enumerate(zip(places + WAY * (v < 0), shifts, strict=True)):
        moved: dict[str, Any] = {"displacement": vector(shift), "velocity": vector(v)}
        bodies.append(body(k, low, low + EDGE, **moved))
    simulation = simulate(scheme, [3 * APART + WAY + 4] * 2, bodies, solid(), end)
    weight = simulation.snapshot.mass[:, None]

    def centers():
        return by_body(simulation, weight * simulation.snapshot.position)

    def kinetic():
        return by_body(simulation, weight[:, 0] * (simulation.snapshot.velocity**2).sum(axis=1))

    mass = by_body(simulation, weight)
    start, first = centers() / mass, kinetic()
    strain = 0.0
    for now in simulation.frames():
        strain = max(strain, np.abs(now.snapshot.deformation_gradient - np.eye(2)).max())
    off = np.linalg.norm(centers() / mass - start - v * simulation.time, axis=1).max()
    rounding = simulation.step_count * U[scheme.precision]
    figures = [
        Figure("max |F - I|", strain, 1e-11 if scheme.precision == "f64" else 1e-4),
        Figure("COM error / path", off / np.linalg.norm(v * simulation.time), rounding),
        Figure("KE loss", np.abs(1 - kinetic() / first).max(), rounding),
    ]
    return Found(figures, clamps(simulation))


CASE = Case(
    "H1", "Free flight", measure,
    schemes(
        "linear: flip; gimp: flip, apic; quadratic: pic, flip, flip 0.99, xpic 2, apic, tpic, mls",
        "cubic: flip, apic, mls",
    ),
    schemes("linear: flip; quadratic: mls"),
)  # fmt: skip
