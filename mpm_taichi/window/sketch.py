"""A stage of the step as a drawing over the particles: nodes with their mass and motion, and what
the picked particle and its nodes give each other."""

import numpy as np

from ..renderers import palette
from ..renderers.camera import Camera
from ..renderers.legend import Text
from ..renderers.rasterizer import draw_discs, draw_lines
from ..renderers.units import round_length
from ..walk import Stage

FADE = 0.6
"""Opacity of the veil over the particles."""

NODE, BARE = 0.17, 3.0
"""Radius of the heaviest node [cells], and of one without mass [pixels]."""

MOVED = 0.4
"""Cells that the fastest node is drawn to move at least."""

FARTHEST = 1.5
"""Cells: nodes that would be drawn farther off are left where they are."""

LABELED = 44
"""Pixels of a cell at whose nodes there is room for a number."""

OTHERS = 0.4
"""Opacity of what does not belong to the picked particle."""

PICKED = palette.BODIES[1]


def enlargement(stage: Stage, dx: float) -> float:
    """How many times as far as they go nodes are drawn to move: 1, 2 or 5 times a power of ten."""
    fastest = float(np.linalg.norm(stage.node_velocity, axis=1).max())
    far = MOVED * dx / (fastest * stage.dt) if fastest > 0 else 1.0
    return round_length(max(far, 1.0))


def is_moving(stage: Stage) -> bool:
    """Whether its nodes have been moved."""
    return bool((stage.moved_node != stage.node_position).any())


def draw_sketch(image: np.ndarray, camera: Camera, stage: Stage, dx: float) -> list[Text]:
    """Into the image of the particles; returns what is to be written on it."""
    image += FADE * (palette.PANEL.astype(np.float32) - image)
    larger, cell = enlargement(stage, dx), dx * camera.scale
    way = larger * (stage.moved_node - stage.node_position)
    way[np.linalg.norm(way, axis=1) > FARTHEST * dx] = 0
    home, seat = camera.pixel_of(stage.node_position), camera.pixel_of(stage.node_position + way)
    p = stage.particle
    start, now = stage.position_before[p], stage.position[p]
    if not is_moving(stage):
        start = now
    here, there = camera.pixel_of(start), camera.pixel_of(start + larger * (now - start))
    if is_moving(stage):
        _draw_moved_grid(image, stage, seat, dx)
    _draw_nodes(image, stage, home, seat, cell)
    if stage.node_mass.any():
        _draw_exchange(image, stage, here, there, seat)
    _arrow(image, here, there, 2, PICKED)
    _disc(image, there, 7.5, palette.BACKGROUND)
    _disc(image, there, 6.0, PICKED)
    texts = [Text((camera.margin, 3.2 * camera.em), stage.name, camera.em, PICKED, "ls")]
    if larger > 1 and is_moving(stage):
        words = f"motion drawn {larger:g} times as far"
        at = (camera.width - camera.margin, 3.2 * camera.em)
        texts.append(Text(at, words, camera.em, palette.FAINT_INK, "rs"))
    if stage.node_mass.any() and cell >= LABELED:
        texts += _labels(stage, seat, there, NODE * cell)
    return texts


def _mixed(color, opacity):
    return palette.PANEL + opacity * (color - palette.PANEL)


def _disc(image, at, radius, color):
    one = np.ones(1)
    draw_discs(image, at[0] * one, at[1] * one, radius * one, color[None])


def _arrow(image, start, end, width, color, off=0.0):
    """Ends `off` pixels before both; none where that leaves nothing."""
    way = end - start
    length = float(np.hypot(*way))
    if not length > 2 * off + 4:
        return
    along, across = way / length, np.array([-way[1], way[0]]) / length
    start, end = start + off * along, end - off * along
    head = min(5 + 1.5 * width, 0.6 * (length - 2 * off))
    draw_lines(image, start[None], (end - 0.5 * width * along)[None], color, width)
    for side in (0.5, -0.5):
        corner = end - head * along + side * head * across
        draw_lines(image, corner[None], end[None], color, max(0.7 * width, 1.2))


def _draw_moved_grid(image, stage, seat, dx):
    """Lines between neighbors, where the motion has taken them."""
    places = np.rint(stage.node_position / dx).astype(int)
    number = {(int(i), int(j)): k for k, (i, j) in enumerate(places)}
    ends = [
        (k, number[other])
        for (i, j), k in number.items()
        for other in ((i + 1, j), (i, j + 1))
        if other in number
    ]
    if ends:
        first, second = seat[np.array(ends).T]
        draw_lines(image, first, second, palette.FAINT_INK, opacity=0.45)


def _draw_nodes(image, stage, home, seat, cell):
    """Discs whose area is the mass; an arrow from where a node was."""
    mine = np.zeros(len(seat), bool)
    mine[stage.nodes] = True
    radius = np.full(len(seat), BARE)
    if stage.node_mass.any():
        share = np.sqrt(stage.node_mass / stage.node_mass.max())
        radius = np.maximum(NODE * cell * share, 1.5)
    color = np.where(mine[:, None], palette.INK, _mixed(palette.INK, OTHERS))
    if stage.name == "grid update":
        for k in np.flatnonzero(stage.node_mass > 0):
            _arrow(image, home[k], seat[k], 2, color[k])
    order = np.argsort(mine, kind="stable")
    column, row = seat[order].T
    draw_discs(image, column, row, radius[order], color[order])


def _draw_exchange(image, stage, here, there, seat):
    """Arrows as strong as the weights, from the particle to its nodes or back."""
    if stage.name not in ("particles to nodes", "nodes to particles"):
        return
    for i, w in zip(stage.nodes, stage.weights, strict=True):
        gives = stage.name == "particles to nodes"
        start, end = (here, seat[i]) if gives else (seat[i], there)
        color = _mixed(PICKED, min(1.0, 0.6 + 2 * w))
        _arrow(image, start, end, 1 + 5 * float(w), color, off=7.0)


def _labels(stage, seat, center, off) -> list[Text]:
    """The weight of each node, on its side away from the particle."""
    texts = []
    for i, w in zip(stage.nodes, stage.weights, strict=True):
        away = seat[i] - center
        length = float(np.hypot(*away))
        along = away / length if length > 1 else np.array([0.0, -1.0])
        at = seat[i] + (off + 16) * along + np.array([0.0, 4.0])
        texts.append(Text((at[0], at[1]), f"{w:.3f}", 12, PICKED, "ms"))
    return texts
