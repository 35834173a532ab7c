"""frames/frame_0000.png, ...: a picture at each output."""

from pathlib import Path
from typing import Any


class Images:
    """Pictures by the offscreen renderer.  Where the scene gives no range, the color scale is the
    widest that the run has shown so far, with 0 but for density."""

    every_steps = None

    def __init__(self, folder: Path, simulation, style, state=None):
        from ..renderers import moment  # Pillow, which a run without pictures spares

        folder.mkdir(exist_ok=True)
        self.folder, self.style = folder, style
        low, high = moment.narrowest(style.color_by) if style.range is None else style.range
        before = state or {"count": 0, "low": low, "high": high}
        self.count, self.low, self.high = before["count"], before["low"], before["high"]
        for path in folder.glob("frame_*.png"):
            number = path.stem.removeprefix("frame_")
            if number.isdecimal() and int(number) >= self.count:
                path.unlink()  # of an attempt that has failed, or drawn again by this one

    def record(self, simulation, is_output):
        if not is_output:
            return
        from ..renderers.moment import frame_of, value_of
        from ..renderers.picture import draw
        from ..renderers.png import write_png

        scene, snapshot, quantity = simulation.scene, simulation.snapshot, self.style.color_by
        value = value_of(snapshot, quantity)
        if value is not None and self.style.range is None:
            self.low, self.high = min(self.low, value.min()), max(self.high, value.max())
        shown = float(self.low), float(self.high)
        frame = frame_of(simulation, snapshot, quantity, value, shown)
        write_png(
            self.folder / f"frame_{self.count:04d}.png",
            draw(frame, self.style.grid, self.style.size, self.view),
            {"Title": scene.title, "time": repr(snapshot.time)},
        )
        self.count += 1

    @property
    def view(self):
        """What the scene says of it."""
        from ..renderers.camera import View

        said = self.style.view.model_dump(exclude_none=True)
        return View(**said)

    def state(self) -> dict[str, Any]:
        return {"count": self.count, "low": float(self.low), "high": float(self.high)}

    def close(self):
        """Pictures are whole as soon as they are there."""
