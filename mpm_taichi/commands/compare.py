"""Draw the histories of two runs or more over each other."""

from pathlib import Path

from .arguments import add_picture


def add(parser) -> None:
    parser.add_argument("folders", type=Path, nargs="+", metavar="RUN", help="folders of runs")
    add_picture(parser, "the next of runs/compare-001.png, -002, ...")


def execute(options) -> int:
    from ..plot import compare

    return compare(options.folders, options.output, options.overwrite)
