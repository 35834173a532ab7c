"""The numbers and formulas of a stage of the step, as lines of text."""

import numpy as np

from ..walk import Number, Stage
from .log import number, vector

NONE = ("Step takes the first stage of a step.", "A click picks the particle that is followed.")


def place(stage: Stage, i: int, dx: float) -> str:
    """Of a node, in cells."""
    return "{:d}, {:d}".format(*np.rint(stage.node_position[i] / dx).astype(int))


def shown(one: Number) -> str:
    """v_p = (0.1, 0.1) m/s; a matrix by its rows."""
    value = np.asarray(one.value)
    if value.ndim == 2:
        words = f"({', '.join(map(vector, value))})"
    else:
        words = vector(value) if value.ndim else number(value)
    return f"{one.symbol} = {words} {'' if one.unit == '-' else one.unit}".rstrip()


def stage_lines(stage: Stage | None, dx: float) -> list[str]:
    if stage is None:
        return list(NONE)
    nearest = stage.nodes[int(stage.weights.argmax())]
    return [
        f"{stage.name}; t = {stage.time:.6g} s, dt = {stage.dt:.3g} s",
        *(f"  {line}" for line in stage.formula),
        f"particle p = {stage.particle}, its nearest node i = ({place(stage, nearest, dx)})",
        *(f"  {shown(one)}" for one in stage.numbers),
    ]


def node_lines(stage: Stage | None, dx: float) -> list[str]:
    """The nodes of the particle."""
    if stage is None:
        return []
    lines = [f"{'node i':>9} {'w_ip':>8} {'m_i [kg]':>10}  {'v_i [m/s]':<24}  grad w_ip [1/m]"]
    for i, w, dw in zip(stage.nodes, stage.weights, stage.gradients, strict=True):
        words = vector(stage.node_velocity[i])
        lines.append(
            f"{place(stage, i, dx):>9} {w:8.4f} {number(stage.node_mass[i]):>10}  {words:<24}  "
            f"{vector(dw)}"
        )
    total = float(stage.weights.sum())
    return [*lines, f"{'sum':>9} {total:8.4f}"]
