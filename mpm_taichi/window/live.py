"""`view`: a simulation in a window."""

import sys
from pathlib import Path
from typing import Any

from rich.console import Console

from .. import doctor
from ..errors import InputError
from ..interruption import Interrupted, Interruption
from ..run import announce
from ..simulation import Simulation
from .desk import Desk
from .gestures import Gestures, keys
from .panel import draw_panel
from .screen import Screen

SIZE = 1280, 800


def view(scene, name: str, options, console: Console) -> int:
    """Until the window is closed; `name` is that of the scene's file.  Returns the exit code."""
    refuse_without_window()
    try:
        with Interruption() as interruption:
            simulation = Simulation(scene, options.device or "cpu", options.precision,
                                    options.threads)  # fmt: skip
            interruption.watch(simulation)
            announce(simulation, console)
            console.print("compiling kernels; later starts find them in Taichi's cache ...")
            desk = Desk(simulation, name, Path.cwd(), *SIZE)
            console.print("nothing of this is recorded: `run` does that; p saves a picture")
            if interruption.number is None:
                with Screen(f"mpm_taichi: {scene.title or name}", *SIZE) as screen:
                    watch(screen, desk, lambda: interruption.number is not None)
            number = interruption.number
    except Interrupted as signal_name:
        return signal_name.exit_code
    if desk.playback.fault is not None:
        print(desk.playback.fault, file=sys.stderr)
    return 0 if number is None else 128 + number


def watch(screen: Any, desk: Desk, is_over=lambda: False) -> None:
    """Frame by frame, until the Screen is closed or it `is_over`."""
    gestures, acts = Gestures(desk), keys(desk)
    while screen.is_open and not desk.is_closed and not is_over():
        desk.playback.go_on()
        desk.resize(*screen.shape)
        screen.put(desk.picture())
        draw_panel(screen, desk)
        screen.show()
        pressed, buttons = screen.pressed()
        for key in pressed:
            if key in acts:
                acts[key]()
        gestures.follow(buttons, screen.held(), screen.pointer())


def refuse_without_window() -> None:
    """InputError where no window opens, with what would bring one.  Asked in a process of its own:
    without a display or Vulkan some answers are crashes."""
    found = doctor.window()
    if not found["opens"]:
        raise InputError(
            f"view: no window opens here: {found['note']}. On Debian or Ubuntu: sudo apt-get "
            "install libvulkan1 mesa-vulkan-drivers; without a display also xvfb xauth, and "
            "xvfb-run before the command. Nothing of this is needed to run a scene and to watch "
            "it in a browser: python -m mpm_taichi SCENE, then export RUN --html"
        )
