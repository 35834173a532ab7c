"""The energies over time."""

from math import ceil

import numpy as np

from ..renderers import palette
from ..renderers.legend import Text
from ..renderers.picture import finished
from ..renderers.rasterizer import draw_lines
from ..renderers.units import round_length, tick_labels, with_unit
from .energies import Energies

LEFT, RIGHT, TOP, BOTTOM, LINE = 46, 12, 26, 22, 17
"""Pixels around the curves, and of a line of the key below them."""

SIZE = 12

COLORS: dict[str, np.ndarray] = dict(
    zip(
        ("kinetic", "elastic", "gravitational", "dissipated", "total"),
        palette.rgb("7ac2e7", "f2a63a", "3fbfa8", "c48bf0", "d5dae4"),
        strict=True,
    )
)
"""As the browser player has them."""


def round_ticks(low: float, high: float) -> list[float]:
    """Three to seven round numbers from low to high."""
    step = round_length((high - low) / 3)
    return [k * step for k in range(ceil(low / step - 1e-9), int(high / step + 1e-9) + 1)]


def draw_chart(energies: Energies, end: float, width: int, height: int) -> np.ndarray:
    """uint8 [height, width, 3]; the axis of time goes to `end` [s]."""
    image = np.empty((height, width, 3), np.float32)
    image[:] = palette.BACKGROUND
    curves, times = energies.curves(), np.array(energies.times)
    low = min(0.0, *(values.min() for values in curves.values())) if curves else 0.0
    high = max(0.0, *(values.max() for values in curves.values())) if curves else 0.0
    high = high if high > low else low + 1.0
    bottom = height - BOTTOM - LINE * len(curves)

    def at(time, energy):
        column = LEFT + np.asarray(time) / end * (width - LEFT - RIGHT)
        row = TOP + (high - np.asarray(energy)) / (high - low) * (bottom - TOP)
        return np.stack(np.broadcast_arrays(column, row), axis=-1)

    texts = [Text((LEFT, 0.6 * TOP), "energy", 13, palette.INK, "ls")]
    texts += _axes(image, at, low, high, end, bottom)
    for number, (name, values) in enumerate(curves.items()):
        points = at(times, values)
        draw_lines(image, points[:-1], points[1:], COLORS[name], 1.6)
        row = height - LINE * (len(curves) - number) + 11
        key = np.array([[LEFT, row - 4.0], [LEFT + 16.0, row - 4.0]])
        draw_lines(image, key[:1], key[1:], COLORS[name], 2.5)
        texts.append(Text((LEFT + 24, row), name, SIZE, palette.INK, "ls"))
        now = with_unit(float(values[-1]), "J")
        texts.append(Text((width - RIGHT, row), now, SIZE, palette.INK, "rs"))
    return finished(image, texts)


def _axes(image, at, low, high, end, bottom):
    levels, moments = round_ticks(low, high), round_ticks(0.0, end)
    labels, joule = tick_labels(levels, "J") if len(levels) > 1 else ([], "J")
    clocks, second = tick_labels(moments, "s")
    texts = [Text((LEFT - 6, 0.6 * TOP), joule, SIZE, palette.FAINT_INK, "rs")]
    for level, label in zip(levels, labels, strict=False):
        line = at([0.0, end], level)
        opacity = 1.0 if level == 0 else 0.45
        draw_lines(image, line[:1], line[1:], palette.LINE, opacity=opacity)
        texts.append(Text((LEFT - 6, line[0, 1] + 4), label, SIZE, palette.FAINT_INK, "rs"))
    for moment, clock in zip(moments, clocks, strict=True):
        words = f"{clock} {second}" if moment == moments[-1] else clock
        anchor = "rs" if at(moment, 0)[0] > image.shape[1] - RIGHT - 20 else "ms"
        column = at(moment, 0)[0]
        texts.append(Text((column, bottom + 15), words, SIZE, palette.FAINT_INK, anchor))
    return texts
