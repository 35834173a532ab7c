"""H18: a block on foam, and a block that falls in gas, each with 1000 times the density.

On foam of height h between slip walls the block, of mass m per area, is a mass on a spring of
stiffness M / h: let go at once it moves by (g / w^2) (1 - cos w t), w^2 = M / (h (m + rho h / 3)),
the last term being Rayleigh's share of the foam.  v_ref = g / w.  Nodes that both touch move with
the block, which takes up to half a support from the height of the spring: at most 1.5 / 16 here.

In gas at rest, of one pressure, all falls together with g t until sound from floor and ceiling has
come near: g within 0.1 %; v_ref = g t.  (hard_cases.md has 0.1 % of the whole fall.  Once the gas
is held by the floor the block meets buoyancy, 1e-3 g, and carries gas along, 1.19e-3 g for a
square: no exact answer is within 0.1 % of g.)

Nothing moves faster than 2 v_ref, mass is that of the start to the last bit, and momentum that of
gravity and of the walls, whose impulses are counted, to n k u of what came in (numerics.md 6)."""

from typing import Any

import numpy as np
from experiments import schemes

from mpm_taichi.bases import BASES

from .case import Case, Draw, Figure, Found, U
from .scenes import along, body, clamps, simulate, solid

RATIO = 1000
WIDTH = {2: 20, 3: 8}
"""Of the gas [cells]."""

PRESSURE = 1 / 1.4
"""Of the gas: its sound, too, has speed 1."""


def measure(scheme, draw: Draw) -> Found:
    figures, counts = [], {}
    for name, scene in (("foam", on_foam), ("gas", in_gas)):
        found, more = scene(scheme, draw.dimension)
        figures += [f._replace(name=f"{f.name} ({name})") for f in found]
        counts |= more
    return Found(figures, counts)


def falling(g, dim) -> dict[str, Any]:
    material = solid()
    heavy = material | {"density": RATIO, "youngs_modulus": RATIO * material["youngs_modulus"]}
    return {
        "materials": {"heavy": heavy}, "gravity": along(1, dim, -g), "domain": {"walls": "slip"},
        "output": {"audit": True},
    }  # fmt: skip


def on_foam(scheme, dim):
    """For a half period, to the lowest place."""
    h, thick, width, g = 16, 4, 4, 1.25e-5
    w = np.sqrt(1 / (h * (RATIO * thick + h / 3)))
    bodies = [
        body("foam", [0] * dim, along(1, dim, h, width)),
        body("block", along(1, dim, h), along(1, dim, h + thick, width), material="heavy"),
    ]
    cells, end = along(1, dim, h + thick + 4, width), np.pi / w
    simulation = simulate(scheme, cells, bodies, solid(), end, **falling(g, dim))
    block = simulation.body_of_particle == 1
    start, worst, fastest = height(simulation, block), 0.0, 0.0
    for now in simulation.frames():
        sunk = start - height(now, block)
        worst = max(worst, abs(sunk * w**2 / g - 1 + np.cos(w * now.time)))
        fastest = max(fastest, now.snapshot.speed.max() * w / g)
    support = next(basis.support for basis in BASES if basis.name == scheme.basis)
    figures = [
        Figure("|u - exact| / amp", worst / 2, support / 2 / h),
        Figure("|v| / v_ref", fastest, 2.0),
    ]
    return figures + kept(simulation, scheme), clamps(simulation)


def in_gas(scheme, dim):
    """The block begins under the pressure of the gas."""
    edge, high, g, end = 4, 36, 0.02, 28.0
    cells = np.array(along(1, dim, high, WIDTH[dim]))
    low, top = (cells - edge) / 2, (cells + edge) / 2
    gas = {"type": "gas", "density": 1, "pressure": PRESSURE}
    around = list(boxes_around(low, top, cells))
    bodies = [body(f"gas {k}", *box) for k, box in enumerate(around)]
    lam = solid()["youngs_modulus"] * 0.3 / 1.3 / 0.4
    pressed = PRESSURE / RATIO / (1 + (dim - 1) * lam)  # dim lam + 2 mu, with lam + 2 mu = 1
    u = [f"{-pressed!r} * ({'XYZ'[axis]} - {float(at)!r})" for axis, at in enumerate(low + 2)]
    bodies.append(body("block", low, top, material="heavy", displacement=u))
    simulation = simulate(scheme, cells, bodies, gas, end, **falling(g, dim))
    block = simulation.body_of_particle == len(around)
    fastest, off = 0.0, 0.0
    alone = (high - edge) / 2 - 4  # sound has not come near before
    for now in simulation.frames():
        if now.time:
            fastest = max(fastest, now.snapshot.speed.max() / (g * now.time))
        if 1 < now.time < alone:
            v = now.snapshot.mass[block] @ now.snapshot.velocity[block, 1]
            off = max(off, abs(v / now.snapshot.mass[block].sum() / (-g * now.time) - 1))
    figures = [Figure("|a / g - 1|", off, 1e-3), Figure("|v| / v_ref", fastest, 2.0)]
    return figures + kept(simulation, scheme), clamps(simulation)


def boxes_around(low, top, size):
    """Fill a domain but for the box from `low` to `top`: below and above, then beside it."""
    first, last = np.zeros_like(low), np.array(size, float)
    for axis in (1, 0, 2)[: len(size)]:
        for begin, end in ((first[axis], low[axis]), (top[axis], last[axis])):
            lower, upper = first.copy(), last.copy()
            lower[axis], upper[axis] = begin, end
            yield lower, upper
        first[axis], last[axis] = low[axis], top[axis]


def height(simulation, chosen) -> float:
    s = simulation.snapshot
    return s.mass[chosen] @ s.position[chosen, 1] / s.mass[chosen].sum()


def kept(simulation, scheme) -> list[Figure]:
    s = simulation.snapshot
    dim = s.position.shape[1]
    walls = np.array([simulation.ledger[f"wall_impulse_{axis}"] for axis in "xyz"[:dim]])
    came = s.mass.sum() * np.array(simulation.scene.gravity_vector) * simulation.time
    off = np.abs(s.mass @ s.velocity - came - walls).max()
    scale = np.abs(came).max() + np.abs(walls).max()
    contributions = simulation.step_count * (2 * simulation.solver.basis.support) ** dim
    return [
        Figure("|mass - start|", abs(s.mass.sum() - simulation.start_mass), 0.0),
        Figure("momentum", off / scale, contributions * U[scheme.precision]),
    ]


CASE = Case(
    "H18", "Density 1000:1", measure,
    schemes("linear: flip; gimp: flip, apic; quadratic: flip, apic, mls; cubic: flip, mls"),
    schemes("quadratic: mls"), reported=("linear flip",), dimensions=(2, 3),
)  # fmt: skip
