"""Write a scene to begin with, every section explained."""

from pathlib import Path

from ..errors import InputError


def add(parser) -> None:
    parser.add_argument("file", type=Path, metavar="NAME.yaml", help="the new file")
    parser.add_argument("--dim", type=int, choices=(2, 3), help="dimensions; default: 2")
    parser.add_argument(
        "--like", metavar="SCENE", help="a copy of a scene of the gallery (see `list`) or of a file"
    )


def execute(options) -> int:
    if options.like is not None and options.dim is not None:
        raise InputError("--dim: is that of --like SCENE; give one of them")
    from ..starter import write_new

    write_new(options.file, options.dim or 2, options.like)
    print(
        f"{options.file}: written. What comes next:\n"
        f"  python -m mpm_taichi check {options.file}    the plan: particles, memory, time\n"
        f"  python -m mpm_taichi {options.file}          run it"
    )
    return 0
