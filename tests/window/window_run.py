"""A window in a process of its own: two of them in one process crash at its end.

python -m tests.window.window_run hidden OUT.npz     the frame as it would be shown
python -m tests.window.window_run shown FOLDER       prints a line of JSON at each frame"""

import json
import sys
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from mpm_taichi.window.live import watch
from mpm_taichi.window.panel import draw_panel
from mpm_taichi.window.screen import Screen

from .desks import SIZE, desk_in

TITLE = "mpm_taichi window test"


def hidden(path: str) -> None:
    """Also of a second frame, of another moment and other choices."""
    desk = desk_in(Path(path).parent, "time.end=0.1")
    desk.looks.color_by = "body"
    with Screen(TITLE, *SIZE, is_hidden=True) as screen:

        def frame():
            screen.put(desk.picture())
            draw_panel(screen, desk)
            return screen.read()

        frame()  # widgets are laid out in one frame and drawn in the next
        first = frame()
        desk.playback.start_or_stop()
        desk.playback.go_on()
        desk.looks.shows_log = True
        frame()
        second = frame()
        canvas, box = desk.picture(), desk.layout.canvas
    np.savez(path, first=first, second=second, canvas=canvas, box=box)


class Listed:
    """The widgets of a part of the window, which it notes in their order."""

    def __init__(self, part):
        self.part, self.widgets = part, []

    def __getattr__(self, kind):
        def widget(label, *values):
            self.widgets.append([kind, label])
            return getattr(self.part, kind)(label, *values)

        return widget


class Told:
    """A screen that tells how things are, at each frame."""

    def __init__(self, screen, desk):
        self.screen, self.desk, self.frame, self.parts = screen, desk, 0, {}

    def __getattr__(self, name):
        return getattr(self.screen, name)

    @contextmanager
    def sub_window(self, name, box):
        with self.screen.sub_window(name, box) as part:
            self.parts[name] = Listed(part)
            yield self.parts[name]

    def show(self):
        self.screen.show()
        self.frame += 1
        desk = self.desk
        looks, view, playback = desk.looks, desk.viewpoint, desk.playback
        now = {
            "frame": self.frame, "running": playback.is_running,
            "step": playback.simulation.step_count,
            "steps": playback.steps_per_frame, **vars(looks), "walks": playback.walk is not None,
            "stage": getattr(playback.stage_of(0), "name", None), "zoom": view.zoom,
            "center": view.center.tolist(), "shape": list(self.screen.shape),
            "notice": desk.notice, "widgets": self.parts["Controls"].widgets,
        }  # fmt: skip
        print(json.dumps(now), flush=True)


def shown(folder: str) -> None:
    desk = desk_in(Path(folder))
    with Screen(TITLE, *SIZE) as screen:
        watch(Told(screen, desk), desk)


if __name__ == "__main__":
    {"hidden": hidden, "shown": shown}[sys.argv[1]](sys.argv[2])
