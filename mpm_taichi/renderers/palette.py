"""Colors for a dark background, as RGB floats from 0 to 1: the theme, two color maps, the bodies.

The colors were chosen in OKLab (Ottosson 2020), where equal distances look equal."""

import numpy as np


def rgb(*codes: str) -> np.ndarray:
    """Hexadecimal colors "rrggbb" -> [n, 3]."""
    return np.array([list(bytes.fromhex(code)) for code in codes]) / 255


def eight_bit(color: np.ndarray) -> tuple[int, int, int]:
    red, green, blue = (int(255 * channel + 0.5) for channel in color)
    return red, green, blue


def color_map(*codes: str) -> np.ndarray:
    """1024 colors, linear between those given at equal distances."""
    knots, steps = np.linspace(0, 1, len(codes)), np.linspace(0, 1, 1024)
    return np.stack([np.interp(steps, knots, channel) for channel in rgb(*codes).T], axis=-1)


SHADOW, BACKGROUND, PANEL, LINE = rgb("0d0f15", "10131a", "181c25", "3a4252")
MISSING, FAINT_INK, INK = rgb("6b7280", "98a1b3", "e8ebf1")
BODIES = rgb("7ac2e7", "f2a63a", "239a86", "b26ae9", "fef0a9", "5a5c98", "e1530b")
SEQUENTIAL = color_map(
    *("334593", "0c62a4", "127da1", "1a97a4", "1bb1a3", "4fc898", "90d98a", "cbe681", "fef19f")
)
DIVERGING = color_map(
    *("1870c2", "4f93dd", "86b5ea", "bad3f0", "ebebeb", "eec6ba", "e49d87", "d37152", "b44723")
)


def pick(colors: np.ndarray, fraction: np.ndarray) -> np.ndarray:
    """Colors [n, 3] at fractions [n] of a map: the end's beyond an end, MISSING for NaN."""
    missing = np.isnan(fraction)
    last = len(colors) - 1
    index = np.rint(np.clip(np.where(missing, 0, fraction), 0, 1) * last).astype(int)
    picked = colors[index]
    picked[missing] = MISSING
    return picked


def sequential(fraction: np.ndarray) -> np.ndarray:
    """From blue (0) by green to pale yellow (1), the lightness growing evenly."""
    return pick(SEQUENTIAL, fraction)


def diverging(fraction: np.ndarray) -> np.ndarray:
    """From blue (0) by light gray (1/2) to vermilion (1)."""
    return pick(DIVERGING, fraction)


def body(index: np.ndarray) -> np.ndarray:
    """Color [n, 3] of each body; the seven colors repeat.  Any two of them stay apart for
    protanopes, deuteranopes and tritanopes (at least 0.14 in OKLab)."""
    return BODIES[np.asarray(index) % len(BODIES)]
