"""What keys and the mouse do."""

import numpy as np

from .desk import Desk

CLICK = 4
"""Pixels that the mouse may move in a click."""

NEAR = 8
"""Pixels around a click in which a particle is found."""

REACH = 0.75
"""Or so many edges of the particle: more than half its diagonal, so that bodies have no gaps."""

CLOSER = 1.25
"""Zoom of a key or button."""

DOUBLE = 120
"""Pixels of dragging that zoom by two."""


def keys(desk: Desk) -> dict:
    """What each does, by the names that the window gives them."""
    playback, looks, viewpoint = desk.playback, desk.looks, desk.viewpoint
    return {
        " ": playback.start_or_stop,
        "s": playback.step,
        "r": playback.reset,
        "g": looks.toggle_grid,
        "l": looks.toggle_log,
        "t": desk.toggle_stages,
        "c": looks.next_color,
        "v": viewpoint.reset,
        "p": desk.save_picture,
        "q": desk.close,
        "Up": lambda: viewpoint.zoom_by(desk.camera, CLOSER),
        "Down": lambda: viewpoint.zoom_by(desk.camera, 1 / CLOSER),
        "Escape": lambda: looks.pick(None),
    }


def particle_at(desk: Desk, column: float, row: float) -> int | None:
    """That which is seen at a pixel of the canvas, in 3D the nearest to the viewer."""
    snapshot = desk.playback.snapshot
    sight = desk.camera.look(snapshot.visible_position)
    edge = snapshot.initial_volume ** (1 / snapshot.position.shape[1])
    with np.errstate(invalid="ignore"):
        distance = np.hypot(sight.column - column, sight.row - row)
        found = np.flatnonzero(distance <= np.maximum(REACH * edge * sight.scale, NEAR))
    if len(found) == 0:
        return None
    if len(desk.viewpoint.size) == 3:
        return int(found[np.argmax(sight.toward[found])])
    return int(found[np.argmin(distance[found])])


class Gestures:
    """The mouse on the canvas.  A click picks a particle.  Dragging pans in 2D and orbits in 3D;
    with the right button it zooms in 2D and pans in 3D, with the middle one it zooms in 3D."""

    def __init__(self, desk: Desk):
        self.desk = desk
        self._button: str | None = None
        self._start, self._last, self._is_drag = (0.0, 0.0), (0.0, 0.0), False

    def follow(self, pressed: list[str], held: set[str], at: tuple[float, float]) -> None:
        """The buttons (LMB, MMB, RMB) pressed since the last time and those held now; the pixel
        (column, row) of the window that the mouse is at."""
        for button in pressed:
            if self._button is None and self.desk.layout.canvas.holds(*at):
                self._button, self._start, self._last, self._is_drag = button, at, at, False
        if self._button is None:
            return
        self._is_drag |= float(np.hypot(at[0] - self._start[0], at[1] - self._start[1])) >= CLICK
        if self._is_drag:
            self._drag(at[0] - self._last[0], at[1] - self._last[1])
            self._last = at
        if self._button not in held:
            if not self._is_drag and self._button == "LMB":
                self.desk.looks.pick(particle_at(self.desk, *at))
            self._button = None

    def _drag(self, columns, rows):
        viewpoint, camera = self.desk.viewpoint, self.desk.camera
        plain = len(viewpoint.size) == 2
        if self._button == ("LMB" if plain else "RMB"):
            viewpoint.pan(camera, columns, rows)
        elif self._button == "LMB":
            viewpoint.orbit(columns, rows)
        else:
            viewpoint.zoom_by(camera, 2 ** (-rows / DOUBLE), self._start)
