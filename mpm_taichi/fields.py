"""Fields before they exist: what is allocated is what such a table says, so that its bytes can be
told in advance."""

from math import prod
from typing import Any, NamedTuple

import numpy as np
import taichi as ti

SCRATCH = " (sort)"
"""Ends the names of the fields that the sort moves others through."""


class FieldPlan(NamedTuple):
    """Records of `lanes` numbers, () for one, (n,) for a vector, (n, m) for a matrix, in an array
    of `shape`.  `kind` is float, in the precision of the run, ti.f64 or int."""

    kind: Any
    lanes: tuple[int, ...]
    shape: tuple[int, ...]

    @property
    def element(self) -> Any:
        """The Taichi type of a record."""
        if not self.lanes:
            return self.kind
        if len(self.lanes) == 1:
            return ti.types.vector(self.lanes[0], self.kind)
        rows, columns = self.lanes
        return ti.types.matrix(rows, columns, self.kind)

    def field(self) -> Any:
        return ti.field(self.element, self.shape)

    def bytes(self, precision: str) -> int:
        """int has 4 bytes in either precision."""
        wide = self.kind is ti.f64 or (self.kind is float and precision == "f64")
        number = 8 if wide else 4
        return number * prod(self.lanes) * prod(self.shape)


def uses_undeformed_place(body_force) -> bool:
    """Whether a body force depends on X."""
    return body_force is not None and bool(body_force.variables & {"X", "Y", "Z"})


def particle_fields(count, dim, row_count, basis, body_force) -> dict[str, FieldPlan]:
    """Of `count` particles with `row_count` rows each, without the history of their laws: what they
    have, and the scratch of the sort.  V0 and half_width share that of m, X that of x."""
    number = FieldPlan(float, (), (count,))
    whole = FieldPlan(int, (), (count,))
    fields = {
        "x": FieldPlan(float, (dim,), (count,)),
        "H": FieldPlan(float, (dim, dim), (count,)),
        "m": number,
        "V0": number,
        "id": whole,
        "rows": FieldPlan(float, (4,), (count, row_count)),
        "order": whole,
    }
    fields |= {name + SCRATCH: fields[name] for name in ("m", "id", "x", "H", "rows")}
    if uses_undeformed_place(body_force):
        fields["X"] = fields["x"]
    if basis.extended:
        fields["half_width"] = number
    return fields


def state_fields(material, dim, count) -> dict[str, FieldPlan]:
    """The history of `count` particles of a law."""
    return {
        name: FieldPlan(float, np.shape(start), (count,))
        for name, start in material.state(dim).items()
    }
