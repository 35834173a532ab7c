"""Where a point of the domain lies in the picture: orthographic in 2D, perspective in 3D."""

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

TURN, TILT = 32.0, 20.0
"""Degrees, of the view in 3D: turned about the y axis, to the right, and tilted down."""

DISTANCE = 4.0
"""From the camera to the center of the domain in 3D, in half diagonals of the domain."""

NARROWEST, NARROW = 19, 32
"""Widths [em] of a picture that just holds its texts, and of one with the time beside the title."""


class View(NamedTuple):
    """From where the domain is seen.  `center`: the point in the middle of the picture [m]; None:
    all of the domain is, before it is enlarged by `zoom`."""

    turn: float = TURN  # degrees
    tilt: float = TILT
    zoom: float = 1.0
    center: Sequence[float] | None = None


PLAIN = View()


class Sight(NamedTuple):
    """Points as seen by a camera, [n] each; a column that is NaN lies behind the camera."""

    column: np.ndarray  # pixels
    row: np.ndarray  # pixels, downward
    scale: np.ndarray  # pixels per meter there
    toward: np.ndarray  # m, toward the viewer from the center of the domain


@dataclass(frozen=True, eq=False)
class Camera:
    """A point x lies at r = axes (x - center), to the right, up and toward the viewer, and is seen
    1 / (1 - r_toward / distance) times as large as at the center.  In 2D the distance is infinite.
    """

    axes: np.ndarray  # [3, dim]
    center: np.ndarray  # [dim], m
    distance: float  # m
    scale: float = 1.0  # pixels per meter at the center
    column: float = 0.0  # pixel of the center
    row: float = 0.0
    width: int = 0  # of the whole picture, pixels
    height: int = 0
    em: int = 0  # size of the text, pixels
    margin: int = 0  # from the picture's edges to its texts, pixels
    stage: tuple[int, int, int, int] = (0, 0, 0, 0)
    """Columns and rows, from and up to, that all of the domain takes; a larger view is cut off."""
    narrow: bool = False  # the time stands below the title

    def look(self, x: np.ndarray) -> Sight:
        """How points [n, dim] are seen."""
        right, up, toward = seen = np.zeros((3, len(x)))
        # axis by axis: a product of n by 3 is slower in BLAS, whose threads wait for free cores
        with np.errstate(invalid="ignore"):  # a diverged particle may be at infinity
            for direction, coordinate in zip(self.axes, seen, strict=True):
                for axis, center in enumerate(self.center):
                    coordinate += direction[axis] * (x[:, axis] - center)
            nearness = toward / self.distance
            scale = self.scale / np.where(nearness < 0.9, 1 - nearness, np.nan)
            return Sight(self.column + right * scale, self.row - up * scale, scale, toward)

    def pixel_of(self, x) -> np.ndarray:
        """Pixel (column, row) of a point [dim] or of points [n, dim]; the center of the pixel in
        column i of row j is (i, j)."""
        x = np.asarray(x, float)
        sight = self.look(np.atleast_2d(x))
        return np.stack([sight.column, sight.row], axis=-1).reshape(*x.shape[:-1], 2)


def corners(size: np.ndarray) -> np.ndarray:
    """The corners [2^dim, dim] of the box [0, size]; the binary digits of the number of a corner
    say, axis by axis, whether it lies at 0 or at the size."""
    return np.array(list(itertools.product(*([0.0, length] for length in size))))


def orientation(dim: int, turn: float = TURN, tilt: float = TILT) -> np.ndarray:
    """Rows: the directions to the right, up and toward the viewer, in the axes of the domain."""
    if dim == 2:
        return np.array([[1.0, 0.0], [0.0, 1.0], [0.0, 0.0]])
    (s, t), (c, d) = np.sin(np.radians([turn, tilt])), np.cos(np.radians([turn, tilt]))
    return np.array([[c, 0.0, -s], [-s * t, d, -c * t], [s * d, t, c * d]])


def viewpoint(domain_size, view: View = PLAIN) -> Camera:
    """From where the pictures see the box [0, domain_size]; a pixel per meter."""
    box = np.asarray(domain_size, float)
    distance = np.inf if len(box) == 2 else float(DISTANCE * np.linalg.norm(box) / 2)
    return Camera(orientation(len(box), view.turn, view.tilt), box / 2, distance)


def fit(domain_size, size: int, view: View = PLAIN) -> Camera:
    """The camera that shows the box [0, domain_size] `size` pixels long on the picture's longer
    side, within margins for the texts; width and height of the whole are even.  A zoom or a center
    changes what is seen there, not the size of the picture."""
    box = np.asarray(domain_size, float)
    camera = viewpoint(box, view)
    seen = camera.pixel_of(corners(box))
    scale = size / np.ptp(seen, axis=0).max()
    low, high = seen.min(0) * scale, seen.max(0) * scale
    em = int(np.clip(np.sqrt(np.prod(high - low)) / 38, max(10, size / 64), size))
    columns, rows = (int(length) + 1 for length in np.ceil(high - low))
    width = max(columns + 4 * em, NARROWEST * em)
    narrow = width < NARROW * em
    left, top = (width - columns) // 2, round((4.6 if narrow else 3.2) * em)
    height = top + rows + round(5.8 * em)
    middle = np.array([left + (columns - 1) / 2, top + (rows - 1) / 2])
    at = np.array([left - low[0], top + rows - 1 - high[1]])
    at = middle + view.zoom * (at - middle) if view.center is None else middle
    return replace(
        camera,
        center=box / 2 if view.center is None else np.array(view.center),
        scale=scale * view.zoom,
        column=float(at[0]),
        row=float(at[1]),
        width=width + width % 2,
        height=height + height % 2,
        em=em,
        margin=min(left, 2 * em),
        stage=(left, left + columns, top, top + rows),
        narrow=narrow,
    )
