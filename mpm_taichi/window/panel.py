"""The widgets: buttons, boxes, sliders, and the log."""

import textwrap
from typing import Any

from .desk import Desk
from .gestures import CLOSER
from .log import log_lines
from .looks import COLORS
from .stage_notes import node_lines, stage_lines

LETTERS = 38
"""Of a line in the panel."""

STAGE = 0.42
"""Part of the notes' width that the numbers of a stage take."""


def draw_panel(screen: Any, desk: Desk) -> None:
    """On a Screen.  A widget returns what the user has made of it."""
    with screen.sub_window("Controls", desk.layout.panel) as panel:
        _draw_playback(panel, desk)
        _draw_looks(panel, desk)
        _draw_view(panel, desk)
        for line in _status(desk):
            panel.text(line)
    _draw_notes(screen, desk)


def _draw_playback(panel, desk):
    playback = desk.playback
    if panel.button("Stop (space)" if playback.is_running else "Start (space)"):
        playback.start_or_stop()
    if panel.button("Step (s)"):
        playback.step()
    if panel.button("Reset (r)"):
        playback.reset()
    if len(desk.viewpoint.size) == 2:
        by_stages = playback.walk is not None
        if panel.checkbox("Step by stages (t)", by_stages) != by_stages:
            desk.toggle_stages()
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


def _draw_notes(screen, desk):
    """Below the canvas: the log, the stage of the step, or both beside each other."""
    box, looks, playback = desk.layout.notes, desk.looks, desk.playback
    if playback.walk is None:
        if looks.shows_log:
            _draw_log(screen, desk, box)
        return
    width = int(STAGE * box.width)
    stage = playback.stage_of(looks.watched)
    dx = playback.simulation.scene.cell_size
    with screen.sub_window("Stage", box._replace(width=width)) as notes:
        for line in stage_lines(stage, dx):
            notes.text(line)
    rest = box._replace(left=box.left + width, width=box.width - width)
    if looks.shows_log:
        _draw_log(screen, desk, rest)
    else:
        with screen.sub_window("Nodes", rest) as notes:
            for line in node_lines(stage, dx):
                notes.text(line)


def _draw_log(screen, desk, box):
    looks, last = desk.looks, int(desk.playback.simulation.ranges[-1]) - 1
    with screen.sub_window("Log", box) as log:
        looks.first = log.slider_int("First particle", looks.first, 0, last)
        for line in log_lines(desk.playback, looks):
            log.text(line)
