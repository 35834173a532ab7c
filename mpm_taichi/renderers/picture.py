"""One picture of a moment: the domain, its grid, the particles, and the texts around them."""

from dataclasses import dataclass

import numpy as np

from . import legend, palette
from .camera import PLAIN, Camera, View, corners, fit
from .ground import draw_ground, plane_axes, shadow_of
from .quantities import QUANTITIES, shown_range
from .rasterizer import draw_discs, draw_lines, eight_bits
from .spheres import draw_spheres

FINEST_CELL = 4.0
"""Lines of a grid with cells of fewer pixels are left out; they fade in up to twice as many."""

HAZE = 0.25
"""Part of the background in the color of a particle at the back of a 3D domain."""

FULL_SPHERE = (6 / np.pi) ** (1 / 3)
"""Radius of a sphere over half the edge of a cube of the same volume."""


@dataclass(frozen=True, eq=False)
class Frame:
    """What there is to see at one moment, in SI units."""

    position: np.ndarray  # [n, dim]; a particle with a NaN is skipped
    radius: np.ndarray  # [n], half the edge of the particle's cube
    body: np.ndarray  # [n], index into body_names
    body_names: list[str]
    time: float
    domain_size: tuple[float, ...]  # [dim]
    cells: tuple[int, ...]  # [dim]
    title: str = ""
    quantity: str = "body"  # or one of QUANTITIES
    value: np.ndarray | None = None  # [n], of the quantity; a NaN is shown in gray
    value_range: tuple[float, float] = (0.0, 1.0)
    longest_time: float = 0.0  # the end of the run: it decides between s, ms, us


def grid_lines(size: np.ndarray, cells: tuple[int, ...]) -> tuple[np.ndarray, np.ndarray]:
    """Starts and ends [n, dim] of the lines between the cells of the grid plane."""
    starts, ends = [], []
    for along, across in (plane_axes(len(size)), plane_axes(len(size))[::-1]):
        start = np.zeros((cells[across] - 1, len(size)))
        start[:, across] = np.arange(1, cells[across]) * size[across] / cells[across]
        end = start.copy()
        end[:, along] = size[along]
        starts.append(start)
        ends.append(end)
    return np.concatenate(starts), np.concatenate(ends)


def box_edges(camera: Camera, size: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Starts and ends [n, dim] of the edges of the domain, those at the corner next to the viewer
    last."""
    at = corners(size)
    nearest = int(camera.look(at).toward.argmax())
    pairs = [(a, b) for b in range(len(at)) for a in range(b) if (a ^ b).bit_count() == 1]
    pairs.sort(key=lambda pair: nearest in pair)
    return at[[a for a, _ in pairs]], at[[b for _, b in pairs]]


def draw_grid(image: np.ndarray, camera: Camera, frame: Frame, opacity: float) -> None:
    size = np.asarray(frame.domain_size)
    finest = min(camera.scale * size[axis] / frame.cells[axis] for axis in plane_axes(len(size)))
    opacity *= np.clip(finest / FINEST_CELL - 1, 0, 1)
    if opacity > 0:
        start, end = (camera.pixel_of(x) for x in grid_lines(size, frame.cells))
        draw_lines(image, start, end, palette.LINE, opacity=opacity)


def particle_colors(frame: Frame) -> np.ndarray:
    if frame.quantity == "body":
        return palette.body(frame.body)
    quantity = QUANTITIES[frame.quantity]
    low, high = shown_range(quantity, *frame.value_range)
    assert frame.value is not None
    return quantity.colors((frame.value - low) / (high - low))


def draw_as_discs(image: np.ndarray, camera: Camera, frame: Frame) -> None:
    """The particles of a 2D domain.

    Small discs are widened, from 4 pixels down to 2 by up to sqrt(2), so that they cover their
    square and a body shows its color without dark gaps; none is smaller than 0.7 pixels."""
    sight = camera.look(frame.position)
    radius = sight.scale * frame.radius
    radius *= 1 + (np.sqrt(2) - 1) * np.clip(2 - radius / 2, 0, 1)
    draw_discs(image, sight.column, sight.row, np.maximum(radius, 0.7), particle_colors(frame))


def draw_as_spheres(image: np.ndarray, camera: Camera, frame: Frame) -> None:
    """The particles of a 3D domain as spheres of their volume, paled by their distance."""
    sight = camera.look(frame.position)
    radius = np.maximum(FULL_SPHERE * sight.scale * frame.radius, 0.7)
    middle = np.asarray(frame.domain_size) / 2
    half = np.linalg.norm(middle)
    depth = (sight.toward - camera.look(middle[None]).toward) / half
    nearness = np.clip(np.nan_to_num(0.5 + 0.5 * depth), 0, 1)
    color = particle_colors(frame)
    color += HAZE * (1 - nearness)[:, None] * (palette.PANEL - color)
    toward = camera.scale * np.clip(sight.toward, -2 * half, 2 * half)  # one far off is just far
    draw_spheres(image, sight.column, sight.row, toward, radius, color)


def cut_off(image: np.ndarray, camera: Camera) -> None:
    """What a larger view shows beyond the stage."""
    rim = camera.em // 2
    left, right, top, bottom = camera.stage
    for outside in (
        np.s_[: top - rim], np.s_[bottom + rim :], np.s_[:, : left - rim], np.s_[:, right + rim :]
    ):  # fmt: skip
        image[outside] = palette.BACKGROUND


def draw(
    frame: Frame, grid_opacity: float = 0.5, size: int = 800, view: View = PLAIN
) -> np.ndarray:
    """The picture of a frame, uint8 [height, width, 3], row 0 at the top.

    The longer side of the domain is `size` pixels long; the margins come on top of it.  The same
    frame gives the same bytes, whatever the precision and threads of the run."""
    box = np.asarray(frame.domain_size, float)
    camera = fit(box, size, view)
    image = backdrop(camera, frame, grid_opacity)
    draw_particles(image, camera, frame)
    if view.zoom != 1 or view.center is not None:
        cut_off(image, camera)
    texts = legend.scale_bar(image, camera, box) + texts_around(image, camera, frame)
    return finished(image, texts)


def backdrop(camera: Camera, frame: Frame, grid_opacity: float) -> np.ndarray:
    """What lies behind the particles, on a new image of float32: the domain and its grid."""
    box = np.asarray(frame.domain_size, float)
    image = np.empty((camera.height, camera.width, 3), np.float32)
    shadow = shadow_of(frame.position, frame.radius, box) if len(box) == 3 else None
    draw_ground(image, camera, box, shadow)
    draw_grid(image, camera, frame, grid_opacity)
    start, end = (camera.pixel_of(x) for x in box_edges(camera, box))
    behind = len(start) if len(box) == 2 else -3
    draw_lines(image, start[:behind], end[:behind], palette.LINE)
    return image


def draw_particles(image: np.ndarray, camera: Camera, frame: Frame) -> None:
    """In 3D with the edges before them."""
    if len(frame.domain_size) == 2:
        draw_as_discs(image, camera, frame)
        return
    draw_as_spheres(image, camera, frame)
    edges = box_edges(camera, np.asarray(frame.domain_size, float))
    start, end = (camera.pixel_of(x)[-3:] for x in edges)
    draw_lines(image, start, end, palette.LINE, opacity=0.6)


def texts_around(image: np.ndarray, camera: Camera, frame: Frame) -> list[legend.Text]:
    """Title, time and what the colors mean, whose bar or dots go into the image."""
    texts = legend.heading(camera, frame.title, frame.time, max(frame.time, frame.longest_time))
    if frame.quantity == "body":
        return texts + legend.body_names(image, camera, frame.body_names)
    quantity = QUANTITIES[frame.quantity]
    shown = shown_range(quantity, *frame.value_range)
    return texts + legend.color_bar(image, camera, frame.quantity, quantity, *shown)


def finished(image: np.ndarray, texts: list[legend.Text]) -> np.ndarray:
    """float32 from 0 to 1 -> uint8, with its texts."""
    picture = eight_bits(image)
    legend.write(picture, texts)
    return picture
