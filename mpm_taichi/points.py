"""Material points as a sampler returns them."""

from typing import NamedTuple

import numpy as np


class Points(NamedTuple):
    """Positions x [m], float64 [n, dim], and volumes V0 [m^dim], float64 [n], n >= 1."""

    x: np.ndarray
    V0: np.ndarray
