"""Antialiased discs and lines into a float32 image [height, width, 3].

The center of the pixel in column i of row j is the point (i, j).  A shape is mixed in by its
coverage c of the pixel, image = (1 - c) image + c color, one shape after the other.  Bands of rows
are drawn side by side (each by one worker, kernels/blocks.py), in each the shapes in their order
and all in f32, so that the bytes depend neither on the threads nor on the precision of the run.  In
a kernel a float literal has the precision of the run, and so has a quotient with an integer."""

from typing import TYPE_CHECKING, Any

import numpy as np
import taichi as ti

from ..kernels.blocks import GATE
from ..runtime import Template

if TYPE_CHECKING:
    Pixels = Any
    Bytes = Any
    Vectors = Any
    Scalars = Any
    Single = float
else:
    Pixels = ti.types.ndarray(dtype=ti.types.vector(3, ti.f32), ndim=1)
    Bytes = ti.types.ndarray(dtype=ti.types.vector(3, ti.u8), ndim=1)
    Vectors = ti.types.ndarray(dtype=ti.f32, ndim=2)
    Scalars = ti.types.ndarray(dtype=ti.f32, ndim=1)
    Single = ti.f32

BAND = 64
"""Rows of a band."""


@ti.func
def pixel(at, count: int) -> int:
    """The next whole pixel, held within [0, count]: no write outside the image."""
    return int(ti.min(ti.max(ti.ceil(at), 0), count))


@ti.func
def row_pixel(at, band: int, height: int) -> int:
    """The next whole row, held within the band."""
    return ti.max(pixel(at, ti.min((band + 1) * BAND, height)), band * BAND)


@ti.func
def mix(pixels: Template, at, color, coverage):
    pixels[at] = pixels[at] + (color - pixels[at]) * coverage  # "a = a + b" is never atomic


@ti.kernel
def fill_discs(
    pixels: Pixels,
    width: int,
    height: int,
    column: Scalars,
    row: Scalars,
    radius: Scalars,
    color: Vectors,
):
    for counter in range(GATE * ((height + BAND - 1) // BAND)):
        if counter % GATE == 0:
            band = counter // GATE
            for p in range(radius.shape[0]):
                x, y, r = column[p], row[p], radius[p]
                reach = r + ti.f32(0.5)
                top, bottom = row_pixel(y - reach, band, height), row_pixel(y + reach, band, height)
                if top < bottom:
                    c = ti.Vector([color[p, 0], color[p, 1], color[p, 2]])
                    left, right = pixel(x - reach, width), pixel(x + reach, width)
                    for j in range(top, bottom):
                        for i in range(left, right):
                            dx, dy = i - x, j - y
                            coverage = ti.math.clamp(reach - ti.sqrt(dx * dx + dy * dy), 0, 1)
                            mix(pixels, j * width + i, c, coverage)


@ti.kernel
def stroke_lines(
    pixels: Pixels,
    width: int,
    height: int,
    ends: Vectors,
    color: Scalars,
    thickness: Single,
    opacity: Single,
):
    for counter in range(GATE * ((height + BAND - 1) // BAND)):
        if counter % GATE == 0:
            band = counter // GATE
            for line in range(ends.shape[0]):
                u0, v0 = ends[line, 0], ends[line, 1]  # along columns and rows; if steep, reversed
                du, dv = ends[line, 2] - u0, ends[line, 3] - v0
                c = ti.Vector([color[0], color[1], color[2]])
                steep = abs(dv) > abs(du)
                if steep:
                    u0, v0, du, dv = v0, u0, dv, du
                if du < 0:
                    u0, v0, du, dv = u0 + du, v0 + dv, -du, -dv
                reach = (thickness + 1) * ti.f32(0.5)
                square = ti.max(du * du + dv * dv, 1)
                start, end = u0 - reach, u0 + du + reach
                first, last = pixel(start, width), pixel(end, width)
                if steep:
                    first, last = row_pixel(start, band, height), row_pixel(end, band, height)
                for u in range(first, last):
                    middle = v0 + dv * ti.math.clamp((u - u0) / ti.max(du, 1), 0, 1)
                    low, high = middle - 2 * reach, middle + 2 * reach
                    lowest, highest = pixel(low, width), pixel(high, width)
                    if not steep:
                        lowest, highest = (
                            row_pixel(low, band, height),
                            row_pixel(high, band, height),
                        )
                    for v in range(lowest, highest):
                        along = ti.math.clamp(((u - u0) * du + (v - v0) * dv) / square, 0, 1)
                        x, y = u - u0 - along * du, v - v0 - along * dv
                        coverage = ti.math.clamp(reach - ti.sqrt(x * x + y * y), 0, 1)
                        at = ti.select(steep, u * width + v, v * width + u)
                        mix(pixels, at, c, coverage * opacity)


@ti.kernel
def fill_bytes(bytes: Bytes, pixels: Pixels):
    for at in pixels:
        bytes[at] = ti.cast(pixels[at] * ti.f32(255.0) + ti.f32(0.5), ti.u8)


def flat(image: np.ndarray) -> tuple[np.ndarray, int, int]:
    """The pixels of an image row after row [n, 3], its width and its height: in kernels twice as
    fast as [height, width, 3].  The image must be contiguous, so that this is no copy."""
    assert image.dtype == np.float32 and image.flags.c_contiguous
    return image.reshape(-1, 3), image.shape[1], image.shape[0]


def single(array: np.ndarray) -> np.ndarray:
    with np.errstate(over="ignore"):
        return np.ascontiguousarray(array, np.float32)


def is_seen(image: np.ndarray, column, row, radius) -> np.ndarray:
    """[n], whether a disc touches the image; false where a number is not finite."""
    seen = (radius > 0) & (radius < np.inf)
    for at, length in ((column, image.shape[1]), (row, image.shape[0])):
        seen &= (at > -1 - radius) & (at < length + radius)
    return seen


def draw_discs(
    image: np.ndarray, column: np.ndarray, row: np.ndarray, radius: np.ndarray, color: np.ndarray
) -> None:
    """Mix discs into the image, in the order given.

    column, row and radius [n] in pixels, color [n, 3].  A disc outside the image, or with a center
    or radius that is not finite, is skipped."""
    column, row, radius = single(column), single(row), single(radius)
    seen = is_seen(image, column, row, radius)
    if not seen.all():
        column, row, radius, color = column[seen], row[seen], radius[seen], color[seen]
    if len(radius):
        fill_discs(*flat(image), column, row, radius, single(color))


def draw_lines(
    image: np.ndarray,
    start: np.ndarray,
    end: np.ndarray,
    color: np.ndarray,
    thickness: float = 1.0,
    opacity: float = 1.0,
) -> None:
    """Mix lines from start [n, 2] to end [n, 2] (column, row) of a thickness in pixels."""
    if len(start):
        ends = single(np.hstack([start, end]))
        stroke_lines(*flat(image), ends, single(color), thickness, opacity)


def eight_bits(image: np.ndarray) -> np.ndarray:
    """The image, of colors from 0 to 1, as uint8."""
    bytes = np.empty(image.shape, np.uint8)
    fill_bytes(bytes.reshape(-1, 3), flat(image)[0])
    return bytes
