"""The window itself: the one part that needs Vulkan, and unless it is hidden a display."""

import os
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
import taichi as ti
from PIL import Image
from taichi.ui.utils import get_field_info

from .layout import Box

BUTTONS = (ti.ui.LMB, ti.ui.MMB, ti.ui.RMB)

MOST_FRAMES = 30
"""A second; a software Vulkan takes 20 ms for one."""


class Screen:
    """A window of Taichi's GGUI: `with Screen(...) as screen`.  One at a time in a process.

    It lives in a folder of its own, as Dear ImGui writes imgui.ini into the current one: name files
    by absolute paths while it is open.  A hidden window can be read, but not shown."""

    def __init__(self, title: str, width: int, height: int, is_hidden: bool = False):
        self.title, self.size, self.is_hidden = title, (width, height), is_hidden

    def __enter__(self):
        self._before, self._folder = Path.cwd(), tempfile.TemporaryDirectory()
        os.chdir(self._folder.name)
        self._window: Any = ti.ui.Window(
            self.title, self.size, vsync=False, show_window=not self.is_hidden,
            fps_limit=MOST_FRAMES,
        )  # fmt: skip
        self._gui = self._window.get_gui()
        self._canvas = self._window.get_canvas()
        self._picture, self._pixels = None, None
        return self

    def __exit__(self, *_):
        self._window.destroy()
        os.chdir(self._before)
        self._folder.cleanup()

    @property
    def is_open(self) -> bool:
        return self._window.running

    @property
    def shape(self) -> tuple[int, int]:
        """Width and height now [pixels]."""
        return self._window.get_window_shape()

    def put(self, picture: np.ndarray) -> None:
        """uint8 [height, width, 3] behind the widgets of this frame; it fills the window.

        Taichi's own way, set_image, takes three passes over the pixels in a kernel."""
        if picture is not self._picture:
            turned = Image.fromarray(picture).convert("RGBA").transpose(Image.Transpose.ROTATE_270)
            pixels = np.asarray(turned).view(np.uint32)[..., 0]
            self._picture, self._pixels = picture, np.ascontiguousarray(pixels)
        self._canvas.canvas.set_image(get_field_info(self._pixels))

    def sub_window(self, name: str, box: Box) -> Any:
        """A place for widgets.  It stays where it was first, so that in another place it is another
        one: the words after ## tell them apart and are not shown.  Taichi reckons in parts of the
        size that the window had at first."""
        width, height = self.size
        return self._gui.sub_window(
            f"{name}##{' '.join(map(str, box))}",
            box.left / width, box.top / height, box.width / width, box.height / height,
        )  # fmt: skip

    def show(self) -> None:
        """The frame, and what the user does with it."""
        self._window.show()

    def read(self) -> np.ndarray:
        """The frame as it would be shown, uint8 [height, width, 3]."""
        image = self._window.get_image_buffer_as_numpy()[..., :3]
        return (np.rot90(image) * 255 + 0.5).astype(np.uint8)

    def pressed(self) -> tuple[list[str], list[str]]:
        """Keys and mouse buttons pressed since the last time."""
        names = [event.key for event in self._window.get_events(ti.ui.PRESS)]
        keys = [name for name in names if name not in BUTTONS]
        return keys, [name for name in names if name in BUTTONS]

    def held(self) -> set[str]:
        """Mouse buttons that are down."""
        return {button for button in BUTTONS if self._window.is_pressed(button)}

    def pointer(self) -> tuple[float, float]:
        """Pixel (column, row) of the mouse."""
        across, up = self._window.get_cursor_pos()
        width, height = self.shape
        return across * width, (1 - up) * height
