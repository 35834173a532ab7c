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
from .scenes import body, clamps, simulate, solid

RATIO = 1000
PRESSURE = 1 / 1.4
"""Of the gas: its sound, too, has speed 1."""


def measure(scheme, _draw: Draw) -> Found:
    figures, counts = [], {}
    for name, scene in (("foam", on_foam), ("gas", in_gas)):
        found, more = scene(scheme)
        figures += [f._replace(name=f"{f.name} ({name})") for f in found]
        counts |= more
    return Found(figures, counts)


def falling(g) -> dict[str, Any]:
    material = solid()
    heavy = material | {"density": RATIO, "youngs_modulus": RATIO * material["youngs_modulus"]}
    return {
        "materials": {"heavy": heavy}, "gravity": [0.0, -g], "domain": {"walls": "slip"},
        "output": {"audit": True},
    }  # fmt: skip


def on_foam(scheme):
    """For a half period, to the lowest place."""
    h, thick, width, g = 16, 4, 4, 1.25e-5
    w = np.sqrt(1 / (h * (RATIO * thick + h / 3)))
    bodies = [
        body("foam", [0, 0], [width, h]),
        body("block", [0, h], [width, h + thick], material="heavy"),
    ]
    cells, end = [width, h + thick + 4], np.pi / w
    simulation = simulate(scheme, cells, bodies, solid(), end, **falling(g))
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


def in_gas(scheme):
    """The block begins under the pressure of the gas."""
    edge, (width, high), g, end = 4, (20, 36), 0.02, 28.0
    low = np.array([(width - edge) / 2, (high - edge) / 2])
    top = low + edge
    gas = {"type": "gas", "density": 1, "pressure": PRESSURE}
    around = [
        ([0, 0], [width, low[1]]), ([0, top[1]], [width, high]),
        ([0, low[1]], [low[0], top[1]]), ([top[0], low[1]], [width, top[1]]),
    ]  # fmt: skip
    bodies = [body(f"gas {k}", *box) for k, box in enumerate(around)]
    lam = solid()["youngs_modulus"] * 0.3 / 1.3 / 0.4
    pressed = PRESSURE / RATIO / (1 + lam)  # 2 (lam + mu), with lam + 2 mu = 1
    u = [f"{-pressed!r} * ({axis} - {float(at)!r})" for axis, at in zip("XY", low + 2, strict=True)]
    bodies.append(body("block", low, top, material="heavy", displacement=u))
    simulation = simulate(scheme, [width, high], bodies, gas, end, **falling(g))
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


def height(simulation, chosen) -> float:
    s = simulation.snapshot
    return s.mass[chosen] @ s.position[chosen, 1] / s.mass[chosen].sum()


def kept(simulation, scheme) -> list[Figure]:
    s = simulation.snapshot
    walls = np.array([simulation.ledger[f"wall_impulse_{axis}"] for axis in "xy"])
    came = s.mass.sum() * np.array(simulation.scene.gravity_vector) * simulation.time
    off = np.abs(s.mass @ s.velocity - came - walls).max()
    scale = np.abs(came).max() + np.abs(walls).max()
    contributions = simulation.step_count * 4 * simulation.solver.basis.support**2
    return [
        Figure("|mass - start|", abs(s.mass.sum() - simulation.start_mass), 0.0),
        Figure("momentum", off / scale, contributions * U[scheme.precision]),
    ]


CASE = Case(
    "H18", "Density 1000:1", measure,
    schemes("linear: flip; gimp: flip, apic; quadratic: flip, apic, mls; cubic: flip, mls"),
    schemes("quadratic: mls"), reported=("linear flip",),
)  # fmt: skip
