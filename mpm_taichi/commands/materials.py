"""List the laws with their parameters, and the presets with their sources."""


def add(parser) -> None:
    parser.add_argument("name", nargs="?", metavar="NAME", help="tell of one in full")


def execute(options) -> int:
    from ..catalogue import catalogue, entry

    print(catalogue() if options.name is None else entry(options.name))
    return 0
