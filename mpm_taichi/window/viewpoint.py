"""From where the user looks: pan and zoom, and in 3D orbit."""

from dataclasses import replace

import numpy as np

from ..renderers.camera import NARROW, TILT, TURN, Camera, corners, orientation, viewpoint

EM = 15
"""Size of the texts [pixels]."""

SIDE, TOP, BOTTOM = 2 * EM, 4 * EM, 7 * EM
"""Room around the domain for texts [pixels]."""

ZOOMS = (0.2, 400.0)

DEGREE = 3
"""Pixels of dragging that turn the view by one."""


class Viewpoint:
    """The camera of the pictures, movable.  `center` [m], which stays within the domain, is seen in
    the middle, `zoom` times as large as where all of the domain is seen."""

    def __init__(self, domain_size):
        self.size = np.asarray(domain_size, float)
        self.reset()

    def reset(self) -> None:
        """All of the domain."""
        self.center, self.zoom, self.turn, self.tilt = self.size / 2, 1.0, TURN, TILT

    def key(self) -> tuple:
        """Equal for equal views."""
        return *self.center, self.zoom, self.turn, self.tilt

    def camera(self, width: int, height: int) -> Camera:
        """For a picture of so many pixels."""
        plain = viewpoint(self.size)
        seen = plain.pixel_of(corners(self.size))
        low, high = seen.min(axis=0), seen.max(axis=0)
        room = np.array([width - 2 * SIDE, height - TOP - BOTTOM])
        scale = max(float((room / (high - low)).min()), 1e-9)
        column, row = (SIDE, TOP) + room / 2 - scale * (low + high) / 2
        return replace(
            plain,
            axes=orientation(len(self.size), self.turn, self.tilt),
            center=self.center,
            scale=scale * self.zoom,
            column=column,
            row=row,
            width=width,
            height=height,
            em=EM,
            margin=SIDE,
            narrow=width < NARROW * EM,
        )

    def pan(self, camera: Camera, columns: float, rows: float) -> None:
        """What is seen moves by so many pixels, in 3D at the distance of the center."""
        right, up, _ = camera.axes
        moved = self.center - (right * columns - up * rows) / camera.scale
        self.center = np.clip(moved, 0, self.size)

    def zoom_by(self, camera: Camera, factor: float, at=None) -> None:
        """What is seen at the pixel `at` (column, row), by default in the middle, stays there."""
        zoom = float(np.clip(self.zoom * factor, *ZOOMS))
        away = self.zoom / zoom - 1
        if at is not None:
            self.pan(camera, (at[0] - camera.column) * away, (at[1] - camera.row) * away)
        self.zoom = zoom

    def orbit(self, columns: float, rows: float) -> None:
        """Dragged by so many pixels; never from below the floor."""
        self.turn -= columns / DEGREE
        self.tilt = float(np.clip(self.tilt + rows / DEGREE, 0, 90))
