"""The longest stable step of a scene as it is assembled, measured, beside the rule's limits.

A step takes the state y (velocities, their gradients, deformation) to Phi(y), in f64.  What grows
under the linearised step is found by power iteration,

    d <- (Phi(y + s d) - Phi(y)) / s,    |d| = 1,  s = 1e-6,

from a random d, at the state after the first step; particles stay in place.  Rigid motion makes |d|
grow like the number of steps, an unstable mode by a factor each step: a step is unstable where the
last third of STEPS shows a growth of more than `GROWING` per step over the third before.  Its
length is bisected to 2 %."""

from math import inf, sqrt

import numpy as np

from .errors import InputError
from .exact import ELASTIC
from .simulation import Simulation
from .time_step import Motion

MOST_PARTICLES = 20_000
"""Some ten lengths are tried, each for STEPS steps: a minute or two on one core."""

STEPS = 240
GROWING = 1.03
RESOLUTION = 1.02
FARTHEST = 16.0
"""Times the rule's limit: not looked for beyond."""

SMALL = 1e-6


class Linearised:
    """The step of a simulation about the state after its first one."""

    def __init__(self, simulation):
        simulation.step()
        self.solver = solver = simulation.solver
        solver.drift = 0.0  # the order of particles must not change from here on
        self.fields = {
            name: field
            for name, field in solver.particles.stored.items()
            if name in ("x", "H", "rows") or name.startswith("law")
        }
        self.dt_first = simulation.dt
        self.start = self._taken()
        particles, material = solver.particles, solver.particles.groups[0].material
        # Rows are momenta: in units of m c they are of the order of the strain.
        self.unit = particles.m.to_numpy()[:, None, None] * material.wave_speed()
        self.moving = np.zeros(4)
        self.moving[: particles.dim] = 1.0  # lanes; the others are the mass, or nothing

    def _taken(self):
        return {name: field.to_numpy() for name, field in self.fields.items()}

    def _step(self, state, dt, dt_next):
        for name, field in self.fields.items():
            field.from_numpy(state[name])
        self.solver.step(0.0, dt, dt_next)
        self.solver.drift = 0.0
        return self._taken()

    def _scaled(self, name, values):
        """A perturbation in units of strain, without what does not move."""
        return values / self.unit * self.moving if name == "rows" else values

    def growth(self, dt, rng) -> float:
        """Per step of length dt [s]."""
        base = self._step(self.start, self.dt_first, dt)  # its rows carry an impulse for dt
        after, d = self._step(base, dt, dt), {}
        for name in base.keys() - {"x"}:
            d[name] = self._scaled(name, rng.normal(size=base[name].shape))
            if name == "rows":
                d[name] *= self.unit
        sizes, size = [], 0.0
        for _ in range(STEPS):
            length = sqrt(sum((self._scaled(n, v) ** 2).sum() for n, v in d.items()))
            size += np.log(length)
            sizes.append(size)
            disturbed = base | {n: base[n] + SMALL / length * v for n, v in d.items()}
            found = self._step(disturbed, dt, dt)
            d = {n: (found[n] - after[n]) / SMALL for n in d}
            if not all(np.isfinite(v).all() for v in d.values()):
                return inf
        third = STEPS // 3
        return float(np.exp((max(sizes[-third:]) - max(sizes[third:-third])) / third))


def refuse(scene, count) -> None:
    """InputError where the linearised step says nothing, or costs too much."""
    for body in scene.bodies:
        law = scene.materials[body.material]
        if not isinstance(law, ELASTIC):
            raise InputError(
                f"--margin: material {body.material} ({law.type}) flows, tears or is damped in "
                "compression alone, so that no linear step stands for it; elastic laws only"
            )
    if count > MOST_PARTICLES:
        raise InputError(
            f"--margin: takes some {10 * STEPS} steps, for at most {MOST_PARTICLES} particles (the "
            f"scene has {count}): take a coarser grid (--set domain.cells=...)"
        )


def measured_limit(simulation, first, seed=0) -> float:
    """The longest stable step [s], within 2 %, from the guess `first` on; infinite where there is
    none up to `FARTHEST` times it."""
    step, rng = Linearised(simulation), np.random.default_rng(seed)
    low, high, dt = 0.0, inf, first
    while not high < RESOLUTION * low:
        if step.growth(dt, rng) > GROWING:
            high = dt
        else:
            low = dt
        if low >= FARTHEST * first:
            return inf
        if high <= first / FARTHEST**2:
            return 0.0
        dt = 1.3 * low if high == inf else (high / 1.3 if low == 0 else sqrt(low * high))
    return low


def margin(scene) -> str:
    """The measured limit beside the shortest of the rule that is about stability, in words."""
    free = scene.model_copy(
        update={"time": scene.time.model_copy(update={"step": "auto", "enforce": True})}
    )
    simulation = Simulation(free, precision="f64", threads=1)
    refuse(scene, simulation.ranges[-1])
    rule = simulation.time_step.limits(Motion())
    shortest = next(each for each in rule if each.name != "gravity")
    found = measured_limit(simulation, shortest.seconds)
    words = f"the {shortest.name} limit {shortest.seconds:.4g} s ({shortest.cause})"
    if found == inf:
        return f"measured limit: none up to {FARTHEST:g} times {words}"
    if found == 0:
        return f"measured limit: none above 1 / {FARTHEST**2:g} of {words}"
    return f"measured limit {found:.4g} s (2 %), {found / shortest.seconds:.3g} times {words}"
