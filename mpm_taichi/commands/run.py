"""Run a scene (the default: `mpm_taichi SCENE`), or go on with a run."""

from pathlib import Path

from ..errors import InputError
from .arguments import add_frames, add_machine, add_output, add_scene, progress_console, scene_of


def add(parser) -> None:
    add_scene(parser, required=False)
    add_machine(parser)
    add_frames(parser)
    add_output(parser)
    parser.add_argument(
        "--resume", type=Path, metavar="RUN", help="go on with the run in this folder"
    )
    parser.add_argument(
        "--force", action="store_true",
        help="go on also where scene, version or precision are others",
    )  # fmt: skip
    parser.add_argument(
        "--strict", action="store_true",
        help="exit code 1 where a line of the audit fails; the results are kept",
    )  # fmt: skip
    parser.add_argument("--json", action="store_true", help="print run.json to stdout")


def execute(options) -> int:
    if options.resume is not None:
        return _resume(options)
    if options.scene is None:
        raise InputError("name a scene file: python -m mpm_taichi SCENE.yaml")
    if options.force:
        raise InputError("--force: is for --resume RUN")
    scene = scene_of(options)
    from ..run import run  # starts with Taichi, which a bad scene need not wait for

    return run(scene, options.scene.stem, options, progress_console(options))


def _resume(options) -> int:
    if options.output is not None or options.overwrite:
        raise InputError("--resume RUN goes on in the folder of the run: leave out -o, --overwrite")
    if options.frames is not None:
        raise InputError("--resume RUN keeps the outputs of the run: leave out --frames")
    from ..resume import resume

    return resume(options, progress_console(options))
