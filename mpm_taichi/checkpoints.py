"""Checkpoints: a run on disk, from which a later process goes on.

    RUN/checkpoints/step_000001200.npz          fields as they lie, and `meta`, a JSON text
    RUN/checkpoints/step_000001200.npz.sha256   written last; `sha256sum -c` reads it too

Each file is whole or not there: written beside, flushed to the disk, then renamed.  A checkpoint
counts if its checksum says so; the last two are kept.  No pickles."""

import hashlib
import json
import zipfile
from collections.abc import Iterable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from .errors import InputError
from .whole_files import on_the_disk

FORMAT = 1
KEPT = 2


class Checkpoint(NamedTuple):
    """`meta`: numbers and words; `arrays`: fields by name."""

    path: Path
    meta: dict[str, Any]
    arrays: dict[str, np.ndarray]


def save(folder: Path, step: int, meta: dict[str, Any], fields: dict[str, Any]) -> Path:
    """Write the checkpoint of a step; fields are copied from the device one after the other.  What
    is older than the last two goes when the new one is safe."""
    folder.mkdir(exist_ok=True)
    path = folder / f"step_{step:09d}.npz"
    with on_the_disk(path) as file, zipfile.ZipFile(file, "w", zipfile.ZIP_STORED) as archive:
        text = json.dumps(meta | {"format": FORMAT}).encode()
        _add(archive, "meta", np.frombuffer(text, np.uint8))
        for name, field in fields.items():
            _add(archive, name, field.to_numpy())
    with on_the_disk(_checksum(path)) as file:
        file.write(f"{_digest(path)}  {path.name}\n".encode())
    for old in newest_first(folder)[KEPT:]:
        _checksum(old).unlink(missing_ok=True)
        old.unlink(missing_ok=True)
    return path


def newest_first(folder: Path) -> list[Path]:
    """The checkpoints of a folder, whole or not."""
    return sorted(folder.glob("step_*.npz"), key=lambda path: (len(path.name), path.name))[::-1]


def load(path: Path) -> Checkpoint:
    """InputError where it is damaged: nothing is read that its checksum does not cover."""
    try:
        told = _checksum(path).read_text(encoding="ascii").split()
        if told[:1] != [_digest(path)]:
            raise InputError(f"{path}: the checkpoint is damaged: its checksum is another")
        with np.load(path, allow_pickle=False) as archive:
            arrays = {name: archive[name] for name in archive.files}
        meta = json.loads(arrays.pop("meta").tobytes())
        form = meta["format"]
    except OSError as error:
        raise InputError(f"{path}: the checkpoint cannot be read: {error}") from None
    except (ValueError, KeyError, TypeError, zipfile.BadZipFile):
        raise InputError(f"{path}: this is no checkpoint of ours") from None
    if form != FORMAT:
        raise InputError(f"{path}: has format {form}, and this version reads format {FORMAT}")
    return Checkpoint(path, meta, arrays)


def newest(folder: Path, warn=lambda text: None) -> Checkpoint | None:
    """The newest that is whole; `warn` is told of each that is not.  InputError where none is, None
    where there is none at all."""
    paths = newest_first(folder)
    for path in paths:
        try:
            return load(path)
        except InputError as error:
            warn(str(error))
    if paths:
        raise InputError(f"{folder}: none of {len(paths)} checkpoints can be read")
    return None


def _add(archive: zipfile.ZipFile, name: str, array: np.ndarray) -> None:
    with archive.open(f"{name}.npy", "w", force_zip64=True) as member:
        np.lib.format.write_array(member, array, allow_pickle=False)


def _checksum(path: Path) -> Path:
    return path.with_name(path.name + ".sha256")


def _digest(path: Path) -> str:
    digest = hashlib.sha256()
    with path.open("rb") as file:
        for part in _parts(file):
            digest.update(part)
    return digest.hexdigest()


def _parts(file) -> Iterable[bytes]:
    return iter(lambda: file.read(2**20), b"")
