"""Draw stress against strain of a material."""

import argparse
from math import inf
from pathlib import Path

from .arguments import number


def add(parser) -> None:
    parser.add_argument("what", metavar="WHAT", help="law, preset, or SCENE.yaml:MATERIAL")
    parser.add_argument(
        "--set", action="append", default=[], metavar="KEY=VALUE",
        help="change a value of the material: --set youngs_modulus=1e5",
    )  # fmt: skip
    parser.add_argument(
        "--path", choices=("uniaxial", "biaxial", "shear", "volumetric"), help="default: all four"
    )
    parser.add_argument(
        "--strain", type=_strain, metavar="S",
        help="largest, of both signs, this one first; default: four times the shear at which the "
        "material begins to flow, at most 0.3",
    )  # fmt: skip
    parser.add_argument(
        "--compression", type=_compression, default=0.0, metavar="C",
        help="J goes from 1 to 1 - C first, so that sand can bear shear; default: 0",
    )  # fmt: skip
    parser.add_argument("--rate", type=_rate, default=1.0, help="of strain [1/s]; default: 1")
    parser.add_argument("--dim", type=int, choices=(2, 3), default=3, help="2 is plane strain")
    parser.add_argument(
        "-o", "--output", type=Path, metavar="FILE.png",
        help="picture, with a .csv beside it; default: the next of runs/curve-WHAT-001.png, ...",
    )  # fmt: skip
    parser.add_argument("--overwrite", action="store_true", help="replace the files of -o")


def execute(options) -> int:
    from ..curve import curve

    return curve(options)


def _strain(text: str) -> float:
    value = number(text)
    if not 0 < abs(value) < 1:
        raise argparse.ArgumentTypeError(f"must be between 0 and 1, or -1 and 0 (got {text!r})")
    return value


def _compression(text: str) -> float:
    value = number(text)
    if not 0 <= value < 1:
        raise argparse.ArgumentTypeError(f"must be at least 0 and less than 1 (got {text!r})")
    return value


def _rate(text: str) -> float:
    value = number(text)
    if not 0 < value < inf:
        raise argparse.ArgumentTypeError(f"must be a number above 0 (got {text!r})")
    return value
