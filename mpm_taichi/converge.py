"""The command `converge`: a scene at successive resolutions, into a folder."""

import platform
import sys
import time
from importlib.util import find_spec
from pathlib import Path

from rich.console import Console

from . import run_folder, stages
from .errors import InputError, RunError
from .grid_convergence import ROUNDING
from .interruption import Interrupted, Interruption
from .progress import Progressing
from .refinement import refined, refuse
from .report import versions
from .scene import Scene, dump_scene
from .simulation import Simulation
from .study import Level, Study
from .whole_files import write_json, write_text
from .yardsticks import ErrorsToExact, ResultsAtEnd


def converge(scene: Scene, name: str, options, console: Console) -> int:
    """Run a scene with cells of 1, 1/2, 1/4 ... the size; `name` is that of its file.  Returns the
    exit code: 0 also where results do not converge, 1 where every level failed."""
    if find_spec("matplotlib") is None:
        raise InputError('converge draws with matplotlib: pip install "matplotlib>=3.8"')
    yardstick = ResultsAtEnd if scene.exact is None else ErrorsToExact
    if options.levels < yardstick.least_levels:
        raise InputError(
            f"--levels {options.levels}: without the section exact of a scene, orders come from "
            f"{yardstick.least_levels} successive grids"
        )
    run_folder.refuse(options.output, options.overwrite, run_folder.STUDY)
    refuse(scene)
    scenes = [refined(scene, number) for number in range(options.levels)]
    simulation = _start(scenes[0], options)  # what is wrong with the scene itself, it tells
    study = Study(yardstick, ROUNDING[simulation.precision])
    folder = run_folder.create(
        f"{name}-converge", options.output, options.overwrite, run_folder.STUDY
    )
    console.print(f"{len(scenes)} levels, results go to {folder}", soft_wrap=True)
    if getattr(scene.method.transfer, "ratio", None) is not None:
        console.print(
            "note: ratio is the FLIP part of each step, so finer levels, with more steps, have "
            "more PIC; with relaxation_time they have the same",
            soft_wrap=True,
        )
    try:
        write_text(folder / "scene.yaml", dump_scene(scene))
        status, code = _run_levels(scenes, simulation, study, folder, options, console)
        _write(folder, study, status, simulation)
        _draw(folder, study, scene.title or name)
    except OSError as failure:
        raise RunError(f"writing to {folder} failed: {failure}") from None
    print(study.table())
    console.print(f"{status}: results in {folder}", soft_wrap=True)
    return code


def _run_levels(scenes, simulation, study, folder, options, console) -> tuple[str, int]:
    """One after another, whatever becomes of each; `simulation` is the first, ready to run.
    Returns how it went, and the exit code."""
    for number, scene in enumerate(scenes):
        level = Level(number, scene.domain.cells, scene.cell_size)
        study.levels.append(level)
        _write(folder, study, "running", simulation)
        try:
            simulation = _start(scene, options) if number else simulation
            _measure(simulation, level, study.yardstick, console)
        except (RunError, InputError) as failure:
            level.failure = str(failure).splitlines()[0].split(". ")[0]
        except Interrupted as wish:
            level.failure = f"interrupted by {wish}"
            return "interrupted", wish.exit_code
        console.print(f"level {number}: {level.outcome()}", soft_wrap=True)
    return ("failed", 1) if all(level.failure for level in study.levels) else ("done", 0)


def _start(scene, options) -> Simulation:
    return Simulation(scene, options.device or "cpu", options.precision, options.threads)


def _measure(simulation, level, yardstick, console) -> None:
    """Run a level to its end."""
    began = time.perf_counter()
    level.particles = int(simulation.ranges[-1])
    console.print(
        f"level {level.number}: {level.size()} cells of {level.dx:g} m, {level.particles} "
        f"particles, about {simulation.end / simulation.dt:.0f} steps",
        soft_wrap=True,
    )
    measured = yardstick(simulation, level.number)
    try:
        with Interruption() as interruption, Progressing(console, began) as progress:
            simulation.run([*measured.recorders, interruption, progress])
        level.values = measured.measure()
    finally:
        level.steps = simulation.step_count
        level.seconds = sum(stages.seconds.values())
        level.wall_seconds = time.perf_counter() - began
        level.warnings = simulation.warnings()
    for warning, count in level.warnings.items():
        console.print(f"warning: {warning}: {count}", soft_wrap=True)


def _write(folder: Path, study: Study, status: str, simulation: Simulation) -> None:
    content = {
        "status": status,
        "command": sys.argv[1:],
        "versions": versions(),
        "machine": platform.platform(),
        "device": simulation.device,
        "precision": simulation.precision,
    }
    write_json(folder / "converge.json", content | study.content())
    write_text(folder / "converge.csv", study.csv())


def _draw(folder: Path, study: Study, title: str) -> None:
    from .renderers.convergence import draw_convergence  # with Pillow, after the runs

    if any(errors for _, errors in study.curves().values()):
        draw_convergence(folder / "converge.png", title, study.yardstick.axis, study.curves())
