"""H14: matter turned inside out, and a block crushed at half its speed of sound.

Blocks: one with F = diag(-0.2, 1, 1) all over; one with F = I + 0.5 N with normal N, another for
each particle; and one on which a plate of 50 times the density comes down at c / 2, to where a
fifth of its height is left.

A law that answers to det F <= 0 (`invertible`) goes on, and energy only falls.  It does not relax
to J > 0, as hard_cases.md expects: F <- (I + dt L) F has det F <- det(I + dt L) det F, the rule of
the time step keeps dt |L| below 0.2, so that the factor is positive, and J keeps its sign for ever.
What is turned inside out pulls itself together in space (tau = P F^T is a tension there) until F
vanishes along an axis, and tau with it.  Only a total Lagrangian form could turn it back.  The case
holds codes to that: a particle that changes sides has had a step above the limit.

With hat functions and USL no step is short enough for a node that little matter touches
(numerics.md 4.1; H7, H8), and random stress meets such nodes at once: energy grows 18 times, or
the run ends.  MUSL has no such limit; under the plate it gains 1.4 % where particles cross cells
(H2), reported.

A law in ln J stops, and names the least id of those with J <= 0.  Under the plate J stays above 0
with either law: it is a product of such factors."""

from typing import Any

import numpy as np
from experiments import schemes

from mpm_taichi.errors import MotionError

from .case import Case, Draw, Figure, Found, U
from .scenes import along, body, clamps, simulate, solid, vector

EDGE, GAP, SPEED = 8, 3, 0.5
CRUSHED, REST = (GAP + 0.8 * EDGE) / SPEED, 60.0
"""Times of a crush, and of some four ways of sound through a block and back."""


def measure(scheme, draw: Draw) -> Found:
    dim, count = draw.dimension, per_block(draw.dimension)
    shifts = draw.offsets(3, dim) - 0.5
    flat = np.tile(np.diag(along(0, dim, -1.2)), (count, 1, 1))
    random = draw.rng.normal(scale=0.5, size=(count, dim, dim))
    figures, counts = invertible(scheme, shifts, flat, random)
    stopped, more = in_log(scheme, shifts, random)
    return Found(figures + stopped, counts | more)


def per_block(dim) -> int:
    """Particles."""
    return (2 * EDGE) ** dim


def scene(scheme, law, shifts, end):
    """A block under a plate, and two that rest."""
    dim = shifts.shape[1]
    material = solid() | {"type": law}
    plate = material | {"density": 50, "youngs_modulus": 50 * material["youngs_modulus"]}
    bodies = []
    for k, (x, y) in enumerate(((1, 0), (3, 1), (5, 1))):
        low, moved = EDGE * np.array([x, y, 1][:dim]), shifts[k].copy()
        moved[1] *= k > 0
        bodies.append(body(f"block {k}", low, low + EDGE, displacement=vector(moved)))
    under, over = along(1, dim, EDGE + GAP, EDGE - 2), along(1, dim, EDGE + GAP + 2, 2 * EDGE + 2)
    bodies.append(body("plate", under, over, material="plate", velocity=along(1, dim, -SPEED)))
    more: dict[str, Any] = {"materials": {"plate": plate}, "domain": {"walls": "slip"}}
    cells = EDGE * np.array([7, 3, 3][:dim])
    return simulate(scheme, cells, bodies, material, end, **more)


def put(simulation, number, H) -> None:
    """F = I + H into a block that rests: it answers from the second step on."""
    particles = simulation.solver.particles
    values, id = particles.H.to_numpy(), particles.id.to_numpy()
    mine = id // len(H) == number
    values[mine] = H[id[mine] % len(H)]
    particles.H.from_numpy(values)
    simulation.time_step.see(simulation.solver.stiffness())


def energy(simulation, of=slice(None)) -> float:
    s = simulation.snapshot
    return 0.5 * s.mass[of] @ s.speed[of] ** 2 + s.initial_volume[of] @ s.energy_density[of]


def invertible(scheme, shifts, flat, random):
    """Energy of what rests, and of all to 1 % of its scale.  Signs of J below rounding do not
    count."""
    simulation = scene(scheme, "fixed_corotated", shifts, REST)
    states = {"diag": flat, "random": random}
    for k, H in enumerate(states.values(), 1):
        put(simulation, k, H)
    J = np.linalg.det(np.concatenate([0 * flat, *states.values()]) + np.eye(flat.shape[1]))
    parts = {
        name: slice(k * len(H), (k + 1) * len(H)) for k, (name, H) in enumerate(states.items(), 1)
    }
    parts["all"] = slice(None)
    start = {name: energy(simulation, of) for name, of in parts.items()}
    most, turned, crush = dict.fromkeys(parts, 0.0), 0, Crush(scheme)
    for now in simulation.frames():
        for name, of in parts.items():
            most[name] = max(most[name], energy(now, of) / start[name])
        J_now = now.snapshot.volume_ratio[: len(J)]
        large = np.minimum(np.abs(J), np.abs(J_now)) > 1e3 * U[scheme.precision]
        turned = max(turned, np.sum((J * J_now < 0) & large))
        crush.see(now)
    figures = [Figure(f"E / E0 ({name})", most[name], 1.0) for name in states]
    figures += [Figure("E / E0", most["all"], 1.01), Figure("turned", turned, 0)]
    return figures + crush.figures("invertible"), clamps(simulation)


def in_log(scheme, shifts, random):
    simulation, crush = scene(scheme, "neo_hookean", shifts, CRUSHED), Crush(scheme)
    for now in simulation.frames():
        crush.see(now)
    figures, counts = crush.figures("ln J"), clamps(simulation)
    put(simulation, 2, random)
    simulation.lookout.guard_steps = 1
    J = np.linalg.det(random + np.eye(random.shape[1]))
    first = 2 * len(random) + np.flatnonzero(J <= 0)[0]
    try:
        simulation.step()
        named = None
    except MotionError as error:
        named = error.particle
    return [*figures, Figure("names the first", named == first, 1, at_least=True)], counts


class Crush:
    """What the plate makes of its block."""

    def __init__(self, scheme):
        self.height, self.least, self.bound = 1.0, 1.0, 1e3 * U[scheme.precision]

    def see(self, simulation):
        s = simulation.snapshot
        block = slice(per_block(s.position.shape[1]))
        self.height = min(self.height, s.position[block, 1].max() / EDGE)
        self.least = min(self.least, s.volume_ratio[block].min())

    def figures(self, name):
        return [
            Figure(f"crushed to ({name})", self.height, 0.25),
            Figure(f"least J ({name})", self.least, self.bound, at_least=True),
        ]


CASE = Case(
    "H14", "Inversion", measure,
    schemes(
        "linear: flip, flip musl; gimp: flip, apic; quadratic: flip, apic, mls; cubic: flip, mls"
    ),
    schemes("quadratic: mls"), fails={"linear flip": "finishes or E / E0 (random)"},
    reported=("linear flip musl",), dimensions=(2, 3),
)  # fmt: skip
