"""Validate and seed a scene, and show the plan: particles, memory, time step, steps."""

from .arguments import add_frames, add_machine, add_scene, progress_console, scene_of


def add(parser) -> None:
    add_scene(parser)
    add_machine(parser)
    add_frames(parser)


def execute(options) -> int:
    scene = scene_of(options)
    from ..run import check

    return check(scene, options, progress_console(options))
