"""The recorded particles of a run as one HTML file that plays them."""

from math import ceil
from pathlib import Path

from ..errors import InputError
from ..player import player
from ..recording import Recording

MAIL = 25
"""MB: more than this few mailboxes take."""


def export_player(run: Path, file: Path, every: int, overwrite: bool) -> None:
    """Write every `every`-th frame of a run into `file`, which appears whole, or not at all."""
    if file.exists() and not overwrite:
        raise InputError(f"{file}: is there already; name another file, or add --overwrite")
    film = player(Recording(run), every)
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        film.write(file)
    except OSError as error:
        raise InputError(f"{file}: cannot be written: {error}") from None
    size = file.stat().st_size / 1e6
    print(f"{file}: {film.frames} frames of {film.particles} particles, {size:.3g} MB")
    if size > MAIL and film.frames > 1:
        fewer = ceil(size / MAIL)
        print(
            f"that is more than the {MAIL} MB that mail takes; with --every {fewer * every} it "
            f"would be about {size / fewer:.2g} MB"
        )
