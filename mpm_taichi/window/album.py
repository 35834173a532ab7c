"""Pictures that the user asks for."""

from itertools import count
from pathlib import Path

import numpy as np

from ..renderers.png import write_png


class Album:
    """NAME-view-001.png, -002, ... in a folder; none that is there is touched."""

    def __init__(self, folder: Path, name: str):
        self.folder, self.name = folder.absolute(), name

    def save(self, picture: np.ndarray) -> str:
        """Words on how it went."""
        names = (f"{self.name}-view-{number:03d}.png" for number in count(1))
        path = next(self.folder / name for name in names if not (self.folder / name).exists())
        try:
            write_png(path, picture)
        except OSError as error:
            return f"not saved: {error}"
        return f"saved {path.name} in {path.parent}"
