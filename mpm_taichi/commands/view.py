"""Watch a scene in a window while it is computed; nothing is recorded."""

from .arguments import add_machine, add_scene, progress_console, scene_of


def add(parser) -> None:
    add_scene(parser)
    add_machine(parser)
    parser.add_argument("-q", "--quiet", action="store_true", help="say nothing on the terminal")


def execute(options) -> int:
    scene = scene_of(options)
    from ..window.live import view  # starts with Taichi, which a bad scene need not wait for

    return view(scene, options.scene.stem, options, progress_console(options))
