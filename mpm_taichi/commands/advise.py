"""Which schemes were shown to reach an error, and how far the scene is from where."""

import argparse

from .arguments import add_scene, number, scene_of


def add(parser) -> None:
    add_scene(parser)
    parser.add_argument(
        "--error", type=_part, metavar="E", default=0.01,
        help="as 1%% or 0.01, of the largest exact field; default: 1%%",
    )  # fmt: skip
    parser.add_argument(
        "--quantity", choices=("displacement", "velocity", "stress", "energy"),
        default="displacement", help="of which; default: displacement",
    )  # fmt: skip


def execute(options) -> int:
    scene = scene_of(options)
    from ..advise import advise, shipped

    print(advise(scene, options.quantity, options.error, shipped()))
    return 0


def _part(text: str) -> float:
    word = text.strip()
    value = number(word.removesuffix("%")) / (100 if word.endswith("%") else 1)
    if not 0 < value <= 1:
        raise argparse.ArgumentTypeError(
            f"must be a part such as 1% or 0.01, above 0 and at most 100% (got {text!r})"
        )
    return value
