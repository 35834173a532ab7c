"""Particle fields: one contiguous range per material, sorted by place within it."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import taichi as ti

from .kernels.rows import RowLayout
from .materials import Material


@dataclass(frozen=True)
class BodyPoints:
    """The particles of one body at the start: x, v [n, dim] (m, m/s), V0 [n] (m^dim), material."""

    material: Material
    x: np.ndarray
    v: np.ndarray
    V0: np.ndarray


class Group:
    """All particles of one material: its law, constants in a 0-D struct field, state, range."""

    def __init__(self, material, dim, dx, begin, end):
        self.material, self.law, self.begin, self.end = material, type(material), begin, end
        numbers = material.constants(dx)
        self.constants = ti.Struct.field(dict.fromkeys(numbers, float), shape=())
        for name, number in numbers.items():
            self.constants[None][name] = number
        self.has_state = bool(material.state(dim))
        if self.has_state:
            self.state = self._state_field(dim)
            self.scratch = self._state_field(dim)
            for name, start in material.state(dim).items():
                start = np.asarray(start, float)
                self.state.get_member_field(name).from_numpy(
                    np.broadcast_to(start, (end - begin, *start.shape)).copy()
                )

    def _state_field(self, dim):
        kinds = {
            name: ti.types.matrix(len(start), len(start[0]), float)
            if np.ndim(start) == 2
            else float
            for name, start in self.material.state(dim).items()
        }
        return ti.Struct.field(kinds, shape=self.end - self.begin)


class Particles:
    """x [m], H = F - I [-], m [kg], V0 [m^dim], id (place in the order of the scene), and the rows
    that travel between particles and nodes (kernels/rows.py).

    `lost` is the least id of a particle outside the domain, or the number of particles."""

    def __init__(self, bodies, transfer, dx):
        self.dim = bodies[0].x.shape[1]
        self.count = sum(len(body.x) for body in bodies)
        self.layout = RowLayout(transfer, self.dim)
        self.transfer = transfer
        materials = list(dict.fromkeys(body.material for body in bodies))
        self.group_count = len(materials)
        kind = np.repeat([materials.index(body.material) for body in bodies],
                         [len(body.x) for body in bodies])  # fmt: skip
        id = np.argsort(kind, kind="stable")
        ends = np.cumsum(np.bincount(kind, minlength=len(materials)))
        self.groups = [
            Group(material, self.dim, dx, int(begin), int(end))
            for material, begin, end in zip(materials, [0, *ends[:-1]], ends, strict=True)
        ]
        self.x = ti.Vector.field(self.dim, float, self.count)
        self.H = ti.Matrix.field(self.dim, self.dim, float, self.count)
        self.m = ti.field(float, self.count)
        self.V0 = ti.field(float, self.count)
        self.id = ti.field(int, self.count)
        self.rows = ti.Vector.field(4, float, (self.count, self.layout.count))
        self.lost: Any = ti.field(int, ())
        self.order = ti.field(int, self.count)
        reals, whole = ti.field(float, self.count), ti.field(int, self.count)
        self.carried = [  # what the sort moves, each with room for it
            (self.x, ti.Vector.field(self.dim, float, self.count)),
            (self.H, ti.Matrix.field(self.dim, self.dim, float, self.count)),
            (self.m, reals),
            (self.V0, reals),
            (self.id, whole),
            (self.rows, ti.Vector.field(4, float, self.rows.shape)),
        ]

        self.dtype = np.dtype(self.x.to_numpy().dtype.name)
        m = np.concatenate([body.material.density * body.V0 for body in bodies])[id]
        v = np.concatenate([body.v for body in bodies])[id]
        self.x.from_numpy(np.concatenate([body.x for body in bodies])[id])
        self.V0.from_numpy(np.concatenate([body.V0 for body in bodies])[id])
        self.m.from_numpy(m)
        self.id.from_numpy(id)
        self.lost[None] = self.count
        self.rows.from_numpy(self.gathered(m, v))

    def gathered(self, m, v):
        """Rows as after a gather of the velocities v, with no affine motion and no gradient."""
        rows = np.zeros((self.count, self.layout.count, 4))
        rows[:, self.layout.pic, : self.dim] = v
        if self.transfer.increment:
            rows[:, 0, : self.dim] = m[:, None] * v
            rows[:, 0, self.dim] = m
        return rows

    def to_numpy(self, name):
        """A field (`x`, `H`, `m`, `V0`, `rows`) in the order of the scene, float64."""
        values = getattr(self, name).to_numpy().astype(float)
        ordered = np.empty_like(values)
        ordered[self.id.to_numpy()] = values
        return ordered
