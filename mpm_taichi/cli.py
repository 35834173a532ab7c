"""The command line: arguments, exit codes, nothing else.

0 done, 1 the run failed, 2 bad input, 130 and 143 interrupted."""

import argparse
import difflib
import json
import os
import sys
from math import inf, nan
from pathlib import Path

from . import __version__
from .errors import InputError, RunError

COMMANDS = {
    "run": "run a scene (the default: `mpm_taichi SCENE`)",
    "check": "validate and seed a scene, and show the plan: particles, memory, time step, steps",
    "converge": "run a scene at successive resolutions: errors, observed order, picture",
    "advise": "which schemes were shown to reach an error, and how far the scene is from where",
    "materials": "list the laws with their parameters, and the presets with their sources",
    "curve": "draw stress against strain of a material",
    "schema": "print the JSON Schema of scene files, for editors",
}


def main(arguments: list[str] | None = None) -> int:
    words = list(sys.argv[1:] if arguments is None else arguments)
    try:
        options = parser().parse_args(_with_command(words))
        return _dispatch(options)
    except InputError as error:
        print(error, file=sys.stderr)
        return 2
    except RunError as error:
        print(error, file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return 130
    except BrokenPipeError:  # the reader of stdout, `head` say, has had enough
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
    except ImportError as error:
        return _missing_library(error)


def parser() -> argparse.ArgumentParser:
    top = argparse.ArgumentParser(
        prog="mpm_taichi",
        description="Material Point Method simulator",
        epilog="`python -m mpm_taichi SCENE` is short for `python -m mpm_taichi run SCENE`.",
        allow_abbrev=False,
    )
    top.add_argument("--version", action="version", version=f"mpm_taichi {__version__}")
    commands = top.add_subparsers(dest="command", required=True, metavar="COMMAND")
    for name, text in COMMANDS.items():
        command = commands.add_parser(name, help=text, description=text, allow_abbrev=False)
        if name == "schema":
            continue
        if name == "materials":
            command.add_argument("name", nargs="?", metavar="NAME", help="tell of one in full")
            continue
        if name == "curve":
            _add_curve(command)
            continue
        command.add_argument("scene", type=Path, help="scene file (YAML)")
        command.add_argument(
            "--set", action="append", default=[], metavar="KEY=VALUE",
            help="change a value of the scene: --set bodies[0].velocity=[0,1]",
        )  # fmt: skip
        if name == "advise":
            _add_aim(command)
            continue
        command.add_argument("--device", choices=("cpu", "cuda", "vulkan", "metal"), default="cpu")
        command.add_argument(
            "--precision", choices=("f32", "f64"),
            help="default: the scene's, else f64 on cpu and cuda, f32 on vulkan and metal",
        )  # fmt: skip
        command.add_argument(
            "--threads", type=_positive, help="default: what the size of the scene is worth"
        )
        if name == "converge":
            command.add_argument(
                "--levels", type=_levels, metavar="N", default=4,
                help="resolutions, each with cells of half the size; default: 4",
            )  # fmt: skip
        else:
            command.add_argument(
                "--frames", type=_positive, metavar="N", help="number of outputs after the start"
            )
        if name != "check":
            _add_output(command, "converge-" * (name == "converge"))
        if name == "run":
            command.add_argument("--json", action="store_true", help="print run.json to stdout")
    return top


def _add_output(command: argparse.ArgumentParser, kind: str) -> None:
    command.add_argument(
        "-o", "--output", type=Path, metavar="DIR",
        help=f"folder of the results; default: the next of runs/<scene>-{kind}001, -{kind}002, ...",
    )  # fmt: skip
    command.add_argument(
        "--overwrite", action="store_true", help="replace the results that are in -o DIR"
    )
    command.add_argument("-q", "--quiet", action="store_true", help="no progress")


def _add_aim(command: argparse.ArgumentParser) -> None:
    command.add_argument(
        "--error", type=_part, metavar="E", default=0.01,
        help="as 1%% or 0.01, of the largest exact field; default: 1%%",
    )  # fmt: skip
    command.add_argument(
        "--quantity", choices=("displacement", "velocity", "stress", "energy"),
        default="displacement", help="of which; default: displacement",
    )  # fmt: skip


def _add_curve(command: argparse.ArgumentParser) -> None:
    command.add_argument("what", metavar="WHAT", help="law, preset, or SCENE.yaml:MATERIAL")
    command.add_argument(
        "--set", action="append", default=[], metavar="KEY=VALUE",
        help="change a value of the material: --set youngs_modulus=1e5",
    )  # fmt: skip
    command.add_argument(
        "--path", choices=("uniaxial", "biaxial", "shear", "volumetric"), help="default: all four"
    )
    command.add_argument(
        "--strain", type=_strain, metavar="S",
        help="largest, of both signs, this one first; default: four times the shear at which the "
        "material begins to flow, at most 0.3",
    )  # fmt: skip
    command.add_argument(
        "--compression", type=_compression, default=0.0, metavar="C",
        help="J goes from 1 to 1 - C first, so that sand can bear shear; default: 0",
    )  # fmt: skip
    command.add_argument("--rate", type=_rate, default=1.0, help="of strain [1/s]; default: 1")
    command.add_argument("--dim", type=int, choices=(2, 3), default=3, help="2 is plane strain")
    command.add_argument(
        "-o", "--output", type=Path, metavar="FILE.png",
        help="picture, with a .csv beside it; default: the next of runs/curve-WHAT-001.png, ...",
    )  # fmt: skip
    command.add_argument("--overwrite", action="store_true", help="replace the files of -o")


def _strain(text: str) -> float:
    value = _number(text)
    if not 0 < abs(value) < 1:
        raise argparse.ArgumentTypeError(f"must be between 0 and 1, or -1 and 0 (got {text!r})")
    return value


def _compression(text: str) -> float:
    value = _number(text)
    if not 0 <= value < 1:
        raise argparse.ArgumentTypeError(f"must be at least 0 and less than 1 (got {text!r})")
    return value


def _rate(text: str) -> float:
    value = _number(text)
    if not 0 < value < inf:
        raise argparse.ArgumentTypeError(f"must be a number above 0 (got {text!r})")
    return value


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        return nan


def _part(text: str) -> float:
    number = text.strip().removesuffix("%")
    value = _number(number) / (100 if text.strip().endswith("%") else 1)
    if not 0 < value <= 1:
        raise argparse.ArgumentTypeError(
            f"must be a part such as 1% or 0.01, above 0 and at most 100% (got {text!r})"
        )
    return value


def _positive(text: str) -> int:
    if not text.isdecimal() or not 1 <= int(text) <= 2**31 - 1:
        raise argparse.ArgumentTypeError(f"must be a whole number from 1 on (got {text!r})")
    return int(text)


def _levels(text: str) -> int:
    if text not in map(str, range(2, 9)):
        raise argparse.ArgumentTypeError(f"must be a whole number from 2 to 8 (got {text!r})")
    return int(text)


def _with_command(words: list[str]) -> list[str]:
    """`SCENE ...` and `--options SCENE` become `run ...`."""
    first = _first_plain_word(words)
    if first is None:
        return words
    word = words[first]
    if word in COMMANDS:
        return [word, *words[:first], *words[first + 1 :]]
    if word.endswith((".yaml", ".yml")):
        return ["run", *words]
    close = difflib.get_close_matches(word, COMMANDS, 1)
    hint = f"; did you mean {close[0]!r}?" if close else f" ({', '.join(COMMANDS)})"
    raise InputError(f"{word!r} is neither a command nor a .yaml file{hint}")


def _first_plain_word(words: list[str]) -> int | None:
    takes_value = {
        "-o", "--output", "--set", "--device", "--precision", "--threads", "--frames", "--levels",
        "--error", "--quantity", "--path", "--strain", "--compression", "--rate", "--dim",
    }  # fmt: skip
    skip = False
    for number, word in enumerate(words):
        if skip:
            skip = False
        elif word.startswith("-") and len(word) > 1:
            skip = word in takes_value
        else:
            return number
    return None


def _dispatch(options) -> int:
    from .scene import load_scene, scene_schema

    if options.command == "schema":
        print(json.dumps(scene_schema(), indent=2))
        return 0
    if options.command == "materials":
        from .catalogue import catalogue, entry

        print(catalogue() if options.name is None else entry(options.name))
        return 0
    if options.command == "curve":
        from .curve import curve

        return curve(options)
    changes = list(options.set)
    scene = load_scene(options.scene, changes)
    if getattr(options, "frames", None) is not None:
        changes.append(f"output.every={scene.time.end / options.frames!r}")
        scene = load_scene(options.scene, changes)

    if options.command == "advise":
        from .advise import advise, shipped

        print(advise(scene, options.quantity, options.error, shipped()))
        return 0
    from rich.console import Console

    console = Console(
        stderr=True, quiet=getattr(options, "quiet", False), markup=False, highlight=False
    )
    if options.command == "converge":
        from .converge import converge

        return converge(scene, options.scene.stem, options, console)
    from . import run

    if options.command == "check":
        return run.check(scene, options, console)
    return run.run(scene, options.scene.stem, options, console)


def _missing_library(error: ImportError) -> int:
    if "cannot open shared object file" not in str(error):
        raise error
    library = str(error).split(":")[0]
    print(
        f"Taichi needs the system library {library}, which is not installed.\n"
        "On Debian or Ubuntu:  sudo apt-get install libx11-6",
        file=sys.stderr,
    )
    return 2
