"""The plane that carries the grid: the domain in 2D, its floor with the shadow of a light straight
above in 3D.

A pixel (i, j) shows the place (u, v) of the plane, in parts of its edges, with
(u w, v w, w) = M (i, j, 1); w > 0 in front of the camera."""

from typing import TYPE_CHECKING, Any

import numpy as np
import taichi as ti

from ..runtime import Template
from . import palette
from .camera import Camera
from .rasterizer import Pixels, Vectors, flat, single

if TYPE_CHECKING:
    Matrix3 = Any
else:
    Matrix3 = ti.types.matrix(3, 3, ti.f32)

FINEST_SHADOW = 512
"""Cells of the shadow along an edge, at most."""

THINNEST = 1e-3
"""Of a floor seen from its edge, as a part of its size: it is left out."""


def plane_axes(dim: int) -> tuple[int, int]:
    """The two axes of the domain that span the plane."""
    return (0, 1) if dim == 2 else (0, 2)


@ti.func
def between(shadow: Template, u, v):
    """The value at the place (u, v), linear between the four around it."""
    x, y = u * (shadow.shape[0] - 1), v * (shadow.shape[1] - 1)
    a, b = ti.cast(x, ti.i32), ti.cast(y, ti.i32)
    c, d = ti.min(a + 1, shadow.shape[0] - 1), ti.min(b + 1, shadow.shape[1] - 1)
    near = shadow[a, b] + (y - b) * (shadow[a, d] - shadow[a, b])
    far = shadow[c, b] + (y - b) * (shadow[c, d] - shadow[c, b])
    return near + (x - a) * (far - near)


@ti.kernel
def fill_ground(
    pixels: Pixels,
    width: int,
    height: int,
    to_plane: Matrix3,
    colors: Vectors,
    shadow: Vectors,
    has_shadow: Template,
):
    """`colors`: of what is beside the plane, of the plane, of it in full shadow; `shadow` [n, m]:
    how much of it there is from edge to edge."""
    beside = ti.Vector([colors[0, 0], colors[0, 1], colors[0, 2]])
    plane = ti.Vector([colors[1, 0], colors[1, 1], colors[1, 2]])
    dark = ti.Vector([colors[2, 0], colors[2, 1], colors[2, 2]])
    for j in range(height):
        for i in range(width):
            at = to_plane @ ti.Vector([ti.cast(i, ti.f32), ti.cast(j, ti.f32), ti.f32(1.0)])
            color = beside
            if at.z > 0 and 0 <= at.x <= at.z and 0 <= at.y <= at.z:
                color = plane
                if ti.static(has_shadow):
                    color += between(shadow, at.x / at.z, at.y / at.z) * (dark - plane)
            pixels[j * width + i] = color


def pixel_to_plane(camera: Camera, size: np.ndarray) -> np.ndarray | None:
    """M; None where the plane is seen from its edge."""
    spans = [np.eye(len(size))[axis] * size[axis] for axis in plane_axes(len(size))]
    origin = camera.axes @ -camera.center
    right, up, toward = np.stack([*(camera.axes @ span for span in spans), origin], axis=-1)
    w = np.array([0, 0, 1]) - toward / camera.distance
    to_pixel = np.stack(
        [camera.column * w + camera.scale * right, camera.row * w - camera.scale * up, w]
    )
    area = abs(np.linalg.det(np.stack([right[:2], up[:2]])))
    if area < THINNEST * float(np.prod([np.linalg.norm(span) for span in spans])):
        return None
    return np.linalg.inv(to_pixel)


def shadow_of(position: np.ndarray, radius: np.ndarray, size: np.ndarray) -> np.ndarray:
    """How dark the floor of a 3D domain is, 0 to 1, at n x m places from edge to edge: the part
    that squares as wide as the particles cover, blurred over five of them."""
    inside = ((position[:, [0, 2]] >= 0) & (position[:, [0, 2]] <= size[[0, 2]])).all(axis=1)
    if not inside.any():
        return np.zeros((2, 2), np.float32)
    edge = 2 * float(np.median(radius))
    counts = np.clip(np.ceil(size[[0, 2]] / edge), 2, FINEST_SHADOW).astype(int)
    cells = [
        np.minimum((position[inside, axis] * (n / size[axis])).astype(int), n - 1)
        for axis, n in zip((0, 2), counts, strict=True)
    ]
    area = size[0] * size[2] / np.prod(counts)
    square = (2 * radius[inside]) ** 2 / area
    cover = np.bincount(np.ravel_multi_index(cells, counts), square, np.prod(counts))
    cover = np.minimum(cover, 1).reshape(counts)
    for axis in (0, 1, 0, 1):
        n = cover.shape[axis]
        before, after = (cover.take(np.clip(np.arange(n) + k, 0, n - 1), axis) for k in (-1, 1))
        cover = 0.25 * before + 0.5 * cover + 0.25 * after
    return cover.astype(np.float32)


def draw_ground(
    image: np.ndarray, camera: Camera, size: np.ndarray, shadow: np.ndarray | None = None
) -> None:
    """Fill the image."""
    to_plane = pixel_to_plane(camera, size)
    if to_plane is None:
        image[:] = palette.BACKGROUND
        return
    colors = single(np.stack([palette.BACKGROUND, palette.PANEL, palette.SHADOW]))
    matrix = ti.Matrix(to_plane.tolist(), ti.f32)
    shade = np.zeros((1, 1)) if shadow is None else shadow
    fill_ground(*flat(image), matrix, colors, single(shade), shadow is not None)
