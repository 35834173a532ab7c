"""Arguments that several commands have, and what makes a number of a word."""

import argparse
from math import nan
from pathlib import Path


def add_scene(parser: argparse.ArgumentParser, required: bool = True) -> None:
    nargs = None if required else "?"
    parser.add_argument("scene", type=Path, nargs=nargs, help="scene file (YAML)")
    parser.add_argument(
        "--set", action="append", default=[], metavar="KEY=VALUE",
        help="change a value of the scene: --set bodies[0].velocity=[0,1]",
    )  # fmt: skip


def add_machine(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--device", choices=("cpu", "cuda", "vulkan", "metal"), help="default: cpu")
    parser.add_argument(
        "--precision", choices=("f32", "f64"),
        help="default: the scene's, else f64 on cpu and cuda, f32 on vulkan and metal",
    )  # fmt: skip
    parser.add_argument(
        "--threads", type=positive, help="default: what the size of the scene is worth"
    )


def add_frames(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--frames", type=positive, metavar="N", help="number of outputs after the start"
    )


def add_output(parser: argparse.ArgumentParser, kind: str = "") -> None:
    parser.add_argument(
        "-o", "--output", type=Path, metavar="DIR",
        help=f"folder of the results; default: the next of runs/<scene>-{kind}001, -{kind}002, ...",
    )  # fmt: skip
    parser.add_argument(
        "--overwrite", action="store_true", help="replace the results that are in -o DIR"
    )
    parser.add_argument("-q", "--quiet", action="store_true", help="no progress")


def add_picture(parser: argparse.ArgumentParser, default: str) -> None:
    parser.add_argument(
        "-o", "--output", type=Path, metavar="FILE.png", help=f"picture; default: {default}"
    )
    parser.add_argument("--overwrite", action="store_true", help="replace a picture that is there")


def scene_of(options):
    """The scene that the options name and change."""
    from ..scene import load_scene

    scene = load_scene(options.scene, options.set)
    if getattr(options, "frames", None) is None:
        return scene
    every = f"output.every={scene.time.end / options.frames!r}"
    return load_scene(options.scene, [*options.set, every])


def progress_console(options):
    """stderr, for people; silent where -q says so."""
    from rich.console import Console

    quiet = getattr(options, "quiet", False)
    return Console(stderr=True, quiet=quiet, markup=False, highlight=False)


def number(text: str) -> float:
    """No number: nan."""
    try:
        return float(text)
    except ValueError:
        return nan


def positive(text: str) -> int:
    if not text.isdecimal() or not 1 <= int(text) <= 2**31 - 1:
        raise argparse.ArgumentTypeError(f"must be a whole number from 1 on (got {text!r})")
    return int(text)
