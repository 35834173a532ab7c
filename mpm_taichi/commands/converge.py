"""Run a scene at successive resolutions: errors, observed order, picture."""

import argparse

from .arguments import add_machine, add_output, add_scene, progress_console, scene_of


def add(parser) -> None:
    add_scene(parser)
    add_machine(parser)
    parser.add_argument(
        "--levels", type=_levels, metavar="N", default=4,
        help="resolutions, each with cells of half the size; default: 4",
    )  # fmt: skip
    add_output(parser, "converge-")


def execute(options) -> int:
    scene = scene_of(options)
    from ..converge import converge

    return converge(scene, options.scene.stem, options, progress_console(options))


def _levels(text: str) -> int:
    if text not in map(str, range(2, 9)):
        raise argparse.ArgumentTypeError(f"must be a whole number from 2 to 8 (got {text!r})")
    return int(text)
