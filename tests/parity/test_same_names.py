"""The twin mirrors the fast form: same files, same names, same parameters."""

import inspect
from importlib import import_module
from pathlib import Path

import pytest

import mpm_taichi

PACKAGE = Path(mpm_taichi.__file__).parent
MEMORY_AND_THREADS = {
    f"kernels/{name}.py"
    for name in (
        "blocks",
        "clock",
        "fill",
        "guard",
        "outside",
        "rows",
        "sort",
        "tiles",
        "time_step",
        "whole_step",
        "whole_steps",
    )
}
"""Modules about memory, threads and launches, and what is done about faults: the twin has none."""

STATED_IN_SCENES = {"materials/elastic.py", "materials/presets.py"}
"""Parameters that scenes give: the twin takes them from the scene's models."""

MODULES = [
    str(path.relative_to(PACKAGE).as_posix())
    for folder in ("kernels", "bases", "transfers", "materials", "boundaries")
    for path in sorted((PACKAGE / folder).glob("*.py"))
    if str(path.relative_to(PACKAGE).as_posix()) not in MEMORY_AND_THREADS | STATED_IN_SCENES
] + ["solver.py", "grid.py", "particles.py"]


def modules(path):
    name = path.removesuffix(".py").replace("/", ".").removesuffix(".__init__")
    return import_module(f"mpm_taichi.{name}"), import_module(f"mpm_taichi.reference.{name}")


def stages(module):
    """Public Python functions that the module itself defines; kernels and ti.funcs are below."""
    return {
        name: member
        for name, member in inspect.getmembers(module, inspect.isfunction)
        if member.__module__ == module.__name__
        and not name.startswith("_")
        and not hasattr(member, "_is_taichi_function")
        and not hasattr(member, "_is_wrapped_kernel")
    }


def choices(module):
    return {
        name: member
        for name, member in inspect.getmembers(module, inspect.isclass)
        if member.__module__ == module.__name__
    }


def parameters(function):
    return list(inspect.signature(function).parameters)


@pytest.mark.parametrize("path", MODULES)
def test_module_has_a_twin(path):
    assert (PACKAGE / "reference" / path).is_file()


def test_twin_has_nothing_else():
    ours = {str(p.relative_to(PACKAGE).as_posix()) for p in PACKAGE.rglob("*.py")}
    twins = {str(p.relative_to(PACKAGE / "reference").as_posix())
             for p in (PACKAGE / "reference").rglob("*.py")}  # fmt: skip
    assert twins <= ours


@pytest.mark.parametrize("path", [path for path in MODULES if path.startswith("kernels/")])
def test_stages_have_the_same_parameters(path):
    ours, theirs = modules(path)
    for name, stage in stages(ours).items():
        assert parameters(getattr(theirs, name)) == parameters(stage), name


@pytest.mark.parametrize("path", [p for p in MODULES if p.startswith(("bases/", "transfers/",
                                                                      "boundaries/"))])  # fmt: skip
def test_choices_have_the_same_members(path):
    """Same class, same constants, same functions with the same parameters."""
    ours, theirs = modules(path)
    twins = choices(theirs)
    for name, choice in choices(ours).items():
        if name not in twins:
            assert path.endswith("__init__.py"), f"{name} has no twin"
            continue
        members = {m for m in vars(choice) if not m.startswith("_")}
        assert members == {m for m in vars(twins[name]) if not m.startswith("_")}
        for member in members:
            value, twin = getattr(choice, member), getattr(twins[name], member)
            if callable(value):
                assert parameters(value) == parameters(twin), member
            else:
                assert value == twin, member


@pytest.mark.parametrize("path", [path for path in MODULES if path.startswith("materials/")])
def test_laws_have_the_same_functions(path):
    ours, theirs = modules(path)
    twins = choices(theirs)
    for name, law in choices(ours).items():
        functions = {m for m, f in vars(law).items() if isinstance(f, staticmethod)}
        assert functions == {m for m, f in vars(twins[name]).items() if isinstance(f, staticmethod)}
        for member in functions:
            assert parameters(getattr(law, member)) == parameters(getattr(twins[name], member))


def test_the_step_has_the_same_parameters():
    ours, theirs = modules("solver.py")
    memory_and_threads = {"whole", "threads", "atomic"}
    kept = [p for p in parameters(ours.Solver) if p not in memory_and_threads]
    assert kept == parameters(theirs.Solver)
    for name in ("start", "step"):
        assert parameters(getattr(ours.Solver, name)) == parameters(getattr(theirs.Solver, name))


def test_the_twin_does_not_import_taichi():
    """In a process of its own, the twin loads without Taichi or any other part of the package."""
    import subprocess
    import sys

    check = (
        "import sys, mpm_taichi.reference.solver\n"
        "import mpm_taichi.reference.kernels.evaluate, mpm_taichi.reference.kernels.sums\n"
        "loaded = [m for m in sys.modules if m.startswith('mpm_taichi.')]\n"
        "assert 'taichi' not in sys.modules\n"
        "assert all(m.startswith('mpm_taichi.reference') for m in loaded), loaded"
    )
    subprocess.run([sys.executable, "-c", check], check=True)
