"""The widgets: buttons, boxes, sliders, and the log."""

import textwrap
from typing import Any

from .desk import Desk
from .gestures import CLOSER
from .log import log_lines
from .looks import COLORS

LETTERS = 38
"""Of a line in the panel."""


def draw_panel(screen: Any, desk: Desk) -> None:
    """On a Screen.  A widget returns what the user has made of it."""
    with screen.sub_window("Controls", desk.layout.panel) as panel:
        _draw_playback(panel, desk)
        _draw_looks(panel, desk)
        _draw_view(panel, desk)
        for line in _status(desk):
            panel.text(line)
    if desk.looks.shows_log:
        _draw_log(screen, desk)


def _draw_playback(panel, desk):
    playback = desk.playback
    if panel.button("Stop (space)" if playback.is_running else "Start (space)"):
        playback.start_or_stop()
    if panel.button("Step (s)"):
        playback.step()
    if panel.button("Reset (r)"):
        playback.reset()
    playback.steps_per_frame = panel.slider_int(
        "Steps/frame", playback.steps_per_frame, 1, playback.most_steps
    )


def _draw_looks(panel, desk):
    looks = desk.looks
    looks.shows_grid = panel.checkbox("Toggle Grid (g)", looks.shows_grid)
    looks.grid_opacity = panel.slider_float("Grid opacity", looks.grid_opacity, 0.0, 1.0)
    looks.shows_log = panel.checkbox("Toggle Log (l)", looks.shows_log)
    panel.text("Color (c)")
    for name in COLORS:
        if panel.checkbox(name.replace("_", " "), looks.color_by == name):
            looks.color_by = name


def _draw_view(panel, desk):
    viewpoint = desk.viewpoint
    if panel.button("Zoom in (up)"):
        viewpoint.zoom_by(desk.camera, CLOSER)
    if panel.button("Zoom out (down)"):
        viewpoint.zoom_by(desk.camera, 1 / CLOSER)
    if panel.button("Whole domain (v)"):
        viewpoint.reset()
    if panel.button("Save picture (p)"):
        desk.save_picture()


def _status(desk):
    snapshot, playback = desk.playback.snapshot, desk.playback
    drag = "pan" if len(desk.viewpoint.size) == 2 else "orbit"
    lines = [
        f"{playback.status()}",
        f"step {snapshot.step}, t = {snapshot.time:.6g} s",
        f"drag: {drag}; click: pick a particle",
    ]
    return lines + textwrap.wrap(desk.notice, LETTERS)


def _draw_log(screen, desk):
    looks, last = desk.looks, int(desk.playback.simulation.ranges[-1]) - 1
    with screen.sub_window("Log", desk.layout.log) as log:
        looks.first = log.slider_int("First particle", looks.first, 0, last)
        for line in log_lines(desk.playback, looks):
            log.text(line)
