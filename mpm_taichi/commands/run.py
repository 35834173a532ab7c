"""Run a scene (the default: `mpm_taichi SCENE`)."""

from .arguments import add_frames, add_machine, add_output, add_scene, progress_console, scene_of


def add(parser) -> None:
    add_scene(parser)
    add_machine(parser)
    add_frames(parser)
    add_output(parser)
    parser.add_argument("--json", action="store_true", help="print run.json to stdout")


def execute(options) -> int:
    scene = scene_of(options)
    from ..run import run  # starts with Taichi, which a bad scene need not wait for

    return run(scene, options.scene.stem, options, progress_console(options))
