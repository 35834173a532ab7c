"""Rows: how motion and stress of a particle lie in memory, as records of four lanes.

Lengths in rows are in cells.  Row 0 and the rows of the layout change meaning twice per step:

              row 0     layout.affine        layout.gradient   layout.pic
  scattered   (m v, m)  columns of A dx      columns of T/dx   -
  gathered    (v, .)    moments B / dx       sums v dw dx      -
  with an increment: row 0 stays (m v, m), and         v before the increment, sum_i w_i v_i
"""

import taichi as ti

from ..runtime import Template


class RowLayout:
    """Which rows a transfer has, in `dim` dimensions."""

    def __init__(self, transfer, dim: int):
        affine, gradient = dim * transfer.affine, dim * transfer.gradient
        self.affine = range(1, 1 + affine)
        self.gradient = range(1 + affine, 1 + affine + gradient)
        self.pic = 1 + affine + gradient if transfer.increment else 0
        self.count = 1 + affine + gradient + transfer.increment


@ti.func
def vector(rows: Template, p, row: Template, dim: Template):
    """The first `dim` lanes of a row."""
    return ti.Vector([rows[p, row][e] for e in range(dim)])


@ti.func
def columns(rows: Template, p, at: Template, dim: Template):
    """Matrix [dim, dim] whose columns are the rows `at`; zero where there are none."""
    M = ti.Matrix.zero(float, dim, dim)
    for d, row in ti.static(enumerate(at)):
        for e in ti.static(range(dim)):
            M[e, d] = rows[p, row][e]
    return M


@ti.func
def put_columns(rows: Template, p, at: Template, M):
    """Inverse of `columns`; padding lanes are zero."""
    for d, row in ti.static(enumerate(at)):
        rows[p, row] = ti.Vector([M[e, d] if ti.static(e < M.n) else 0.0 for e in range(4)])


@ti.func
def put_momentum(rows: Template, p, m, v):
    """Row 0 = (m v, m)."""
    lanes = ti.Vector.zero(float, 4)
    for e in ti.static(range(v.n)):
        lanes[e] = m * v[e]
    lanes[v.n] = m
    rows[p, 0] = lanes
