"""How long a step may be, and why.

Limits from numerics.md, chapters 4 and 5, each for the undeformed material and the largest speed:

    acoustic           0.9 b dx / (c + |v|)          b: bulk limit of the basis, c: wave speed
    isolated particle  l dx sqrt(rho / M_d)          l: limit of transfer and basis for one particle
    travel             0.5 dx / |v|
    gravity            sqrt(0.5 dx / |g|)
    viscosity          rho dx^2 / (4 eta)
"""

from math import hypot, inf, sqrt
from typing import Any, NamedTuple

GROWTH = 1.02
"""The length that an automatic step may have shrinks at once and grows by at most this factor from
one step to the next: steps that follow the phase of an oscillation would feed energy into it.
Steps are cut further, at most in half, to land on outputs."""


HUGE = 1e300
"""A limit [s] that limits nothing."""


class Limit(NamedTuple):
    """A step of `seconds` is the longest that `name` allows, because of `cause`."""

    name: str
    seconds: float
    cause: str


class Pace(NamedTuple):
    """The rule of the length of a step as numbers, for the device: `given` [s], or 0 and the limits
    acoustic / (wave_speed + |v|), travel / |v| and constant [s], times `safety`, at most `growth`
    times the last."""

    given: float
    safety: float
    acoustic: float  # m
    wave_speed: float  # m/s
    travel: float  # m
    constant: float  # s
    growth: float


def limits(materials, basis, transfer, dx, gravity, speed, half_width) -> list[Limit]:
    """All limits, shortest first.  `materials`: name -> material; speed [m/s] of the fastest,
    half_width [cells] of the smallest particle."""
    found = []
    for name, material in materials.items():
        c = material.wave_speed()
        found.append(
            Limit("acoustic", 0.9 * basis.bulk_limit * dx / (c + speed), f"material {name}")
        )
        isolated = transfer.isolated_limit(basis, half_width)
        if isolated is not None:
            stiffness = material.dilatation_modulus(len(gravity))
            seconds = isolated * dx * sqrt(material.density / stiffness)
            found.append(Limit("isolated particle", seconds, f"material {name}"))
        if material.shear_viscosity() > 0:
            seconds = 0.25 * material.density * dx**2 / material.shear_viscosity()
            found.append(Limit("viscosity", seconds, f"material {name}"))
    if speed > 0:
        found.append(Limit("travel", 0.5 * dx / speed, f"speed {speed:.3g} m/s"))
    if any(gravity):
        found.append(Limit("gravity", sqrt(0.5 * dx / hypot(*gravity)), "gravity"))
    return sorted(found, key=lambda limit: limit.seconds)


KEPT = ("last", "shortest", "longest", "too_long", "reduction")
"""Of a TimeStep, in a checkpoint."""


class TimeStep:
    """Chooses the length of each step: as given, or `safety` times the shortest limit.

    half_width [cells]: of the smallest particle, which a basis may take as extended.  `reduction`
    shortens all of them, after an attempt that has failed."""

    def __init__(self, scene, given, safety, half_width=0.25):
        self.scene, self.given, self.safety, self.half_width = scene, given, safety, half_width
        self.last = inf
        self.shortest, self.longest, self.too_long = inf, 0.0, 0
        self.reduction = 1.0  # after a failed attempt

    def limits(self, speed):
        """All limits at the largest speed [m/s], of the materials that bodies have."""
        method = self.scene.method
        used = {body.material: self.scene.materials[body.material] for body in self.scene.bodies}
        return limits(
            used, method.basis_class, method.transfer_class,
            self.scene.cell_size, self.scene.gravity_vector, speed, self.half_width,
        )  # fmt: skip

    @property
    def pace(self) -> Pace:
        """The same rule as `choose`."""
        dx, at_rest = self.scene.cell_size, self.limits(0.0)
        fixed = [limit.seconds for limit in at_rest if limit.name != "acoustic"]
        acoustic = 0.9 * self.scene.method.basis_class.bulk_limit * dx
        wave_speed = max(acoustic / limit.seconds for limit in at_rest if limit.name == "acoustic")
        return Pace(
            given=self.reduction * (self.given or 0.0), safety=self.reduction * self.safety,
            acoustic=acoustic, wave_speed=wave_speed,
            travel=0.5 * dx, constant=min(fixed, default=HUGE), growth=GROWTH,
        )  # fmt: skip

    def choose(self, speed: float) -> float:
        """The longest step [s] that may be taken at the largest speed [m/s]."""
        if self.given is not None:
            return self.reduction * self.given
        safe = self.reduction * self.safety * self.limits(speed)[0].seconds
        self.last = min(safe, GROWTH * self.last)
        return self.last

    def describe(self, speed: float, dt: float) -> list[str]:
        """What the first step is and why, in words."""
        shortest = self.limits(speed)[0]
        binding = f"{shortest.name} limit {shortest.seconds:.3g} s ({shortest.cause})"
        if self.given is None:
            lines = [f"time step {dt:.4g} s: auto, at most {self.safety:g} of the {binding}"]
        else:
            lines = [f"time step {dt:.4g} s: given; {binding}"]
        if self.given is not None and self.given > shortest.seconds:
            lines.append(
                f"warning: time.step is {self.given / shortest.seconds:.3g} times the {binding}: "
                "the run may blow up; `step: auto` chooses a stable one"
            )
        method, isolated = self.scene.method, self.scene.method.transfer_class.isolated_limit
        if self.given is None and isolated(method.basis_class, self.half_width) is None:
            lines.append(
                f"the {method.basis} basis has no limit above zero for a lone particle: auto takes "
                "that of a filled body"
            )
        return lines

    def state(self) -> dict[str, Any]:
        """What the steps to come depend on, and what is told of those taken."""
        return {name: getattr(self, name) for name in KEPT}

    def restore(self, state: dict[str, Any]) -> None:
        for name in KEPT:
            setattr(self, name, state[name])

    def note(self, dt: float, limit: Limit) -> None:
        """Remember a step that was taken, and whether, being given, it exceeds the limit at the
        start.  An automatic one obeys the limits of its own moment."""
        self.shortest, self.longest = min(self.shortest, dt), max(self.longest, dt)
        self.too_long += int(self.given is not None and dt > limit.seconds)
