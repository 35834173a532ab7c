"""All that buttons, keys and the mouse act on."""

from pathlib import Path
from typing import Any

import numpy as np

from .album import Album
from .layout import Layout, layout_of
from .looks import looks_of
from .playback import Playback
from .stage import draw_stage, draw_window
from .viewpoint import Viewpoint


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
        return layout_of(*self._size, self.looks.shows_log)

    @property
    def camera(self):
        """Of the stage now."""
        return self.viewpoint.camera(self.layout.stage.width, self.layout.stage.height)

    def resize(self, width: int, height: int) -> None:
        self._size = width, height

    def close(self) -> None:
        self.is_closed = True

    def save_picture(self) -> None:
        """Of the stage."""
        stage = self.layout.stage
        picture = draw_stage(self.playback, self.looks, self.viewpoint, stage.width, stage.height)
        self.notice = self.album.save(picture)

    def picture(self) -> np.ndarray:
        """uint8 [height, width, 3] of the window; drawn anew where something has changed."""
        looks, playback = self.looks, self.playback
        key = (
            self.layout, self.viewpoint.key(), looks.color_by, looks.shows_grid,
            looks.grid_opacity, looks.picked, id(playback.snapshot), playback.fault,
        )  # fmt: skip
        if key != self._key:
            self._key = key
            self._picture = draw_window(playback, looks, self.viewpoint, self.layout)
        return self._picture
