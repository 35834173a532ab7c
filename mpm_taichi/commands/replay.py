"""See once more how a run failed: its last attempt, with a look at all particles each step."""

from pathlib import Path

from .arguments import progress_console


def add(parser) -> None:
    parser.add_argument("run", type=Path, metavar="RUN", help="folder of the run")


def execute(options) -> int:
    from ..replay import replay

    return replay(options.run, progress_console(options))
