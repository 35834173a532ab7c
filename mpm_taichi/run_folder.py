"""The folder of a run: it describes itself, and no run overwrites another unasked."""

import contextlib
import json
from itertools import count
from pathlib import Path
from typing import NamedTuple

from .errors import InputError


class Contents(NamedTuple):
    """What a command writes, and all that `overwrite` removes.  A folder without the `mark` is not
    its own."""

    noun: str
    mark: str
    others: tuple[str, ...]


RUN = Contents(
    "run",
    "run.json",
    (
        "scene.yaml", "history.csv", "errors.csv", "frames/frame_*.png",
        "snapshots/snapshot_*.npz", "snapshots/particles.npz", "snapshots/*.npz.part",
        "stages/stage_*.npz", "stages/*.npz.part",
        "paraview/particles_*.vtp", "paraview/grid_*.vti", "paraview/particles.pvd",
        "paraview/grid.pvd", "paraview/*.part", "video.mp4", "video.gif", "video.webp",
        "plot.png", "plot-ledger.png", "player.html", "checkpoints/step_*.npz*", "trouble/*",
    ),
)  # fmt: skip
STUDY = Contents(
    "convergence study", "converge.json", ("scene.yaml", "converge.csv", "converge.png")
)


def refuse(wanted: Path | None, overwrite: bool, contents: Contents = RUN) -> None:
    """InputError where `create` would have to touch what is not a run, or was not asked to."""
    if wanted is None:
        if overwrite:
            raise InputError(
                f"--overwrite: is for -o DIR; without it a {contents.noun} gets a new folder"
            )
        return
    try:
        if not wanted.exists():
            return
    except OSError as error:  # a name that is too long
        raise InputError(f"-o: {error.strerror}: {wanted}") from None
    if not wanted.is_dir():
        raise InputError(f"-o {wanted}: this is a file; name a folder for the {contents.noun}")
    if not any(wanted.iterdir()):
        return
    if not overwrite:
        raise InputError(
            f"-o {wanted}: the folder is not empty; name another one, or add --overwrite to "
            f"replace the {contents.noun} in it"
        )
    if not (wanted / contents.mark).is_file():
        raise InputError(
            f"-o {wanted} --overwrite: the folder holds no {contents.noun} (no {contents.mark}), "
            "so nothing in it is replaced; name another one"
        )


def create(scene_name: str, wanted: Path | None, overwrite: bool, contents: Contents = RUN) -> Path:
    """A folder without a run: `wanted`, or the first free one of runs/<scene>-001, -002, ..."""
    refuse(wanted, overwrite, contents)
    try:
        if wanted is None:
            return _first_free(Path("runs"), scene_name)
        for pattern in (contents.mark, *contents.others):
            for path in wanted.glob(pattern):
                path.unlink()
        for inner in {Path(pattern).parent for pattern in contents.others} - {Path()}:
            with contextlib.suppress(OSError):  # not there, or with a file of the user's
                (wanted / inner).rmdir()
        wanted.mkdir(parents=True, exist_ok=True)
        return wanted
    except OSError as error:
        raise InputError(f"the run folder cannot be made: {error}") from None


def _first_free(parent: Path, name: str) -> Path:
    parent.mkdir(exist_ok=True)
    for number in count(1):
        folder = parent / f"{name}-{number:03d}"
        try:
            folder.mkdir()
            return folder
        except FileExistsError:
            continue
    raise AssertionError  # count() does not end


def read_report(folder: Path) -> dict:
    """run.json.  InputError where the folder holds no run."""
    path = folder / RUN.mark
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
    except (FileNotFoundError, NotADirectoryError):
        what = "has no run.json, so it is no run" if folder.is_dir() else "is no folder of a run"
        raise InputError(
            f"{folder}: {what}; name the folder of one, such as runs/two_disks-001"
        ) from None
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: cannot be read: {error}") from None
    if not isinstance(content, dict):
        raise InputError(f"{path}: is no report of a run")
    return content
