"""Files that are whole or not there: written beside, then renamed."""

import contextlib
import json
import os
from collections.abc import Iterator
from pathlib import Path


@contextlib.contextmanager
def beside(path: Path) -> Iterator[Path]:
    """Where to write what takes the place of `path` when the block ends, or goes if it fails."""
    part = path.with_name(path.name + ".part")
    try:
        yield part
        part.replace(path)
    except BaseException:
        with contextlib.suppress(OSError):
            part.unlink()
        raise


@contextlib.contextmanager
def on_the_disk(path: Path):
    """An open file that takes the place of `path` when it is on the disk, as far as a system can
    say so: a loss of power leaves the old one or the new one."""
    with beside(path) as part, part.open("wb") as file:
        yield file
        file.flush()
        os.fsync(file.fileno())
    with contextlib.suppress(OSError, AttributeError):
        handle = os.open(path.parent, os.O_RDONLY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)


def write_text(path: Path, text: str) -> None:
    with beside(path) as part:
        part.write_text(text, encoding="utf-8")


def write_json(path: Path, content: dict) -> None:
    write_text(path, json.dumps(content, indent=2) + "\n")
