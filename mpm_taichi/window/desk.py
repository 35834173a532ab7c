"""All that buttons, keys and the mouse act on."""

from pathlib import Path
from typing import Any

import numpy as np

from .album import Album
from .canvas import draw_canvas, draw_window
from .layout import Layout, layout_of
from .looks import looks_of
from .playback import Playback
from .viewpoint import Viewpoint

ROOMY = 100
"""Pixels of a cell that holds arrows, nodes and numbers."""


class Desk:
    """A simulation, how it is looked at, and where pictures of it go; `notice`: the last thing to
    tell the user."""

    def __init__(self, simulation, name: str, folder: Path, width: int, height: int):
        scene = simulation.scene
        self.playback = Playback(simulation)
        self.looks = looks_of(scene)
        self.viewpoint = Viewpoint(scene.domain.size)
        self.album = Album(folder, name)
        self.notice = ""
        self.is_closed = False
        self._size = width, height
        self._key: Any = None
        self._picture = np.zeros((1, 1, 3), np.uint8)

    @property
    def layout(self) -> Layout:
        has_notes = self.looks.shows_log or self.playback.walk is not None
        return layout_of(*self._size, has_notes)

    @property
    def camera(self):
        """Of the canvas now."""
        return self.viewpoint.camera(self.layout.canvas.width, self.layout.canvas.height)

    def toggle_stages(self) -> None:
        """Step by stages, in 2D, or no longer.  The cells about the particle become large enough
        for what is drawn in them."""
        scene, view = self.playback.simulation.scene, self.viewpoint
        if scene.dimension != 2:
            return
        self.playback.toggle_stages()
        cell = self.camera.scale * scene.cell_size
        if self.playback.walk is not None and cell < ROOMY:
            view.center = np.clip(self.playback.snapshot.position[self.looks.watched], 0, view.size)
            view.zoom_by(self.camera, ROOMY / cell)

    def resize(self, width: int, height: int) -> None:
        self._size = width, height

    def close(self) -> None:
        self.is_closed = True

    def save_picture(self) -> None:
        """Of the canvas."""
        canvas = self.layout.canvas
        picture = draw_canvas(
            self.playback, self.looks, self.viewpoint, canvas.width, canvas.height
        )
        self.notice = self.album.save(picture)

    def picture(self) -> np.ndarray:
        """uint8 [height, width, 3] of the window; drawn anew where something has changed."""
        looks, playback = self.looks, self.playback
        key = (
            self.layout, self.viewpoint.key(), looks.color_by, looks.shows_grid,
            looks.grid_opacity, looks.picked, playback.looks_taken, playback.fault,
            playback.walk is None,
        )  # fmt: skip
        if key != self._key:
            self._key = key
            self._picture = draw_window(playback, looks, self.viewpoint, self.layout)
        return self._picture
