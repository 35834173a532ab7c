"""frames/frame_0000.png, ...: a picture at each output."""

from math import inf
from pathlib import Path
from typing import Any

import numpy as np


class Images:
    """Pictures by the offscreen renderer.  Where the scene gives no range, the color scale is the
    widest that the run has shown so far, with 0 but for density."""

    every_steps = None

    def __init__(self, folder: Path, simulation, style, state=None):
        folder.mkdir(exist_ok=True)
        self.folder, self.style = folder, style
        widest = (inf, -inf) if style.color_by == "density" else (0.0, 0.0)
        low, high = widest if style.range is None else style.range
        before = state or {"count": 0, "low": low, "high": high}
        self.count, self.low, self.high = before["count"], before["low"], before["high"]
        for path in folder.glob("frame_*.png"):
            number = path.stem.removeprefix("frame_")
            if number.isdecimal() and int(number) >= self.count:
                path.unlink()  # of an attempt that has failed, or drawn again by this one

    def record(self, simulation, is_output):
        if not is_output:
            return
        from ..renderers.picture import Frame, draw  # Pillow, which a run without pictures spares
        from ..renderers.png import write_png

        scene, snapshot = simulation.scene, simulation.snapshot
        value = self._value(snapshot)
        if value is not None and self.style.range is None:
            self.low, self.high = min(self.low, value.min()), max(self.high, value.max())
        edge = snapshot.initial_volume ** (1 / scene.dimension)
        frame = Frame(
            position=snapshot.visible_position,
            radius=0.5 * edge,
            body=simulation.body_of_particle,
            body_names=[body.name for body in scene.bodies],
            time=snapshot.time,
            longest_time=simulation.end,
            title=scene.title,
            domain_size=tuple(scene.domain.size),
            cells=tuple(scene.domain.cells),
            quantity=self.style.color_by,
            value=value,
            value_range=(float(self.low), float(self.high)),
        )
        path = self.folder / f"frame_{self.count:04d}.png"
        write_png(
            path,
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

    def _value(self, snapshot) -> np.ndarray | None:
        return {
            "body": lambda: None,
            "speed": lambda: snapshot.speed,
            "pressure": lambda: snapshot.pressure,
            "stress": lambda: snapshot.von_mises_stress,
            "density": lambda: snapshot.density,
            "plastic_strain": lambda: snapshot.plastic_strain,
        }[self.style.color_by]()
