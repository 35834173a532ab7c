"""The words of a scene file: one frozen model per section."""

from functools import reduce
from typing import Annotated, Literal

from pydantic import AfterValidator, Field, ValidationError, model_validator

from ..bases import BASES, BasisName
from ..boundaries import RULES, RuleName, Wall
from ..expressions import Expressions
from ..formulas import Formula
from ..materials import Material
from ..model import Model, Positive, Vector
from ..sampling import Sampling
from ..shapes import Shape
from ..transfers import APICChoice, FLIPChoice, FlipPart, Transfer, XPICChoice
from .checks import across
from .presets import OrPreset
from .wording import in_words

VectorField = Annotated[list[Formula], Field(min_length=2, max_length=3)]
"""A number or a formula for each axis."""


MaterialOrPreset = Annotated[Material, OrPreset()]


class Walls(Model):
    """A boundary rule for each side of the domain; `periodic` is that of both sides of an axis."""

    left: RuleName = Field(default="none", description="rule at x = 0")
    right: RuleName = Field(default="none", description="rule at the largest x")
    bottom: RuleName = Field(default="none", description="rule at y = 0")
    top: RuleName = Field(default="none", description="rule at the largest y")
    back: RuleName = Field(default="none", description="rule at z = 0 (3D)")
    front: RuleName = Field(default="none", description="rule at the largest z (3D)")


SIDES = (("left", "right"), ("bottom", "top"), ("back", "front"))


class Domain(Model):
    """The closed box [0, size], cut into equal cubes."""

    size: Annotated[list[Positive], Field(min_length=2, max_length=3)] = Field(
        description="edges of the domain [m]; two entries: 2D (plane strain), three: 3D"
    )
    cells: Annotated[list[Annotated[int, Field(ge=1)]], Field(min_length=2, max_length=3)] = Field(
        description="number of cells along each axis"
    )
    walls: RuleName | Walls = Field(
        default="none", description="one rule for all sides, or one for each"
    )
    outside: Literal["stop", "delete", "clamp"] = Field(
        default="stop",
        description="what happens to a particle that leaves: the run stops, the particle is "
        "deleted, or clamped to the border; both are counted",
    )

    @property
    def dimension(self) -> int:
        return len(self.size)

    @property
    def cell_size(self) -> float:
        """dx [m]."""
        return self.size[0] / self.cells[0]

    @property
    def rules(self) -> tuple[Wall, ...]:
        """The sides that have a wall, with its rule."""
        rules = {rule.name: rule for rule in RULES}
        return tuple(
            Wall(axis, upper, rules[word])
            for axis, sides in enumerate(SIDES[: self.dimension])
            for upper, word in zip((False, True), map(self._word, sides), strict=True)
            if word not in ("none", "periodic")
        )

    @property
    def periodic(self) -> tuple[int, ...]:
        """The axes that close on themselves."""
        pairs = enumerate(SIDES[: self.dimension])
        return tuple(axis for axis, (lower, _) in pairs if self._word(lower) == "periodic")

    def _word(self, side: str) -> str:
        return getattr(self.walls, side) if isinstance(self.walls, Walls) else self.walls


class Method(Model):
    """How the material point method is put together."""

    basis: BasisName = Field(
        default="quadratic", description="functions that carry values to the nodes"
    )
    transfer: Transfer = Field(
        default=APICChoice(force="mls"),
        description="what particles and nodes exchange",
    )
    stress_update: Literal["usl", "musl", "usf"] = Field(
        default="usl",
        description="usl: stress is updated last, from the new velocities of the nodes; musl: from "
        "those of the particles, mapped to the nodes once more; usf: first, from the old ones",
    )
    mass_cutoff: float | None = Field(
        default=None,
        ge=0,
        lt=1,
        description="nodes up to this part of the lightest particle's mass are taken as empty, and "
        "counted; default: rounding errors for the linear basis under usl, none for splines",
    )
    precision: Literal["f32", "f64"] | None = Field(
        default=None, description="floating-point numbers; not given: what suits the device"
    )

    @property
    def basis_class(self) -> type:
        return next(basis for basis in BASES if basis.name == self.basis)

    @property
    def transfer_class(self) -> type:
        return self.transfer.transfer

    @property
    def filter_order(self) -> int:
        """m of XPIC."""
        return self.transfer.order if isinstance(self.transfer, XPICChoice) else 1

    @property
    def flip_part(self) -> FlipPart:
        """alpha of FLIP with a little PIC."""
        return self.transfer.flip_part if isinstance(self.transfer, FLIPChoice) else FlipPart()


class Time(Model):
    """How long, and in which steps."""

    end: Positive = Field(description="simulated time [s]")
    step: Positive | Literal["auto"] = Field(
        default="auto", description="time step [s], or auto: as large as is stable, times safety"
    )
    safety: float = Field(
        default=0.5, gt=0, le=1, description="fraction of the stable step used by auto"
    )
    enforce: bool = Field(
        default=True,
        description="false: take exactly the given step, also above the limits of stability; true: "
        "refuse it there, and shorten it where limits fall below it during the run",
    )


class Body(Model):
    """A piece of material at the start."""

    name: str = Field(min_length=1, description="name, different for each body")
    material: str = Field(description="key of one of the materials")
    shape: Shape | None = Field(default=None, description="region that the body fills")
    particles: Sampling = Field(description="how the body becomes material points")
    velocity: VectorField | None = Field(
        default=None,
        description="velocity at the start [m/s], numbers or formulas of X, Y, Z; default 0",
    )
    displacement: VectorField | None = Field(
        default=None,
        description="of each particle at the start [m], formulas of the undeformed place X, Y, Z; "
        "F is I plus its exact gradient; default 0",
    )


def _increasing(limits: list[float] | None) -> list[float] | None:
    if limits is not None and limits[0] >= limits[1]:
        raise ValueError(f"must increase (got {limits})")
    return limits


class View(Model):
    """From where the pictures are taken."""

    turn: float | None = Field(
        default=None,
        ge=-360,
        le=360,
        description="in 3D, how far around the y axis the viewer stands [degrees]: 0 in front, 90 "
        "at the right; default: 32",
    )
    tilt: float | None = Field(
        default=None,
        ge=0,
        le=90,
        description="in 3D, how far above the floor the viewer stands [degrees]; default: 20",
    )
    zoom: float = Field(
        default=1.0, ge=0.1, le=100, description="how many times as large as all of the domain"
    )
    center: Vector | None = Field(
        default=None, description="point in the middle of the picture [m]; default: the domain's"
    )


class Images(Model):
    """Pictures of the particles."""

    color_by: Literal["body", "speed", "pressure", "stress", "density", "plastic_strain"] = Field(
        default="speed",
        description="what the color shows: body, speed [m/s], pressure or von Mises stress [Pa], "
        "density [kg/m^3], equivalent plastic strain [-]",
    )
    grid: float = Field(default=0.25, ge=0, le=1, description="opacity of the grid overlay")
    size: int = Field(default=900, ge=64, le=8192, description="longer side [pixels]")
    range: Annotated[
        Annotated[list[float], Field(min_length=2, max_length=2)] | None,
        AfterValidator(_increasing),
    ] = Field(
        default=None, description="values at the ends of the color scale; default: from the data"
    )
    view: View = Field(default=View(), description="from where the pictures are taken")


class Exact(Model):
    """The solution, formulas of X, Y, Z and t: the run tells its error."""

    displacement: VectorField | None = Field(
        default=None, description="[m]; gives velocity, stress and energy too"
    )
    velocity: VectorField | None = Field(
        default=None, description="[m/s]; default: the rate of the displacement"
    )
    stress: dict[Literal["xx", "yy", "zz", "xy", "yz", "zx"], Formula] | None = Field(
        default=None,
        description="Cauchy stress [Pa], the components that are compared; default: all, by the "
        "law of each material from the gradient of the displacement (elastic laws)",
    )


class History(Model):
    """The table of energies and momenta."""

    every_steps: int = Field(default=10, ge=1, description="steps between two rows")


class ParaView(Model):
    """Files for ParaView."""

    grid: bool = Field(default=False, description="mass and velocity of the nodes too")


class Output(Model):
    """What a run writes."""

    every: Positive | None = Field(
        default=None,
        description="time between two outputs [s]; default: a hundredth of the simulated time",
    )
    images: Images | Literal["none"] = Field(default=Images(), description="pictures, or none")
    history: History = Field(default=History(), description="table of energies and momenta")
    checkpoints: Positive | Literal["none"] | None = Field(
        default=None,
        description="seconds of computing between two states that a run can be resumed from, or "
        "none; default: 60, or more where they would take over 2 % of the run",
    )
    snapshots: bool | None = Field(
        default=None,
        description="particles of each output in a file, for player, films and analysis; default: "
        "up to 200,000 particles",
    )
    stages: bool = Field(
        default=False,
        description="in 2D, the stages of the step that follows each output, which the player then "
        "shows one by one; with snapshots",
    )
    paraview: bool | ParaView = Field(
        default=False, description="files for ParaView: particles of each output, or the grid too"
    )
    audit: bool = Field(
        default=False,
        description="count the impulses of walls and the energy that each stage of the step loses, "
        "for a quarter (FLIP) to three quarters (APIC in 3D) more time; on --device cpu",
    )


class Scene(Model):
    """A documented experiment.  A Scene that exists has passed the checks of `checks.py`."""

    version: Literal[1] = Field(description="version of this format")
    title: str = Field(default="", description="what the scene shows")
    source: str = Field(default="", description="where it is from")
    domain: Domain = Field(description="the box in which things happen, and its grid")
    method: Method = Field(default=Method(), description="the parts of the method")
    time: Time = Field(description="duration and time step")
    definitions: dict[str, Formula] = Field(
        default={}, description="names for parts of the formulas of this scene"
    )
    gravity: Vector | None = Field(default=None, description="acceleration [m/s^2]; default 0")
    body_force: VectorField | None = Field(
        default=None,
        description="force per mass at the particles [m/s^2], formulas of the undeformed place X, "
        "Y, Z, the place x, y, z and the time t; adds to gravity; default 0",
    )
    materials: Annotated[dict[str, MaterialOrPreset], Field(min_length=1)] = Field(
        description="materials by name: a law (type) with its values, or a preset and what differs"
    )
    bodies: Annotated[list[Body], Field(min_length=1)] = Field(description="bodies at the start")
    exact: Exact | None = Field(default=None, description="the solution, if it is known")
    output: Output = Field(default=Output(), description="what the run writes")

    @model_validator(mode="after")
    def _checked(self):
        sections = {name: getattr(self, name) for name in type(self).model_fields}
        sections["bodies"] = dict(enumerate(self.bodies))
        faults = [
            in_words(place, text, reduce(_member, place, self)) for place, text in across(sections)
        ]
        if faults:
            raise ValidationError.from_exception_data("Scene", faults)
        return self

    @property
    def dimension(self) -> int:
        return self.domain.dimension

    @property
    def cell_size(self) -> float:
        """dx [m]."""
        return self.domain.cell_size

    @property
    def gravity_vector(self) -> list[float]:
        """[m/s^2], one entry per axis."""
        return [0.0] * self.dimension if self.gravity is None else self.gravity

    def field(self, entries: list[Formula] | None) -> Expressions | None:
        """A vector of numbers or formulas as a field of X, x and t; None for None."""
        if entries is None:
            return None
        return Expressions(entries, self.definitions, dim=self.dimension)

    @property
    def output_interval(self) -> float:
        """Time between two outputs [s]."""
        return self.time.end / 100 if self.output.every is None else self.output.every


def _member(value, part):
    return getattr(value, part) if isinstance(value, Model) else value[part]
