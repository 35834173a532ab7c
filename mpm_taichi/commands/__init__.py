"""What `python -m mpm_taichi` can do, in the order of its help.  A command is a module of its name:

- the first paragraph of its docstring    the help
- `add(parser)`                           its arguments
- `execute(options) -> int`               does it; returns the exit code

Modules import at their top only what takes no time."""

from . import (
    advise,
    check,
    compare,
    converge,
    curve,
    doctor,
    export,
    list,
    materials,
    new,
    plot,
    replay,
    run,
    schema,
    view,
)

COMMANDS = {
    module.__name__.rpartition(".")[2]: module
    for module in (
        run, view, new, list, check, replay, export, plot, compare, converge, advise, materials,
        curve, schema, doctor,
    )
}  # fmt: skip
