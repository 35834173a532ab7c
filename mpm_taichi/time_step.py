"""How long a step may be, and why.

Limits from numerics.md, chapters 4 and 5, for the deformation and the motion of the moment:

    acoustic           0.9 b dx / (c + |v|)          b: bulk limit of the basis, c: wave speed
    isolated particle  l dx sqrt(rho / M_d)          l: limit of transfer and basis for one particle
    travel             0.5 dx / |v|
    deformation        0.2 / |grad v|                Frobenius norm; keeps det(I + dt grad v) > 0
    gravity            sqrt(0.5 dx / |g|)
    viscosity          rho dx^2 / (4 eta)

|v| is the largest speed at which a particle moves, sum_i w_i v_i.  Nodes may be much faster: one
that a particle hardly touches is pushed by T dw / (w m), and dw / w is unbounded; but it gives the
particle only w times that.  Nothing breaks where a particle moves further than half a cell, since
the sort adds up what particles have moved; the motion is only resolved less well.

The motion is that of the step before, of which an impact may make much more within one step: a
reason for `safety`.  Stiffness is looked at anew before that of any particle can have tripled,
which changes c by less than the factor that a safety of 0.5 leaves.
"""

from collections import Counter
from math import hypot, inf, log, sqrt
from typing import Any, NamedTuple

from .errors import InputError

GROWTH = 1.02
"""The length that a step may have shrinks at once and grows by at most this factor from one step to
the next: steps that follow the phase of an oscillation would feed energy into it.  Steps are cut
further, at most in half, to land on outputs."""

MOST_GROWTH = log(3)
"""Of the logarithm of the moduli of any particle between two looks at them."""

HUGE = 1e150
"""A limit [s] that limits nothing, and the inverse of a speed that counts as none."""

BOUNDS = ("given", "growth", "acoustic", "constant", "travel", "deformation")
"""What may bind the length of a step; "constant" is the shortest of the limits that do not depend
on the motion."""


OF_MOTION = ("travel", "deformation")

NAMED = 0.9
"""A limit of motion is told anew, and its particle looked for, when it is shorter by this factor: a
few looks in a run."""


class Motion(NamedTuple):
    """The largest speed |sum_i w_i v_i| [m/s], |grad v| (Frobenius norm) [1/s] and compression
    - div v [1/s] of all particles; the latter is never below 0.  Whose the first two are: places in
    the scene, None where nobody has asked."""

    speed: float = 0.0
    rate: float = 0.0
    compression: float = 0.0
    fastest: int | None = None
    steepest: int | None = None


class Stiffness(NamedTuple):
    """Of a material: the largest rho0 c^2 and M_d [Pa] of its particles, and the places of these
    particles in the scene (None: of the undeformed material)."""

    wave: float
    wave_particle: int | None
    lone: float
    lone_particle: int | None


class Limit(NamedTuple):
    """A step of `seconds` is the longest that `name` allows, because of `cause`, and there of
    `particle` (its place in the scene) if it is about one."""

    name: str
    seconds: float
    cause: str
    particle: int | None = None


class Pace(NamedTuple):
    """The rule of the length of a step as numbers, for the device: at most `longest` [s] and
    `growth` times the last, and `safety` times acoustic / (wave_speed + |v|), constant [s],
    travel / |v|, deformation / |grad v|.  In unit time moduli may grow by the factor exp of the
    larger of stiffening |grad v| and packing (- div v)."""

    longest: float
    safety: float
    acoustic: float  # m
    wave_speed: float  # m/s
    constant: float  # s
    travel: float  # m
    deformation: float
    growth: float
    stiffening: float = 0.0  # of moduli, per strain
    packing: float = 0.0  # of moduli, per compression
    lasting: float = HUGE  # s, of the constant limits that are not about stiffness
    lone: float = HUGE  # m, by the wave speed of a lone particle its limit

    def step(self, motion: Motion, last: float) -> tuple[float, int]:
        """The longest step [s] after one of length `last`, and which of BOUNDS it is."""
        allowed = (
            self.longest,
            self.growth * last,
            self.safety * self.acoustic / max(self.wave_speed + motion.speed, 1 / HUGE),
            self.safety * self.constant,
            self.safety * self.travel / max(motion.speed, 1 / HUGE),
            self.safety * self.deformation / max(motion.rate, 1 / HUGE),
        )
        length = min(allowed)
        return length, allowed.index(length)

    def growth_of_moduli(self, motion: Motion) -> float:
        """At most, as a logarithm, in unit time [1/s]."""
        return max(self.stiffening * motion.rate, self.packing * motion.compression)


class TimeStep:
    """Chooses the length of each step: `safety` times the shortest limit; or as given, shorter
    where a limit asks for it, unless `enforce` is false.

    `counts` tells how many steps each limit has bound, or the given length, or GROWTH; `binders`
    the last limit of each name that did, of those of motion the shortest.  `motion` is that of the
    last step, `growth_left`, as a logarithm, what moduli may grow before they have to be seen;
    half_width [cells]: of the smallest particle, which a basis may take as extended.  `reduction`
    shortens all steps, after an attempt that has failed."""

    def __init__(self, scene, given, safety, half_width=0.25, motion=None, enforce=True):
        self.scene, self.given, self.safety = scene, given, safety
        self.enforce, self.motion = enforce, motion or Motion()
        method = scene.method
        self.isolated = method.transfer_class.isolated_limit(method.basis_class, half_width)
        self.materials = {body.material: scene.materials[body.material] for body in scene.bodies}
        laws = [material.stiffening(scene.dimension) for material in self.materials.values()]
        self.stiffening, self.packing = map(max, *laws, (0.0, 0.0))
        self.reduction = 1.0
        self.last, self.code = inf, 0
        self.shortest, self.longest = inf, 0.0
        self.counts: Counter[str] = Counter()
        self.binding, self.binders = BOUNDS[0], {}
        self.see({
            material: Stiffness(
                material.density * material.wave_speed() ** 2, None,
                material.dilatation_modulus(scene.dimension), None,
            )
            for material in self.materials.values()
        })  # fmt: skip

    def see(self, stiffness: dict[Any, Stiffness]) -> None:
        """The stiffness of each material now: it decides until the next look."""
        self.growth_left = MOST_GROWTH
        self._remember(stiffness)
        others = self.at_rest["constant"]
        self.wave_speed = self._acoustic / self.at_rest["acoustic"].seconds
        self.constant = others.seconds if others else HUGE

    def take_up(self, clock) -> None:
        """What steps of one launch have come to (kernels/whole_steps.py)."""
        self.last, self.motion, self.growth_left = clock.last, clock.motion, clock.growth_left
        if clock.stiffness:
            self._remember(clock.stiffness)
            self.wave_speed, self.constant = clock.pace.wave_speed, clock.pace.constant

    def _remember(self, stiffness):
        self.stiffness = stiffness
        at_rest = self.limits(Motion())
        acoustic = [limit for limit in at_rest if limit.name == "acoustic"]
        others = [limit for limit in at_rest if limit.name != "acoustic"]
        self.at_rest = {"acoustic": acoustic[0], "constant": others[0] if others else None}
        lasting = [limit.seconds for limit in others if limit.name != "isolated particle"]
        self.lasting = min(lasting, default=HUGE)

    @property
    def pace(self) -> Pace:
        """The rule until the next look."""
        free = self.given is not None and not self.enforce
        return Pace(
            longest=HUGE if self.given is None else self.reduction * self.given,
            safety=self.reduction * (self.safety if self.given is None else 1.0),
            acoustic=HUGE if free else self._acoustic, wave_speed=self.wave_speed,
            constant=HUGE if free else self.constant,
            travel=HUGE if free else 0.5 * self.scene.cell_size,
            deformation=HUGE if free else 0.2,
            growth=GROWTH, stiffening=self.stiffening, packing=self.packing,
            lasting=HUGE if free else self.lasting,
            lone=HUGE if free or self.isolated is None else self.isolated * self.scene.cell_size,
        )  # fmt: skip

    @property
    def _acoustic(self):
        return 0.9 * self.scene.method.basis_class.bulk_limit * self.scene.cell_size

    @property
    def is_look_due(self) -> bool:
        """Whether the stiffness may have changed since it was seen."""
        return not self.growth_left > 0

    @property
    def fears_slivers(self) -> bool:
        """Whether a node may be so light that no rule here bounds the step (kernels/slivers.py)."""
        return self.isolated is None and self.scene.method.stress_update == "usl"

    def limits(self, motion: Motion) -> list[Limit]:
        """All limits in a motion, shortest first."""
        dx, gravity, found = self.scene.cell_size, self.scene.gravity_vector, []

        def add(name, seconds, cause, particle=None):
            found.append(Limit(name, seconds, cause, particle))

        for word, material in self.materials.items():
            name, now, rho = f"material {word}", self.stiffness[material], material.density
            speed = max(sqrt(now.wave / rho) + motion.speed, 1 / HUGE)
            add("acoustic", self._acoustic / speed, name, now.wave_particle)
            if self.isolated is not None and now.lone > 0:
                seconds = self.isolated * dx * sqrt(rho / now.lone)
                add("isolated particle", seconds, name, now.lone_particle)
            if material.shear_viscosity() > 0:
                add("viscosity", 0.25 * rho * dx**2 / material.shear_viscosity(), name)
        if motion.speed > 0:
            cause = f"speed {motion.speed:.3g} m/s"
            add("travel", 0.5 * dx / motion.speed, cause, motion.fastest)
        if motion.rate > 0:
            cause = f"velocity gradient {motion.rate:.3g} 1/s"
            add("deformation", 0.2 / motion.rate, cause, motion.steepest)
        if any(gravity):
            add("gravity", sqrt(0.5 * dx / hypot(*gravity)), "gravity")
        return sorted(found, key=lambda limit: limit.seconds)

    def begin(self) -> float:
        """The longest that the first step may be [s]."""
        longest = self.choose()
        self.binding = self._binding(self.code)
        return longest

    def choose(self) -> float:
        """The longest step [s] that may be taken next, after the motion of the last step."""
        self.last, self.code = self.pace.step(self.motion, self.last)
        return self.last

    def move(self, dt: float, motion: Motion) -> None:
        """Take note of the motion in a step."""
        self.motion = motion
        self.growth_left -= dt * self.pace.growth_of_moduli(motion)

    def note(self, lengths, codes) -> None:
        """Remember steps that were taken, and for each which of BOUNDS binds the one after it."""
        for dt, code in zip(lengths, codes, strict=True):
            self.shortest, self.longest = min(self.shortest, dt), max(self.longest, dt)
            self.counts[self.binding] += 1
            self.binding = self._binding(code)

    def _binding(self, code):
        """The name of what binds, and whom that is about."""
        name = BOUNDS[code]
        if name in OF_MOTION:
            limit = next(each for each in self.limits(self.motion) if each.name == name)
            if name in self.binders and limit.seconds > NAMED * self.binders[name].seconds:
                return name
        elif name in ("acoustic", "constant"):
            limit = self.at_rest[name]
        else:
            return name
        self.binders[limit.name] = limit
        return limit.name

    @property
    def is_nameless(self) -> bool:
        """Whether a limit of motion has bound a step, and nobody knows of which particle."""
        found = (self.binders.get(name) for name in OF_MOTION)
        return any(limit is not None and limit.particle is None for limit in found)

    def name(self, motion: Motion) -> None:
        """Say whose the motion of the last step is, where a limit of it has bound."""
        for limit in self.limits(motion):
            if limit.name in self.binders and self.binders[limit.name].particle is None:
                self.binders[limit.name] = limit

    def is_too_long(self, limit: Limit) -> bool:
        """Whether the given step is longer than a limit, by more than it was rounded."""
        return self.given is not None and self.given > limit.seconds * (1 + 1e-9)

    def refuse(self, limit: Limit) -> None:
        """InputError where the given step is longer than a limit at the start."""
        if not self.enforce or not self.is_too_long(limit):
            return
        raise InputError(
            f"time.step: {self.given:g} s is longer than the {limit.name} limit of "
            f"{limit.seconds:.4g} s ({limit.cause}): the run could blow up. Take `step: auto`, a "
            f"step of at most {limit.seconds:.4g}, or, to have it exactly as it is, "
            "`time.enforce: false`"
        )

    @property
    def shortened(self) -> int:
        """Steps that a limit made shorter than the given one."""
        return 0 if self.given is None else self.counts.total() - self.counts["given"]

    def most_binding(self) -> tuple[Limit, int] | None:
        """The limit that bound most steps of those that a limit bound, and how many."""
        ranked = [
            self.binders[name] for name, _ in self.counts.most_common() if name in self.binders
        ]
        return (ranked[0], self.counts[ranked[0].name]) if ranked else None

    def state(self) -> dict[str, Any]:
        """All that later steps depend on, and the counts, as JSON can hold them."""
        return {
            "last": self.last, "code": self.code, "binding": self.binding,
            "motion": list(self.motion), "growth_left": self.growth_left,
            "stiffness": [list(self.stiffness[m]) for m in self.materials.values()],
            "wave_speed": self.wave_speed, "constant": self.constant,
            "reduction": self.reduction, "shortest": self.shortest, "longest": self.longest,
            "counts": dict(self.counts),
            "binders": [list(limit) for limit in self.binders.values()],
        }  # fmt: skip

    def restore(self, state: dict[str, Any]) -> None:
        """Go on from a state of before, of the same scene."""
        seen = zip(self.materials.values(), state["stiffness"], strict=True)
        self.see({material: Stiffness(*values) for material, values in seen})
        self.motion, self.counts = Motion(*state["motion"]), Counter(state["counts"])
        self.binders = {values[0]: Limit(*values) for values in state["binders"]}
        for name in (
            "last",
            "code",
            "binding",
            "growth_left",
            "wave_speed",
            "constant",
            "reduction",
            "shortest",
            "longest",
        ):
            setattr(self, name, state[name])

    def describe(self, dt: float) -> list[str]:
        """What the first step is and why, in words."""
        shortest = self.limits(self.motion)[0]
        binding = f"{shortest.name} limit {shortest.seconds:.3g} s ({shortest.cause})"
        if self.given is None:
            lines = [f"time step {dt:.4g} s: auto, at most {self.safety:g} of the {binding}"]
        else:
            lines = [f"time step {dt:.4g} s: given; {binding}"]
        if not self.enforce and self.is_too_long(shortest):
            lines.append(
                f"warning: time.step is {dt / shortest.seconds:.3g} times the {binding}: the run "
                "may blow up; `step: auto` chooses a stable one"
            )
        if self.given is None and self.isolated is None:
            lines.append(
                f"the {self.scene.method.basis} basis has no limit above zero for a lone particle: "
                "auto takes that of a filled body"
                + (", and nodes too light for the step are counted" if self.fears_slivers else "")
            )
        return lines
