"""What a picture can show by color besides the bodies: units and color maps."""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from . import palette


@dataclass(frozen=True)
class Quantity:
    unit: str
    colors: Callable[[np.ndarray], np.ndarray]  # fraction [n] of the range -> RGB [n, 3]
    signed: bool = False  # the range is symmetric about 0
    prefixed: bool = True  # km/s and MPa, but neither kkg/m^3 nor m-


QUANTITIES = {
    "speed": Quantity("m/s", palette.sequential),
    "stress": Quantity("Pa", palette.sequential),
    "pressure": Quantity("Pa", palette.diverging, signed=True),
    "density": Quantity("kg/m^3", palette.sequential, prefixed=False),
    "plastic_strain": Quantity("-", palette.sequential, prefixed=False),
}


def shown_range(quantity: Quantity, low: float, high: float) -> tuple[float, float]:
    """The range of the legend: symmetric for a signed quantity, and never empty."""
    if not (math.isfinite(low) and math.isfinite(high)):
        low, high = 0.0, 1.0
    if quantity.signed:
        high = max(abs(low), abs(high)) or 1.0
        return -high, high
    tiny = 1e-6 * max(abs(low), abs(high))
    return (low, high) if high - low > tiny else (low, low + (abs(low) or 1.0))
