"""Rows: how motion and stress of a particle lie in memory, as records of four lanes.

Lengths in rows are in cells.  Row 0 and the rows of the layout change meaning twice per step:

              row 0     layout.affine        layout.gradient   layout.pic
  scattered   (m v, m)  columns of A dx      columns of T/dx   -
  gathered    (v, .)    moments B / dx       sums v dw dx      -
  with an increment: row 0 stays (m v, m), and         v before the increment, sum_i w_i v_i

Where D varies, D^-1 is left to the scatter, which has the D of its own place: so angular momentum
is kept (Jiang et al. 2015).  `layout.residual` holds (m R, 0) of a filtered transfer and
`layout.force` the impulse (dt m b, 0) of a body force.  For an audit `layout.stress` holds the
columns of T / dt, or the `layout.impulse`, those of D^-1 T dx, where that is a part of A.
"""

import taichi as ti

from ..runtime import Template


class RowLayout:
    """Which rows a transfer has, in `dim` dimensions; `keeps_pic`: sum_i w_i v_i outlives the new
    velocity, `force`: there is a body force, `audited`: the stress is kept."""

    def __init__(self, transfer, dim: int, keeps_pic: bool, force: bool, audited: bool = False):
        affine, gradient = dim * transfer.affine, dim * transfer.gradient
        self.affine = range(1, 1 + affine)
        self.moments = self.affine if transfer.moments else range(0)
        self.gradient = range(1 + affine, 1 + affine + gradient)
        self.count = 1 + affine + gradient
        self.pic = self._one_more(transfer.increment or keeps_pic)
        self.residual = self._one_more(transfer.filtered)
        self.force = self._one_more(force)
        self.stress = range(self.count, self.count + dim * audited)
        self.count += len(self.stress)
        self.impulse = range(0) if transfer.gradient else self.stress

    def _one_more(self, wanted: bool) -> int:
        """The number of the next row, 0 if there is none."""
        self.count += wanted
        return self.count - 1 if wanted else 0


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
def put_vector(rows: Template, p, row: Template, v, last):
    """A row = (v, last)."""
    lanes = ti.Vector.zero(float, 4)
    for e in ti.static(range(v.n)):
        lanes[e] = v[e]
    lanes[v.n] = last
    rows[p, row] = lanes
