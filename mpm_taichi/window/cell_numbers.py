"""The numbers of the cells, from 0: in each cell where there is room, else along two sides."""

import functools
from itertools import product

import numpy as np
from PIL import Image, ImageDraw

from ..renderers import palette
from ..renderers.camera import Camera
from ..renderers.ground import plane_axes
from ..renderers.legend import font
from ..renderers.picture import Frame

SIZE = 11
"""Of the digits [pixels]."""

ROOMY = 44
"""Pixels of a cell that holds its numbers."""

ROUND = (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000)


@functools.lru_cache(maxsize=4096)
def mask(words: str) -> np.ndarray:
    """Their coverage of pixels [rows, columns], from 0 to 1."""
    left, top, right, bottom = map(round, font(SIZE).getbbox(words))
    picture = Image.new("L", (right - left + 2, bottom - top + 2))
    ImageDraw.Draw(picture).text((1 - left, 1 - top), words, 255, font(SIZE))
    return np.asarray(picture, np.float32) / 255


def put(image: np.ndarray, words: str, column: float, row: float, opacity: float) -> None:
    """Mix words, centered at a pixel, into the image; not where they would be cut off."""
    cover = opacity * mask(words)[..., None]
    height, width, _ = cover.shape
    top, left = round(row - height / 2), round(column - width / 2)
    if 0 <= top <= image.shape[0] - height and 0 <= left <= image.shape[1] - width:
        part = image[top : top + height, left : left + width]
        part += cover * (palette.FAINT_INK.astype(np.float32) - part)


def draw_cell_numbers(image: np.ndarray, camera: Camera, frame: Frame, opacity: float) -> None:
    """Into the image of the ground."""
    if opacity <= 0:
        return
    opacity = min(1, 0.35 + opacity)
    size, cells = np.asarray(frame.domain_size), np.asarray(frame.cells)
    plane = plane_axes(len(size))
    edge = size / cells
    if len(size) == 2 and camera.scale * edge.min() >= ROOMY:
        _number_cells(image, camera, cells, edge, opacity)
    else:
        for axis, other in (plane, plane[::-1]):
            _number_side(image, camera, axis, other, size, cells, opacity)


def _number_cells(image, camera, cells, edge, opacity):
    """Those in the picture."""
    corner = np.array([camera.column, camera.height - 1 - camera.row]) / camera.scale
    first = np.floor((camera.center - corner) / edge).astype(int)
    last = np.ceil((camera.center - corner + np.array([camera.width, camera.height]) / camera.scale)
                   / edge).astype(int)  # fmt: skip
    first, last = np.clip(first, 0, cells), np.clip(last, 0, cells)
    seen = list(product(range(first[0], last[0]), range(first[1], last[1])))
    middles = camera.pixel_of((np.array(seen).reshape(-1, 2) + 0.5) * edge)
    for (i, j), (column, row) in zip(seen, middles, strict=True):
        put(image, f"{i}, {j}", column, row, opacity)


def _number_side(image, camera, axis, other, size, cells, opacity):
    """Below and to the left in 2D, beside the nearer edges of the floor in 3D; where that is out of
    the picture, at its border."""
    middles = np.zeros((cells[axis], len(size)))
    middles[:, axis] = (np.arange(cells[axis]) + 0.5) * size[axis] / cells[axis]
    away = SIZE / camera.scale
    far = middles.copy()
    far[:, other] = size[other]
    if len(size) == 3 and camera.look(far[:1]).toward > camera.look(middles[:1]).toward:
        middles, away = far, -away
    middles[:, other] -= 1.3 * away
    at = camera.pixel_of(middles)
    apart = np.linalg.norm(at[-1] - at[0]) / max(len(at) - 1, 1)
    every = next((k for k in ROUND if k * apart >= 3 * SIZE), len(at))
    for number in range(0, len(at), every):
        column, row = at[number]
        if len(size) == 2:
            column, row = max(column, 1.5 * SIZE), min(row, camera.height - 1 - SIZE)
        if np.isfinite((column, row)).all():
            put(image, str(number), column, row, opacity)
