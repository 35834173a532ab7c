"""A simulation in a notebook: the picture of its moment."""

from pathlib import Path
from tempfile import TemporaryDirectory

from .scene import Images


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
