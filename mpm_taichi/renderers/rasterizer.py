"""Antialiased discs, spheres and lines into a float32 image [height, width, 3].

The center of the pixel in column i of row j is the point (i, j).  A shape is mixed in by its
coverage c of the pixel, image = (1 - c) image + c color, one shape after the other: serial and all
in f32, so that the bytes depend neither on the threads nor on the precision of the run.  In a
kernel a float literal has the precision of the run, and so has a quotient with an integer."""

from typing import TYPE_CHECKING, Any

import numpy as np
import taichi as ti

from ..runtime import Template

if TYPE_CHECKING:
    Pixels = Any
    Vectors = Any
    Scalars = Any
    Single = float
else:
    Pixels = ti.types.ndarray(dtype=ti.types.vector(3, ti.f32), ndim=1)
    Vectors = ti.types.ndarray(dtype=ti.f32, ndim=2)
    Scalars = ti.types.ndarray(dtype=ti.f32, ndim=1)
    Single = ti.f32

LIGHT = (-0.40, 0.68, 0.61)  # unit vector to the light: (right, up, toward the viewer)


@ti.func
def pixel(at, count: int) -> int:
    """The next whole pixel, held within [0, count]: no write outside the image."""
    return int(ti.min(ti.max(ti.ceil(at), 0), count))


@ti.func
def mix(pixels: Template, at, color, coverage):
    pixels[at] += (color - pixels[at]) * coverage


@ti.func
def sphere_shade(dx, dy, z):
    """Light sent to the viewer by the point (dx, -dy, z) of the unit sphere: ambient 0.52, diffuse
    up to 0.62, and the rim darker by 0.2."""
    light = ti.Vector(LIGHT, ti.f32)
    diffuse = ti.max(0, light.x * dx - light.y * dy + light.z * z)
    return (52 + 62 * diffuse) * (80 + 20 * z) * ti.f32(1e-4)


@ti.kernel
def fill_discs(
    pixels: Pixels,
    width: int,
    height: int,
    column: Scalars,
    row: Scalars,
    radius: Scalars,
    color: Vectors,
    lit: Template,
):
    ti.loop_config(serialize=True)
    for p in range(radius.shape[0]):
        x, y, r = column[p], row[p], radius[p]
        c = ti.Vector([color[p, 0], color[p, 1], color[p, 2]])
        reach, per_radius = r + ti.f32(0.5), ti.f32(1.0) / r
        left, right = pixel(x - reach, width), pixel(x + reach, width)
        for j in range(pixel(y - reach, height), pixel(y + reach, height)):
            for i in range(left, right):
                dx, dy = (i - x) * per_radius, (j - y) * per_radius
                square = dx * dx + dy * dy
                coverage = ti.math.clamp(reach - r * ti.sqrt(square), 0, 1)
                if ti.static(lit):
                    z = ti.sqrt(ti.max(0, 1 - square))
                    bright = ti.min(c * sphere_shade(dx, dy, z), 1)
                    mix(pixels, j * width + i, bright, coverage)
                else:
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
    ti.loop_config(serialize=True)
    for line in range(ends.shape[0]):
        u0, v0 = ends[line, 0], ends[line, 1]  # along the columns and the rows; if steep, reversed
        du, dv = ends[line, 2] - u0, ends[line, 3] - v0
        c = ti.Vector([color[0], color[1], color[2]])
        steep = abs(dv) > abs(du)
        if steep:
            u0, v0, du, dv = v0, u0, dv, du
        if du < 0:
            u0, v0, du, dv = u0 + du, v0 + dv, -du, -dv
        length, breadth = ti.select(steep, height, width), ti.select(steep, width, height)
        reach = (thickness + 1) * ti.f32(0.5)
        square = ti.max(du * du + dv * dv, 1)
        for u in range(pixel(u0 - reach, length), pixel(u0 + du + reach, length)):
            middle = v0 + dv * ti.math.clamp((u - u0) / ti.max(du, 1), 0, 1)
            for v in range(pixel(middle - 2 * reach, breadth), pixel(middle + 2 * reach, breadth)):
                along = ti.math.clamp(((u - u0) * du + (v - v0) * dv) / square, 0, 1)
                x, y = u - u0 - along * du, v - v0 - along * dv
                coverage = ti.math.clamp(reach - ti.sqrt(x * x + y * y), 0, 1)
                mix(pixels, ti.select(steep, u * width + v, v * width + u), c, coverage * opacity)


def flat(image: np.ndarray) -> tuple[np.ndarray, int, int]:
    """The pixels of an image row after row [n, 3], its width and its height: in kernels twice as
    fast as [height, width, 3].  The image must be contiguous, so that this is no copy."""
    assert image.dtype == np.float32 and image.flags.c_contiguous
    return image.reshape(-1, 3), image.shape[1], image.shape[0]


def single(array: np.ndarray) -> np.ndarray:
    with np.errstate(over="ignore"):
        return np.ascontiguousarray(array, np.float32)


def draw_discs(
    image: np.ndarray,
    column: np.ndarray,
    row: np.ndarray,
    radius: np.ndarray,
    color: np.ndarray,
    lit: bool = False,
) -> None:
    """Mix discs into the image, in the order given; `lit` shades them as spheres.

    column, row and radius [n] in pixels, color [n, 3].  A disc outside the image, or with a center
    or radius that is not finite, is skipped."""
    column, row, radius = single(column), single(row), single(radius)
    seen = (radius > 0) & (radius < np.inf)
    for at, length in ((column, image.shape[1]), (row, image.shape[0])):
        seen &= (at > -1 - radius) & (at < length + radius)
    if not seen.all():
        column, row, radius, color = column[seen], row[seen], radius[seen], color[seen]
    if len(radius):
        fill_discs(*flat(image), column, row, radius, single(color), lit)


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
