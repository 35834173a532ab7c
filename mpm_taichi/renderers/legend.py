"""The texts around the domain: title, time, scale bar, and what the colors mean."""

import functools
import unicodedata
from typing import NamedTuple

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from . import palette
from .camera import Camera
from .quantities import Quantity
from .rasterizer import draw_discs, draw_lines
from .units import prefix, round_length, tick_labels, with_unit


class Text(NamedTuple):
    at: tuple[float, float]  # pixel (column, row) of the anchor
    words: str
    size: float  # pixels
    color: np.ndarray
    anchor: str  # Pillow's: l, m, r for the column and s for the baseline


@functools.cache
def font(size: float):
    return ImageFont.load_default(size)


def length(words: str, size: float) -> float:
    return font(size).getlength(words)


def printable(words: str) -> str:
    """One line in ASCII, which is about all that the font has: no accents, "?" for the rest."""
    letters = unicodedata.normalize("NFKD", " ".join(words.split()))
    plain = (c for c in letters if not unicodedata.combining(c))
    return "".join(
        c if c.isascii() else "-" if unicodedata.category(c) == "Pd" else "?" for c in plain
    )


def shortened(words: str, size: float, room: float) -> str:
    """The words, or as many of their letters as the room [pixels] holds, and three dots."""
    words = printable(words)
    if length(words, size) <= room:
        return words
    while words and length(words + "...", size) > room:
        words = words[:-1]
    return words.rstrip() + "..."


def heading(camera: Camera, title: str, time: float, longest_time: float) -> list[Text]:
    em, left, right = camera.em, camera.margin, camera.width - camera.margin
    factor, name = prefix(min(longest_time, 1.0))
    clock = f"t = {time / factor:.3f} {name}s"
    room = right - left
    if camera.narrow:
        beside = Text((left, 3.4 * em), clock, em, palette.FAINT_INK, "ls")
    else:
        beside = Text((right, 1.9 * em), clock, em, palette.FAINT_INK, "rs")
        room -= length(clock, em) + 1.5 * em
    title = shortened(title, 1.2 * em, room)
    return [Text((left, 1.9 * em), title, 1.2 * em, palette.INK, "ls"), beside]


def scale_bar(image: np.ndarray, camera: Camera, size: np.ndarray) -> list[Text]:
    """A bar of a round length: below the domain in 2D, on a lower edge of its box in 3D, where
    perspective makes it as long as what is there; below, where the view has no room for that."""
    em = camera.em
    edge = _bar_on_edge(camera, size) if len(size) == 3 else None
    if edge is None:
        return bar_below(image, camera)
    meters, start, end = edge
    words = with_unit(meters, "m")
    middle, row = (start + end) / 2 + (-0.3 * em, 1.3 * em)
    left = max(middle - length(words, em), camera.margin)
    return _bar(image, em, start, end, (left, row), words)


def bar_below(image: np.ndarray, camera: Camera) -> list[Text]:
    """A bar of a round length in the lower left corner, in 3D as long as what is as far away as the
    middle of the view, and it says so."""
    em = camera.em
    meters = round_length(5 * em / camera.scale)
    start = np.array([camera.margin, camera.height - 3.1 * em])
    end = start + np.array([meters * camera.scale, 0])
    words = with_unit(meters, "m") + (" in the middle" if len(camera.center) == 3 else "")
    return _bar(image, em, start, end, (camera.margin, camera.height - 1.4 * em), words)


def _bar(image, em, start, end, at, words) -> list[Text]:
    draw_lines(image, start[None], end[None], palette.INK, thickness=max(1, em / 7))
    return [Text(at, words, em, palette.INK, "ls")]


def _bar_on_edge(camera: Camera, size: np.ndarray):
    """Its length and its ends on the picture, from the left end of that lower edge of the box which
    is least foreshortened and, of the two, nearer; None where it would be cut off."""
    axis = 0 if abs(camera.axes[0, 0]) >= abs(camera.axes[0, 2]) else 2
    other = 2 - axis
    start = np.zeros(3)
    start[other] = size[other] if camera.axes[2, other] > 0 else 0.0
    forward = camera.axes[0, axis] > 0
    start[axis] = 0.0 if forward else size[axis]
    meters = round_length(size[axis] / 3)
    end = start.copy()
    end[axis] += meters if forward else -meters
    ends = camera.pixel_of(np.stack([start, end]))
    left, right, top, bottom = camera.stage
    low, high = np.array([left - 1, top - 1]), np.array([right + 1, bottom + 1])
    seen = ((ends >= low) & (ends <= high)).all()
    return (meters, *ends) if seen and camera.axes[2, 1] < 0.9 else None


def color_bar(
    image: np.ndarray, camera: Camera, name: str, quantity: Quantity, low: float, high: float
) -> list[Text]:
    em = camera.em
    columns, right = 9 * em, camera.width - camera.margin
    left, row = right - columns, camera.height - round(3.4 * em)
    shades = quantity.colors(np.linspace(0, 1, columns))
    image[row : row + round(0.6 * em), left:right] = shades
    ticks = [low, (low + high) / 2, high]
    labels, unit = tick_labels(ticks, quantity.unit, quantity.prefixed)
    ends = zip((left, (left + right) / 2, right), labels, ("ls", "ms", "rs"), strict=True)
    numbers = [
        Text((column, camera.height - 1.4 * em), label, 0.9 * em, palette.FAINT_INK, anchor)
        for column, label, anchor in ends
    ]
    words = f"{name.replace('_', ' ')} [{unit}]"
    return [Text((left, row - 0.5 * em), words, em, palette.INK, "ls"), *numbers]


def body_names(image: np.ndarray, camera: Camera, names: list[str]) -> list[Text]:
    """A dot and a name for each body, and "+ k" for the k bodies that there is no room for."""
    em, row = camera.em, camera.height - 1.4 * camera.em
    left, right = camera.margin + 6 * em, camera.width - camera.margin
    names = [shortened(name, em, right - left - 4 * em) for name in names]
    gap = 1.2 * em
    starts = np.cumsum([0.0] + [1.1 * em + length(name, em) + gap for name in names])
    ends = starts[1:] - gap
    shown = np.searchsorted(ends, right - left, side="right")
    texts = []
    if shown < len(names):
        shown = max(1, np.searchsorted(ends, right - left - 3 * em))
        texts.append(Text((right, row), f"+ {len(names) - shown}", em, palette.FAINT_INK, "rs"))
        right -= 3 * em
    columns = right - (starts[shown] - gap) + starts[:shown]
    radius = np.full(shown, 0.35 * em)
    draw_discs(image, columns + radius, row - radius, radius, palette.body(np.arange(shown)))
    for column, name in zip(columns, names, strict=False):
        texts.append(Text((column + 1.1 * em, row), name, em, palette.INK, "ls"))
    return texts


def write(image: np.ndarray, texts: list[Text]) -> None:
    """The texts, into an image of uint8 [height, width, 3]."""
    for text in texts:
        face, (column, row) = font(text.size), text.at
        left, top, right, bottom = face.getbbox(text.words, anchor=text.anchor)
        left, top = max(int(column + left) - 2, 0), max(int(row + top) - 2, 0)
        part = image[top : int(row + bottom) + 3, left : int(column + right) + 3]
        if part.size:
            patch = Image.fromarray(part)
            at, color = (column - left, row - top), palette.eight_bit(text.color)
            ImageDraw.Draw(patch).text(at, text.words, color, face, anchor=text.anchor)
            part[:] = np.asarray(patch)
