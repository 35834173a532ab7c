"""A CSV file that grows with a run and can be cut back to where it was."""

import csv
import os
from pathlib import Path
from typing import Any

from ..errors import InputError


class Table:
    """Rows of the columns that the first one has.  `size`: go on with the file as it was when
    `kept_size` said so; what came after is cut off."""

    def __init__(self, path: Path, size: int | None = None):
        self.is_new = size is None
        self._file = path.open("w" if size is None else "r+", newline="", encoding="utf-8")
        if size is not None:
            if path.stat().st_size < size:
                self._file.close()
                raise InputError(f"{path}: has lost rows since the checkpoint was written")
            self._file.truncate(size)
            self._file.seek(size)
        self._writer: Any = csv.writer(self._file, lineterminator="\n")

    def write(self, row: dict[str, Any]) -> None:
        if self.is_new:
            self._writer.writerow(row)
            self.is_new = False
        self._writer.writerow(row.values())

    def flush(self) -> None:
        self._file.flush()

    def kept_size(self) -> int:
        """Bytes so far, which are on the disk when this returns."""
        self._file.flush()
        os.fsync(self._file.fileno())
        return os.fstat(self._file.fileno()).st_size

    def close(self) -> None:
        self._file.close()
