"""Turn a run into something to share: a page that plays it, a video, files for ParaView."""

import argparse
from pathlib import Path

from ..errors import InputError
from .arguments import number, positive

VIDEOS = ("mp4", "gif", "webp")
KINDS = ("html", *VIDEOS, "vtk")
"""The flags, each of which makes something."""

HERE = Path()
"""A flag that takes a file, without one: the default, in the folder of the run."""


def add(parser) -> None:
    parser.add_argument("folder", type=Path, metavar="RUN", help="folder of a run")
    _add_file(
        parser, "html",
        "the recorded particles as a page that plays them in a browser; default: RUN/player.html",
    )  # fmt: skip
    parser.add_argument(
        "--every", type=positive, metavar="K", help="--html with each K-th frame; default: all"
    )
    for kind, text in (
        ("mp4", "the pictures of the run as a video"),
        ("gif", "the pictures as a GIF of 256 colors"),
        ("webp", "the pictures as an animated WebP"),
    ):
        _add_file(parser, kind, f"{text}; default: RUN/video.{kind}")
    parser.add_argument(
        "--vtk", action="store_true",
        help="the recorded particles for ParaView: RUN/paraview/particles.pvd",
    )  # fmt: skip
    parser.add_argument(
        "--fps", type=_fps, metavar="F", help="pictures a second of a video; default: 25"
    )
    parser.add_argument("--overwrite", action="store_true", help="replace files that are there")


def execute(options) -> int:
    if not any(getattr(options, kind) for kind in KINDS):
        raise InputError(f"export: into what? {', '.join(f'--{kind}' for kind in KINDS)}")
    if options.every and not options.html:
        raise InputError("--every: is for --html")
    if options.fps and not any(getattr(options, kind) for kind in VIDEOS):
        raise InputError("--fps: is for --mp4, --gif and --webp")
    if options.html:
        from ..exports.player import export_player

        file = _file(options, "html", "player.html")
        export_player(options.folder, file, options.every or 1, options.overwrite)
    for kind in VIDEOS:
        if getattr(options, kind):
            from ..exports.video import export_video

            file = _file(options, kind, f"video.{kind}")
            export_video(options.folder, file, options.fps or 25.0, options.overwrite)
    if options.vtk:
        from ..exports.vtk import export_vtk

        export_vtk(options.folder, options.overwrite)
    return 0


def _add_file(parser, kind: str, text: str) -> None:
    """The flag --KIND [FILE.KIND]."""

    def file(word: str) -> Path:
        if Path(word).suffix != f".{kind}":
            raise argparse.ArgumentTypeError(
                f"{word} is no .{kind} file (the run comes first: export RUN --{kind})"
            )
        return Path(word)

    parser.add_argument(f"--{kind}", nargs="?", type=file, const=HERE, metavar="FILE", help=text)


def _file(options, kind: str, default: str) -> Path:
    wanted = getattr(options, kind)
    return options.folder / default if wanted == HERE else wanted


def _fps(text: str) -> float:
    value = number(text)
    if not 0 < value <= 240:
        raise argparse.ArgumentTypeError(f"must be above 0 and at most 240 (got {text!r})")
    return value
