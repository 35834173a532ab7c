"""Draw energies, momentum and time step of a run."""

from pathlib import Path

from .arguments import add_picture


def add(parser) -> None:
    parser.add_argument("folder", type=Path, metavar="RUN", help="folder of a run")
    add_picture(parser, "RUN/plot.png")


def execute(options) -> int:
    from ..plot import plot

    return plot(options.folder, options.output, options.overwrite)
