"""The ranges of the colors."""

from ..renderers.moment import narrowest, value_of
from ..renderers.quantities import QUANTITIES


class Scales:
    """Of each quantity the range that the scene gives, else the widest seen so far, as in pictures
    of a run."""

    def __init__(self, scene):
        self._seen = {quantity: narrowest(quantity) for quantity in QUANTITIES}
        images = scene.output.images
        self._given = {}
        if images != "none" and images.range is not None:
            self._given = {images.color_by: tuple(images.range)}

    def note(self, snapshot) -> None:
        for quantity, (low, high) in self._seen.items():
            value = value_of(snapshot, quantity)
            if value is not None:
                self._seen[quantity] = min(low, float(value.min())), max(high, float(value.max()))

    def of(self, quantity: str) -> tuple[float, float]:
        return self._given.get(quantity) or self._seen.get(quantity, (0.0, 1.0))
