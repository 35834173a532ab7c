"""All that the window shows beside its widgets, as one picture: the renderer's, which files get."""

import textwrap

import numpy as np

from ..renderers import legend, palette
from ..renderers.camera import Camera
from ..renderers.moment import frame_of, value_of
from ..renderers.picture import Frame, backdrop, draw_particles, finished, texts_around
from ..renderers.rasterizer import draw_lines
from .cell_numbers import draw_cell_numbers
from .chart import draw_chart
from .layout import Layout
from .looks import Looks
from .playback import Playback
from .sketch import draw_sketch
from .viewpoint import EM, Viewpoint

BAND = 0.75
"""Opacity of the background behind the texts."""

FAULT_INK = palette.rgb("ff9a76")[0]

CORNERS = 32
"""Of the ring about the picked particle."""


def frame_now(playback: Playback, looks: Looks) -> Frame:
    snapshot = playback.snapshot
    value = value_of(snapshot, looks.color_by)
    shown = playback.scales.of(looks.color_by)
    return frame_of(playback.simulation, snapshot, looks.color_by, value, shown)


def draw_ring(image: np.ndarray, camera: Camera, frame: Frame, particle: int) -> None:
    """About a particle; none where it is not seen."""
    sight = camera.look(frame.position[particle : particle + 1])
    at, radius = np.concatenate([sight.column, sight.row]), sight.scale * frame.radius[particle]
    angle = np.linspace(0, 2 * np.pi, CORNERS + 1)[:, None]
    ring = at + max(float(radius[0]) + 4, 7) * np.hstack([np.cos(angle), np.sin(angle)])
    if np.isfinite(ring).all():
        draw_lines(image, ring[:-1], ring[1:], palette.BACKGROUND, 5)
        draw_lines(image, ring[:-1], ring[1:], palette.INK, 2)


def fault_texts(fault: str, image: np.ndarray) -> list[legend.Text]:
    """What went wrong, in words, in the upper part of the image."""
    letters = max((image.shape[1] - 4 * EM) // (EM // 2), 20)
    lines = [line for part in fault.splitlines() for line in textwrap.wrap(part, letters)]
    top, bottom = 4 * EM, (5 + round(1.3 * len(lines))) * EM
    image[top:bottom] += BAND * (palette.BACKGROUND.astype(np.float32) - image[top:bottom])
    rows = top + EM + 1.3 * EM * np.arange(len(lines))
    return [
        legend.Text((2 * EM, row), legend.printable(line), EM, FAULT_INK, "ls")
        for row, line in zip(rows, lines, strict=True)
    ]


def draw_canvas(
    playback: Playback, looks: Looks, viewpoint: Viewpoint, width: int, height: int
) -> np.ndarray:
    """uint8 [height, width, 3], row 0 at the top."""
    frame, camera = frame_now(playback, looks), viewpoint.camera(width, height)
    opacity = looks.grid_opacity if looks.shows_grid else 0.0
    image = backdrop(camera, frame, opacity)
    draw_cell_numbers(image, camera, frame, opacity)
    draw_particles(image, camera, frame)
    stage, marks = playback.stage_of(looks.watched), []
    if stage is not None:
        marks = draw_sketch(image, camera, stage, playback.simulation.scene.cell_size)
    elif looks.picked is not None:
        draw_ring(image, camera, frame, looks.picked)
    for band in (image[: round(3.6 * EM)], image[-5 * EM :]):
        band += BAND * (palette.BACKGROUND.astype(np.float32) - band)
    texts = marks + legend.bar_below(image, camera) + texts_around(image, camera, frame)
    if playback.fault is not None:
        texts += fault_texts(playback.fault, image)
    return finished(image, texts)


def draw_window(
    playback: Playback, looks: Looks, viewpoint: Viewpoint, layout: Layout
) -> np.ndarray:
    """uint8 of the whole window: the canvas, the chart, and room for widgets."""
    color = np.array(palette.eight_bit(palette.BACKGROUND), np.uint8)
    image = np.tile(color, (layout.height, layout.width, 1))
    canvas, chart = layout.canvas, layout.chart
    image[: canvas.height, : canvas.width] = draw_canvas(
        playback, looks, viewpoint, canvas.width, canvas.height
    )
    image[chart.top :, chart.left :] = draw_chart(
        playback.energies, playback.simulation.end, chart.width, chart.height
    )
    return image
