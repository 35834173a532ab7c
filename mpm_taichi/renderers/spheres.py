"""Shaded spheres that hide each other, and the dark between them, into a float32 image.

The nearest sphere is drawn first.  With the part T of a pixel that is still open, a sphere of
coverage c and brightness s adds T c s to its light and takes T c from T; through what is open at
the end the image behind is seen.  A closed pixel costs nothing any more, and a sphere all of whose
tiles are closed costs nothing at all.

The depth of a pixel is the mean over its spheres in the same parts.  From it comes how much of the
sky over a pixel its surroundings hide: nothing over a plane or a ridge, much in a crevice, by the
horizons in directions opposite to each other (after Bavoil, Sainz, Dimitrov 2008, Image-space
horizon-based ambient occlusion).

Bands of rows are drawn side by side, in each the spheres in the same order and all in f32, as in
the rasterizer."""

from typing import TYPE_CHECKING, Any

import numpy as np
import taichi as ti

from ..kernels.blocks import GATE
from ..runtime import Template
from .rasterizer import (
    BAND,
    Pixels,
    Scalars,
    Single,
    Vectors,
    flat,
    is_seen,
    pixel,
    row_pixel,
    single,
)

if TYPE_CHECKING:
    Layer = Any
    Whole = Any
else:
    Layer = ti.types.ndarray(dtype=ti.types.vector(4, ti.f32), ndim=1)
    Whole = ti.types.ndarray(dtype=ti.i32, ndim=1)

LIGHT = (-0.40, 0.68, 0.61)  # unit vector to the light: (right, up, toward the viewer)

TILE = 8
"""Pixels; a band is a number of tiles high."""

CLOSED = 1 / 512
"""A pixel that is open by less than half of a shade of 256 is closed."""

NOWHERE = -1e30
"""Depth where spheres cover less than half of the pixel."""

PAIRS = ((1.0, 0.0), (0.7, 0.7), (0.0, 1.0), (-0.7, 0.7))
"""Directions in which the sky is looked for, each with its opposite."""

REACHES = (2.5, 8.0)
"""How far, in median radii of the spheres, but at least and at most so many pixels:"""

LEAST, MOST = (3, 8), (30, 90)

HIDDEN = 0.2
"""Part of the sky by the sum of sines over PAIRS: none is left in a pit whose rim stands at 40
degrees all around."""

DARKEST = 0.7
"""Part of its light that a pixel loses that sees no sky."""


@ti.func
def sphere_shade(dx, dy, z):
    """Light sent to the viewer by the point (dx, -dy, z) of the unit sphere: ambient 0.52, diffuse
    up to 0.62, and the rim darker by 0.2."""
    light = ti.Vector(LIGHT, ti.f32)
    diffuse = ti.max(0, light.x * dx - light.y * dy + light.z * z)
    return (52 + 62 * diffuse) * (80 + 20 * z) * ti.f32(1e-4)


@ti.func
def is_open(tiles: Template, per_row: int, top: int, bottom: int, left: int, right: int):
    """Whether a pixel may be open in the tiles that these rows and columns touch."""
    pixels = 0
    for line in range(top // TILE, (bottom - 1) // TILE + 1):
        for tile in range(left // TILE, (right - 1) // TILE + 1):
            pixels += tiles[line * per_row + tile]
    return pixels > 0


@ti.kernel
def fill_spheres(
    layer: Layer,
    depth: Scalars,
    tiles: Whole,
    width: int,
    height: int,
    column: Scalars,
    row: Scalars,
    toward: Scalars,
    radius: Scalars,
    color: Vectors,
):
    """`layer`: light and 1 - T of each pixel; `tiles`: how many open pixels each has."""
    per_row = (width + TILE - 1) // TILE
    for counter in range(GATE * ((height + BAND - 1) // BAND)):
        if counter % GATE == 0:
            band = counter // GATE
            for p in range(radius.shape[0]):
                x, y, r = column[p], row[p], radius[p]
                reach, per_radius = r + ti.f32(0.5), ti.f32(1.0) / r
                top, bottom = row_pixel(y - reach, band, height), row_pixel(y + reach, band, height)
                left, right = pixel(x - reach, width), pixel(x + reach, width)
                if (
                    top < bottom
                    and left < right
                    and is_open(tiles, per_row, top, bottom, left, right)
                ):
                    c = ti.Vector([color[p, 0], color[p, 1], color[p, 2]])
                    for j in range(top, bottom):
                        for i in range(left, right):
                            at = j * width + i
                            T = 1 - layer[at].w
                            dx, dy = (i - x) * per_radius, (j - y) * per_radius
                            square = dx * dx + dy * dy
                            if T > 0 and r * (ti.sqrt(square) - 1) < ti.f32(0.5):
                                z = ti.sqrt(ti.max(0, 1 - square))
                                bright = ti.min(c * sphere_shade(dx, dy, z), 1)
                                part = T * ti.math.clamp(reach - r * ti.sqrt(square), 0, 1)
                                closed = layer[at].w + part
                                if T - part < ti.f32(CLOSED):
                                    part, closed = T, ti.f32(1.0)
                                    tile = j // TILE * per_row + i // TILE
                                    tiles[tile] = tiles[tile] - 1
                                light = layer[at].xyz + part * bright
                                layer[at] = ti.Vector([light.x, light.y, light.z, closed])
                                # "a = a + b" is never atomic
                                depth[at] = depth[at] + part * (toward[p] + r * z)


@ti.func
def slope(depth: Template, width: int, height: int, i: int, j: int, here, u, v):
    """Sine of the angle at which what is (u, v) pixels away stands over the pixel; -1 where there
    is nothing."""
    sine, di, dj = ti.f32(-1.0), ti.cast(u, ti.i32), ti.cast(v, ti.i32)
    if 0 <= i + di < width and 0 <= j + dj < height:
        there = depth[(j + dj) * width + i + di]
        if there > ti.f32(NOWHERE):
            up = there - here
            sine = up / ti.sqrt(ti.cast(di * di + dj * dj, ti.f32) + up * up)
    return sine


@ti.kernel
def blend_spheres(
    pixels: Pixels,
    image_width: int,
    left: int,
    top: int,
    layer: Layer,
    depth: Scalars,
    width: int,
    height: int,
    near: Single,
    far: Single,
):
    """The layer over the image from column `left` and row `top` on."""
    for at in depth:
        cover = layer[at].w
        depth[at] = ti.select(cover > ti.f32(0.5), depth[at] / cover, ti.f32(NOWHERE))
    for j in range(height):
        for i in range(width):
            at = j * width + i
            light, T = layer[at].xyz, 1 - layer[at].w
            if T < 1:
                here, hidden = depth[at], ti.f32(0.0)
                if here > ti.f32(NOWHERE):
                    for pair in ti.static(PAIRS):
                        both = ti.f32(0.0)
                        for way in ti.static((1, -1)):
                            u, v = ti.f32(way * pair[0]), ti.f32(way * pair[1])
                            low = slope(depth, width, height, i, j, here, u * near, v * near)
                            high = slope(depth, width, height, i, j, here, u * far, v * far)
                            both += ti.max(low, high)
                        hidden += ti.max(both, 0)
                hidden = ti.min(hidden * ti.f32(HIDDEN), 1)
                behind = (top + j) * image_width + left + i
                pixels[behind] = light * (1 - ti.f32(DARKEST) * hidden) + T * pixels[behind]


def draw_spheres(
    image: np.ndarray,
    column: np.ndarray,
    row: np.ndarray,
    toward: np.ndarray,
    radius: np.ndarray,
    color: np.ndarray,
) -> None:
    """Mix spheres into the image.

    column, row, radius [n] in pixels; toward [n], how far toward the viewer their centers are, in
    pixels too; color [n, 3].  A sphere outside the image, or with a center or radius that is not
    finite, is skipped; of two equally near ones the first one is in front."""
    values = [single(each) for each in (column, row, toward, radius)]
    seen = is_seen(image, values[0], values[1], values[3]) & np.isfinite(values[2])
    there = np.flatnonzero(seen)
    if len(there) == 0:
        return
    ranks = ranked(values[2][there])
    order = there[np.argsort(ranks, kind="stable")]
    reach = radius[order] + 1
    left, right = window(column[order], reach, image.shape[1])
    top, bottom = window(row[order], reach, image.shape[0])
    width, height = right - left, bottom - top
    layer = np.zeros((height * width, 4), np.float32)
    depth = np.zeros(height * width, np.float32)
    radius = values[3][order]
    fill_spheres(
        layer, depth, open_tiles(width, height), width, height, single(column[order] - left),
        single(row[order] - top), values[2][order], radius, single(color[order]),
    )  # fmt: skip
    near, far = (
        float(np.clip(round(reach * float(np.median(radius))), least, most))
        for reach, least, most in zip(REACHES, LEAST, MOST, strict=True)
    )
    pixels, image_width, _ = flat(image)
    blend_spheres(pixels, image_width, left, top, layer, depth, width, height, near, far)


def ranked(toward: np.ndarray) -> np.ndarray:
    """uint16, 0 for the nearest: few enough values for a radix sort."""
    low, high = float(toward.min()), float(toward.max())
    return ((high - toward) * (65535 / (high - low or 1.0))).astype(np.uint16)


def window(at: np.ndarray, reach: np.ndarray, length: int) -> tuple[int, int]:
    """The columns or rows that discs touch."""
    return max(int((at - reach).min()), 0), min(int((at + reach).max()) + 1, length)


def open_tiles(width: int, height: int) -> np.ndarray:
    """The pixels of each tile, row after row."""
    along, down = (
        np.minimum(TILE, length - np.arange(0, length, TILE)) for length in (width, height)
    )
    return np.outer(down, along).astype(np.int32).ravel()
