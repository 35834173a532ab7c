"""In a notebook: a simulation shows the picture of its moment, a recording plays."""

import html
from pathlib import Path
from tempfile import TemporaryDirectory

from .scene import Images

MOST_POINTS = 4_000_000
"""Particles times frames of a page in a notebook, which keeps it: some 10 MB."""

FRAME = '<iframe sandbox="allow-scripts" style="width:100%;height:640px;border:0" srcdoc="{}">'
"""No page of the notebook is open to the script in it."""


def picture(simulation) -> bytes | None:
    """PNG as a run would write it at this moment, in the style of the scene; None without Pillow,
    which writes its texts."""
    try:
        import PIL  # noqa: F401
    except ImportError:
        return None
    from . import recorders

    style = simulation.scene.output.images
    with TemporaryDirectory() as folder:
        images = recorders.Images(Path(folder), simulation, Images() if style == "none" else style)
        images.record(simulation, is_output=True)
        return next(Path(folder).glob("*.png")).read_bytes()


def inline_player(recording) -> str:
    """HTML with the player of a recording; of a long one every few frames, and of one whose single
    frames are too large only the words that say how to see it."""
    from .player import player

    particles, frames = len(recording.body), len(recording)
    every = -(-particles * frames // MOST_POINTS)
    whole = f"python -m mpm_taichi export {recording.folder} --html"
    if particles > MOST_POINTS:
        return _words(f"{particles} particles are too many for a notebook; to see them: {whole}")
    page = FRAME.format(html.escape(player(recording, every).html)) + "</iframe>"
    if every == 1:
        return page
    return page + _words(f"1 of {every} frames is shown, of {frames} in all; the others: {whole}")


def _words(text: str) -> str:
    return f"<p>{html.escape(text)}</p>"
