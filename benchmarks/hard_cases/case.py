"""What a hard case is made of, and what a run of it is called."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from experiments import Scheme

U = {"f64": 1.1e-16, "f32": 6.0e-8}
"""Unit round-off."""


class Figure(NamedTuple):
    """A measured value with its bound: the most that it may be, or the least."""

    name: str
    value: float
    bound: float
    at_least: bool = False

    @property
    def holds(self) -> bool:
        return self.value >= self.bound if self.at_least else self.value <= self.bound

    def __str__(self):
        mark = "" if self.holds else " !"
        return (
            f"{self.name} {self.value:.3g} {'>=' if self.at_least else '<='} {self.bound:.3g}{mark}"
        )


class Found(NamedTuple):
    """Figures, and counts of what was clamped or cut off, by their words."""

    figures: list[Figure]
    clamps: dict[str, int] = {}


class Draw:
    """What is drawn at run time, the same for all schemes of a case; `said` tells it in words.
    `dimension` is that of the row, 2 or 3."""

    def __init__(self, seed: int, quick: bool, dimension: int = 2):
        self.rng, self.quick, self.dimension = np.random.default_rng(seed), quick, dimension
        self.said = f"seed {seed}"

    def offsets(self, count: int, dim: int) -> np.ndarray:
        """[count, dim] in cells, from 0 to 1."""
        found = self.rng.random((count, dim)).round(4)
        self.said += f"; offsets {' '.join(','.join(f'{a:g}' for a in row) for row in found)}"
        return found

    def orientation(self, dim: int) -> np.ndarray:
        """A matrix that exchanges axes and turns some of them around."""
        order, sign = self.rng.permutation(dim), self.rng.choice([-1, 1], dim)
        axes = ("xyz"[a] if s > 0 else "-" + "xyz"[a] for a, s in zip(order, sign, strict=True))
        self.said += f"; axes {' '.join(axes)}"
        return np.eye(dim)[order] * sign[:, None]

    def axis(self) -> tuple[int, bool]:
        """Number of an axis, and whether to go along it upwards."""
        turned = self.orientation(self.dimension)[:, 0]
        axis = int(np.abs(turned).argmax())
        return axis, bool(turned[axis] > 0)


class Case(NamedTuple):
    """`schemes` are run by default, `quick` with --quick, in all of `dimensions`.  `fails` tells of
    schemes that must fail which figure must break its bound ("a or b": one of them; "finishes" is
    that of a run that stops); what the document only reports is in `reported`."""

    name: str
    title: str
    measure: Callable[[Scheme, Draw], Found]
    schemes: tuple[Scheme, ...]
    quick: tuple[Scheme, ...]
    fails: dict[str, str] = {}
    reported: tuple[str, ...] = ()
    precisions: tuple[str, ...] = ("f64", "f32")
    dimensions: tuple[int, ...] = (2,)
    clamps: bool = False  # whether counts may differ from 0

    def status(self, scheme: Scheme, found: Found) -> str:
        word, broken = str(scheme), {f.name for f in found.figures if not f.holds}
        if sum(found.clamps.values()) and not self.clamps:
            broken.add("clamps")
        if word in self.reported:
            return "reported"
        if word not in self.fails:
            return "fail" if broken else "pass"
        if broken & {*self.fails[word].split(" or ")}:
            return "expected fail"
        return "fail" if broken else "passes though it should fail"
