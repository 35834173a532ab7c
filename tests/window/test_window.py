"""The window itself: read where it is hidden, clicked through where there is a display.

Needs a Vulkan driver, `xvfb` and `xdotool`; without them these tests are skipped, but not in CI."""

import json
import queue
import shutil
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from mpm_taichi import cli, doctor
from mpm_taichi.renderers import palette
from mpm_taichi.window.layout import layout_of
from mpm_taichi.window.looks import COLORS
from mpm_taichi.window.viewpoint import Viewpoint
from tests.command_line import ROOT, environment, in_words, mpm_taichi
from tests.missing import missing
from tests.window.desks import SCENE, SIZE

LAVAPIPE = Path("/usr/share/vulkan/icd.d/lvp_icd.x86_64.json")
PATIENCE = 90.0
"""Seconds for a window to open, and for a click to have its effect: other work may be going on."""


@pytest.fixture(scope="module")
def vulkan() -> dict[str, str]:
    """The environment for the software driver."""
    if not LAVAPIPE.is_file():
        missing("mesa-vulkan-drivers")
    return environment(VK_ICD_FILENAMES=str(LAVAPIPE))


@pytest.fixture(scope="module")
def display(vulkan):
    """An X server without a screen."""
    for program in ("Xvfb", "xdotool"):
        if shutil.which(program) is None:
            missing(program)
    command = ["Xvfb", "-displayfd", "1", "-screen", "0", "1400x1000x24", "-nolisten", "tcp"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL) as server:
        assert server.stdout is not None
        number = server.stdout.readline().decode().strip()
        yield vulkan | {"DISPLAY": f":{number}"}
        server.terminate()


def center_of(image, color) -> np.ndarray:
    """Centroid [column, row] of the pixels of a color, in the upper left part with the domain."""
    mask = (np.abs(image[:700, :900].astype(int) - palette.eight_bit(color)) <= 1).all(-1)
    return np.argwhere(mask).mean(0)[::-1]


@pytest.mark.slow
def test_a_hidden_window_shows_the_picture(vulkan, tmp_path):
    """Through Vulkan the canvas comes out as it was drawn, to a bit of 8, widgets beside it: so the
    disks of 2 x 208 particles stand where they are, (0.2, 0.2) and (0.8, 0.8), within a pixel.
    Nothing is written where the program was started."""
    path = tmp_path / "frames.npz"
    command = [sys.executable, "-m", "tests.window.window_run", "hidden", str(path)]
    done = subprocess.run(
        command, cwd=ROOT, env=vulkan, capture_output=True, text=True, timeout=PATIENCE
    )
    assert done.returncode == 0, done.stderr
    assert [file.name for file in tmp_path.iterdir()] == ["frames.npz"]
    assert not (ROOT / "imgui.ini").exists()
    with np.load(path) as frames:
        first, second, canvas, box = (frames[name] for name in ("first", "second", "canvas", "box"))
    width, height = box[2:]
    shown, drawn = second[:height, :width].astype(int), canvas[:height, :width]
    assert np.abs(shown - drawn).max() <= 1
    whole = layout_of(*SIZE, has_notes=False).canvas
    camera = Viewpoint((1, 1)).camera(whole.width, whole.height)
    for body, at in ((0, 0.2), (1, 0.8)):
        expected = camera.pixel_of([at, at])
        assert center_of(first, palette.BODIES[body]) == pytest.approx(expected, abs=1)
    buttons = first[: whole.height - 250, whole.width :]
    assert len(np.unique(buttons.reshape(-1, 3), axis=0)) > 10
    log = second[height:, :width]
    assert len(np.unique(log.reshape(-1, 3), axis=0)) > 10


class Window:
    """A window that is shown, by what it says of itself, with a mouse and a keyboard."""

    def __init__(self, process, env):
        self.process, self.env, self.now = process, env, {}
        self.lines: queue.Queue[str] = queue.Queue()
        threading.Thread(target=self._listen, daemon=True).start()
        self.until(lambda now: now.get("widgets"))
        words = ("search", "--sync", "--onlyvisible", "--name", "mpm_taichi window test")
        self.id = self.xdotool(*words).split()[0]
        place = self.xdotool("getwindowgeometry", "--shell", self.id).split()
        self.corner = [int(word[2:]) for word in place if word[:2] in ("X=", "Y=")]

    def _listen(self):
        for line in self.process.stdout:
            self.lines.put(line)

    def xdotool(self, *words) -> str:
        done = subprocess.run(
            ["xdotool", *map(str, words)],
            env=self.env, capture_output=True, text=True, timeout=PATIENCE,
        )  # fmt: skip
        assert done.returncode == 0, done.stderr
        return done.stdout

    def until(self, is_so) -> dict[str, Any]:
        """How things are as soon as they are so."""
        end = time.monotonic() + PATIENCE
        while not (self.now and is_so(self.now)):
            try:
                self.now = json.loads(self.lines.get(timeout=max(end - time.monotonic(), 0.01)))
            except queue.Empty:
                widgets = self.now.pop("widgets", None)
                pytest.fail(f"nothing came of it: {self.now}, with {widgets}")
        return self.now

    def wait(self, frames: int = 2) -> None:
        """So long does what has just been done take to be seen, and seen as done."""
        first = self.now["frame"]
        while not self.lines.empty():
            first = json.loads(self.lines.get())["frame"]
        self.until(lambda now: now["frame"] >= first + frames)

    def move(self, column, row) -> None:
        self.xdotool("mousemove", round(self.corner[0] + column), round(self.corner[1] + row))
        self.wait()

    def drag(self, *places) -> None:
        """From one to the next; a click, where there is only one."""
        self.move(*places[0])
        self.xdotool("mousedown", 1)
        self.wait()
        for place in places[1:]:
            self.move(*place)
        self.xdotool("mouseup", 1)
        self.wait()

    def press(self, key) -> None:
        self.xdotool("keydown", key)
        self.wait()
        self.xdotool("keyup", key)

    def place(self, wanted: str, across: float = 0.02) -> tuple[float, float]:
        """The pixel of a widget whose label begins so, as Dear ImGui lays them out: below each
        other, texts 13 pixels high and the others 19, 4 between them, from (8, 27) of the panel."""
        (width, height), row = self.now["shape"], 27.0
        panel = layout_of(width, height, False).panel
        for kind, label in self.now["widgets"]:
            height = 13 if kind == "text" else 19
            if label.lower().startswith(wanted):
                width = 0.65 * (panel.width - 16) if kind.startswith("slider") else panel.width - 16
                return panel.left + 8 + 6 + across * width, row + height / 2
            row += height + 4
        raise AssertionError(f"there is no widget {wanted}")

    def use(self, wanted: str, is_so, across: float = 0.02) -> None:
        self.drag(self.place(wanted, across))
        self.until(is_so)


def start(display, folder) -> Window:
    process = subprocess.Popen(
        [sys.executable, "-m", "tests.window.window_run", "shown", str(folder)],
        cwd=ROOT, env=display, stdout=subprocess.PIPE, text=True,
    )  # fmt: skip
    return Window(process, display)


@pytest.mark.slow
def test_every_control_of_the_window(display, tmp_path):
    """A real pointer and real keys in a real window: each widget of the panel is clicked and does
    what it says; then the canvas is clicked, dragged and zoomed, keys are pressed, the window takes
    another size, and ends with exit code 0."""
    window = start(display, tmp_path)
    try:
        _use_all(window, tmp_path)
        window.xdotool("key", "q")
        assert window.process.wait(PATIENCE) == 0
    finally:
        window.process.kill()
        window.process.wait()


def _use_all(window: Window, folder: Path):
    used = []

    def use(wanted, is_so, across=0.02):
        used.append(wanted)
        window.use(wanted, is_so, across)

    use("start", lambda now: now["running"] and now["step"] > 20)
    use("stop", lambda now: not now["running"])
    before = window.now["step"]
    use("step (s)", lambda now: now["step"] == before + 1)
    use("reset", lambda now: now["step"] == 0)
    use("steps/frame", lambda now: now["steps"] > 40, across=0.9)
    use("toggle grid", lambda now: not now["shows_grid"])
    use("grid opacity", lambda now: now["grid_opacity"] > 0.7, across=0.8)
    use("toggle log", lambda now: now["shows_log"])
    log = layout_of(*SIZE, has_notes=True).notes
    window.drag((log.left + 0.3 * log.width, log.top + 27 + 9.5))
    window.until(lambda now: now["first"] > 50)
    window.press("l")
    window.until(lambda now: not now["shows_log"])
    use("step by stages", lambda now: now["walks"])
    for name in ("particles to nodes", "grid update"):
        use("step (s)", lambda now, name=name: now["stage"] == name)
    window.press("t")
    window.until(lambda now: not now["walks"] and now["step"] == 1)
    use("whole domain", lambda now: now["zoom"] == 1)
    for name in COLORS:
        use(name.replace("_", " "), lambda now, name=name: now["color_by"] == name)
    use("zoom in", lambda now: now["zoom"] == 1.25)
    use("zoom out", lambda now: now["zoom"] == 1)
    window.press("Up")
    window.until(lambda now: now["zoom"] > 1)
    use("whole domain", lambda now: now["zoom"] == 1)
    use("save picture", lambda now: "disks-view-001.png" in now["notice"])
    assert [path.name for path in folder.iterdir()] == ["disks-view-001.png"]
    labels = [label.lower() for kind, label in window.now["widgets"] if kind != "text"]
    assert [label for label in labels if not any(label.startswith(word) for word in used)] == []
    canvas = layout_of(*SIZE, False).canvas
    camera = Viewpoint((1, 1)).camera(canvas.width, canvas.height)
    window.drag(camera.pixel_of([0.2, 0.2]))
    window.until(lambda now: now["picked"] is not None and now["picked"] < 208)
    at = camera.pixel_of([0.5, 0.6])
    window.drag(*at + np.array([[25 * k, 0] for k in range(5)]))
    window.until(lambda now: abs(now["center"][0] - (0.5 - 100 / camera.scale)) < 0.01)
    window.press("space")
    window.until(lambda now: now["running"])
    window.press("s")
    window.until(lambda now: not now["running"])
    window.xdotool("windowsize", window.id, 1000, 700)
    window.until(lambda now: now["shape"] == [1000, 700])
    use("toggle grid", lambda now: now["shows_grid"])


@pytest.mark.slow
def test_the_command(display, tmp_path):
    """`view` opens its window, says what will run and that nothing is recorded, and leaves nothing
    behind; Ctrl-C ends it with exit code 130.  Without Vulkan it is refused in words."""
    command = [sys.executable, "-m", "mpm_taichi", "view", str(SCENE), "--threads", "1"]
    with subprocess.Popen(
        command, cwd=tmp_path, env=display, stderr=subprocess.PIPE, text=True
    ) as it:
        words = ("search", "--sync", "--onlyvisible", "--name", "mpm_taichi: Two elastic disks")
        subprocess.run(
            ["xdotool", *words], env=display, timeout=PATIENCE, check=True, capture_output=True
        )
        time.sleep(0.5)
        it.send_signal(signal.SIGINT)
        said = it.communicate(timeout=PATIENCE)[1]
    assert it.returncode == 130
    assert "nothing of this is recorded" in said and in_words(said)
    assert list(tmp_path.iterdir()) == []
    bare = display | {"VK_ICD_FILENAMES": "/nonexistent.json"}
    done = subprocess.run(
        command, cwd=tmp_path, env=bare, capture_output=True, text=True, timeout=PATIENCE
    )
    assert done.returncode == 2 and in_words(done.stderr)
    assert "mesa-vulkan-drivers" in done.stderr and "Vulkan must be available" in done.stderr


def test_without_a_display(tmp_path):
    """Refused in a sentence that names the packages, with exit code 2: DISPLAY not set."""
    done = mpm_taichi("view", SCENE, cwd=tmp_path, DISPLAY="")
    assert done.returncode == 2 and in_words(done.stderr)
    for word in ("DISPLAY is not set", "libvulkan1", "xvfb", "--html"):
        assert word in done.stderr
    assert list(tmp_path.iterdir()) == []


def test_a_crash_is_words(monkeypatch, capfd):
    """Where the probe dies of a signal, so would the window: it is not opened."""
    monkeypatch.setenv("DISPLAY", ":0")
    monkeypatch.setattr(doctor, "probe", lambda *_: ([], "crashes (signal 11)"))
    assert cli.main(["view", str(SCENE)]) == 2
    assert "no window opens here: crashes (signal 11)" in capfd.readouterr().err
