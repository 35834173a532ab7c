"""Validate and seed a scene, and show the plan: particles, memory, time step, steps, time."""

from ..errors import InputError
from .arguments import add_frames, add_machine, add_scene, progress_console, scene_of


def add(parser) -> None:
    add_scene(parser)
    add_machine(parser)
    add_frames(parser)
    parser.add_argument(
        "--no-time", dest="time", action="store_false",
        help="leave out the time of the run, which takes its first steps to tell",
    )  # fmt: skip
    parser.add_argument(
        "--margin", action="store_true",
        help="measure the longest stable step of the scene at its start (elastic laws, up to 20000 "
        "particles, a minute or two)",
    )  # fmt: skip


def execute(options) -> int:
    if options.margin and (options.device or options.precision or options.threads):
        raise InputError(
            "--margin: is measured on one thread of the CPU in f64; leave out --device, "
            "--precision, --threads"
        )
    scene = scene_of(options)
    from ..run import check

    console = progress_console(options)
    code = check(scene, options, console)
    if options.margin:
        from ..margin import margin

        console.print(margin(scene), soft_wrap=True)
    return code
