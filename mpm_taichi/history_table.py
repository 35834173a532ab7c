"""Reads history.csv: the table of a run, which may be still going on."""

import csv
from pathlib import Path

import numpy as np

from .errors import InputError


def read_history(path: Path) -> dict[str, np.ndarray]:
    """The columns by name: numbers, or texts where a word of it is no number; nothing where the run
    has not written the names yet.  A last line that is not whole is left out."""
    try:
        text = path.read_text(encoding="utf-8")
    except FileNotFoundError:
        raise InputError(f"{path}: is missing, so the folder holds no whole run") from None
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"{path}: cannot be read: {error}") from None
    names, *rows = list(csv.reader(text[: text.rfind("\n") + 1].splitlines())) or [[]]
    for line, row in enumerate(rows, 2):
        if len(row) != len(names):
            raise InputError(
                f"{path}:{line}: has {len(row)} values for {len(names)} columns: it is damaged"
            )
    columns = list(zip(*rows, strict=True)) or [()] * len(names)
    return {name: _values(words) for name, words in zip(names, columns, strict=True)}


def _values(words) -> np.ndarray:
    try:
        return np.array(words, float)
    except ValueError:
        return np.array(words)
