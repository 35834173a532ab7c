"""What `speed_vs_error.py` measures: validation scenes, and the schemes that run on them."""

from typing import NamedTuple

from mpm_taichi.bases import BASES
from mpm_taichi.scene import Method
from mpm_taichi.scene.checks import moment, stress_update

TRANSFERS = {
    "pic": {"type": "pic"},
    "flip": {"type": "flip"},
    "flip 0.99": {"type": "flip", "ratio": 0.99},
    "xpic 2": {"type": "xpic", "order": 2},
    "xpic 5": {"type": "xpic", "order": 5},
    "apic": {"type": "apic", "force": "gradient"},
    "tpic": {"type": "tpic"},
    "mls": {"type": "apic", "force": "mls"},
}
"""Word of a table -> section of a scene."""

CROSSING = "the linear basis does not converge while particles cross its cells"
FEW_PARTICLES = "2 x 2 particles per cell lose contact at this shear, whatever the scheme"


class Scheme(NamedTuple):
    """Basis, word of the transfer, stress order, precision."""

    basis: str
    transfer: str
    order: str = "usl"
    precision: str = "f64"

    def __str__(self):
        order = "" if self.order == "usl" else f" {self.order}"
        return f"{self.basis} {self.transfer}{order}"

    @property
    def with_precision(self) -> str:
        return f"{self} {self.precision}"

    @property
    def method(self) -> dict:
        """The section `method` of a scene."""
        transfer = TRANSFERS[self.transfer]
        return {"basis": self.basis, "transfer": transfer, "stress_update": self.order}

    @property
    def works(self) -> bool:
        """Whether a scene may ask for it."""
        method = Method.model_validate(self.method)
        return not any(moment(method)) and not any(stress_update(method))


class Experiment(NamedTuple):
    """A scene with `changes`; `levels` are the schemes to run by default with cells of 1,
    1/2, 1/4 ... the size.

    Errors are relative to the largest exact field of the experiment `scale`: that of a bar that
    rides would be its way, beside which every error is small."""

    scene: str
    changes: tuple[str, ...]
    levels: tuple[tuple[Scheme, ...], ...]
    what: str
    failures: dict[str, str] = {}
    scale: str | None = None

    def expected(self, scheme: Scheme) -> str | None:
        """Why this scheme is known to fail here, if it is; the key "" means all bases."""
        return self.failures.get(scheme.basis) or self.failures.get("")


def schemes(*texts: str) -> tuple[Scheme, ...]:
    """`linear: flip, flip musl; cubic: mls f32` -> its four schemes."""
    found = []
    for text in "; ".join(texts).split("; "):
        basis, words = text.split(": ")
        for word in words.split(", "):
            parts = word.split()
            precision = parts.pop() if parts[-1] in ("f32", "f64") else "f64"
            order = parts.pop() if parts[-1] in ("usl", "musl", "usf") else "usl"
            found.append(Scheme(basis, " ".join(parts), order, precision))
    return tuple(found)


EVERY = tuple(
    scheme
    for basis in BASES
    for transfer in TRANSFERS
    for order in ("usl", "musl", "usf")
    for precision in ("f64", "f32")
    if (scheme := Scheme(basis.name, transfer, order, precision)).works
)

ON_BARS = schemes(
    "linear: flip, flip musl, flip usf; gimp: flip, apic",
    "quadratic: pic, flip, flip musl, flip usf, flip 0.99, xpic 2, apic, mls, mls f32",
    "cubic: flip, mls",
)
FINE_BARS = schemes("linear: flip; gimp: apic; quadratic: flip, apic, mls; cubic: mls")
SMALL = schemes("linear: flip; quadratic: mls; cubic: mls")
BETWEEN_WALLS = schemes(
    "linear: flip; gimp: flip; quadratic: flip, mls, mls f32; cubic: mls",
    "quadratic_boundary: tpic; cubic_boundary: tpic",
)
FINE_SQUARES = schemes("quadratic: mls; cubic: mls; quadratic_boundary: tpic")
WRUNG = schemes("linear: flip; quadratic: mls; cubic: apic, mls")

BARS = (ON_BARS, ON_BARS, FINE_BARS)
BAR = ("time.end=0.5", "output.every=0.025")
VORTEX = ("domain.cells=[28,28]", "time.step=4.0e-3", "output.every=0.1")

EXPERIMENTS = {
    "free_bar": Experiment(
        "free_bar", ("domain.size=[5,0.05]", "domain.cells=[100,1]", *BAR), BARS,
        "free bar at rest in the grid, 2.5 periods", {"linear": CROSSING},
    ),
    "free_bar_riding": Experiment(
        "free_bar_riding", BAR, BARS, "the same bar, riding through the same grid",
        {"linear": CROSSING}, "free_bar",
    ),
    "manufactured_1d": Experiment(
        "manufactured_1d", (), (SMALL, SMALL),
        "bar between two walls, so little strained that nothing leaves its cell",
    ),
    "manufactured_2d": Experiment(
        "manufactured_2d", ("output.every=1.0e-3",), (BETWEEN_WALLS, BETWEEN_WALLS, FINE_SQUARES),
        "square kneaded between four walls, one period", {"linear": CROSSING},
    ),
    "vortex 2 x 2": Experiment(
        "vortex", (*VORTEX, "bodies[0].particles.per_cell=2"), (WRUNG, WRUNG),
        "ring wrung by large shear, 2 x 2 particles per cell", {"": FEW_PARTICLES},
    ),
    "vortex 5 x 5": Experiment(
        "vortex", (*VORTEX, "bodies[0].particles.per_cell=5"), (WRUNG, WRUNG),
        "ring wrung by large shear, 5 x 5 particles per cell", {"linear": CROSSING},
    ),
}  # fmt: skip

OMITTED = (
    "the finest of 3 resolutions of bars and square but for those that get there first: each run "
    "costs a compilation; a third of the others (40 cells per meter of the vortex take minutes)",
    "stress orders musl and usf but for flip with linear and quadratic on the bars",
    "f32 but for quadratic mls on bars and square: it halves bytes, and runs of this size are not "
    "bound by memory",
    "quadratic_boundary and cubic_boundary but between the walls of the square: where no wall is "
    "near they are quadratic and cubic",
    "xpic 5; tpic with bases for which there is apic; pic, flip 0.99 and xpic 2 but on the bars "
    "with the quadratic basis",
)
"""What is not run without --full, and why."""
