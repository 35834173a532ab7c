"""What the user has chosen to see."""

from dataclasses import dataclass

from ..renderers.quantities import QUANTITIES

COLORS = ("body", *QUANTITIES)
"""What the particles can be colored by."""


@dataclass
class Looks:
    """`first`: the particle whose row is the first of the log; `picked`: one, or None."""

    color_by: str = "speed"
    shows_grid: bool = True
    grid_opacity: float = 0.5
    shows_log: bool = False
    first: int = 0
    picked: int | None = None

    @property
    def watched(self) -> int:
        """The particle whose part in a stage of the step is shown."""
        return self.picked or 0

    def next_color(self) -> None:
        self.color_by = COLORS[(COLORS.index(self.color_by) + 1) % len(COLORS)]

    def toggle_grid(self) -> None:
        self.shows_grid = not self.shows_grid

    def toggle_log(self) -> None:
        self.shows_log = not self.shows_log

    def pick(self, particle: int | None) -> None:
        self.picked = particle
        if particle is not None:
            self.first = particle


def looks_of(scene) -> Looks:
    """As the scene's pictures have them; a grid that they do not show can be turned on."""
    images = scene.output.images
    if images == "none":
        return Looks()
    looks = Looks(color_by=images.color_by, shows_grid=images.grid > 0)
    looks.grid_opacity = images.grid or looks.grid_opacity
    return looks
