"""Whether a series grows, or only scatters."""

import numpy as np

BLOCKS = 10
CHANCE = 4.5
"""Which |t| of `trend` exceeds once in 500 series without a trend (Student, 8 degrees of
freedom)."""


def trend(values: np.ndarray) -> tuple[float, float]:
    """Slope over the whole of a series that was sampled evenly, and its t: by a straight line
    through the means of ten blocks, which depend on each other less than the values do.  What is
    below rounding is no trend."""
    means = np.array([block.mean() for block in np.array_split(values, BLOCKS)])
    x = (np.arange(BLOCKS) + 0.5) / BLOCKS - 0.5
    slope = float(x @ means / (x @ x))
    left = means - means.mean() - slope * x
    error = np.sqrt(left @ left / (BLOCKS - 2) / (x @ x))
    rounding = 4 * np.finfo(float).eps * np.abs(values).max()
    return slope, slope / float(max(error, rounding, np.finfo(float).tiny))
