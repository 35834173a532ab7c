"""Particle fields: one contiguous range per material, sorted by place within it; the materials of a
law side by side."""

from dataclasses import dataclass
from itertools import groupby
from typing import Any

import numpy as np
import taichi as ti

from .kernels.rows import RowLayout
from .materials import Material


@dataclass(frozen=True)
class BodyPoints:
    """The particles of one body at the start: material; x, v [n, dim] (m, m/s), V0 [n] (m^dim); if
    it is not 0 the velocity gradient L [n, dim, dim] (1/s); and of a body that starts deformed its
    places before, X [n, dim] (m), and H = F - I [n, dim, dim]."""

    material: Material
    x: np.ndarray
    v: np.ndarray
    V0: np.ndarray
    X: np.ndarray | None = None
    H: np.ndarray | None = None
    L: np.ndarray | None = None

    @property
    def undeformed(self) -> np.ndarray:
        return self.x if self.X is None else self.X

    @property
    def displacement_gradient(self) -> np.ndarray:
        return self._zeros() if self.H is None else self.H

    @property
    def velocity_gradient(self) -> np.ndarray:
        return self._zeros() if self.L is None else self.L

    def _zeros(self):
        return np.zeros((*self.x.shape, self.x.shape[1]))


class Law:
    """What the materials of one law share on the device, so that it is compiled once: `constants`
    [materials], the particles ends[k] ... ends[k + 1] - 1 of material k, and the history `state` of
    all from `begin` on.

    H [n, dim, dim] of each material's particles is where the history starts."""

    def __init__(self, materials, dim, dx, begin, H):
        self.kind, self.begin = type(materials[0]), begin
        numbers = [material.constants(dx) for material in materials]
        self.constants = ti.Struct.field(dict.fromkeys(numbers[0], float), shape=len(materials))
        for k, values in enumerate(numbers):
            for name, number in values.items():
                self.constants[k][name] = number
        self.ends = ti.field(int, len(materials) + 1)
        self.ends.from_numpy(begin + np.cumsum([0, *map(len, H)], dtype=np.int32))
        history = materials[0].state(dim)
        self.has_state = bool(history)
        if self.has_state:
            starts = [material.start(h) for material, h in zip(materials, H, strict=True)]
            self.state = self._state_field(history, sum(map(len, H)))
            self.scratch = self._state_field(history, sum(map(len, H)))
            for name in history:
                values = np.concatenate([start[name] for start in starts])
                self.state.get_member_field(name).from_numpy(values)

    def _state_field(self, history, count):
        kinds = {
            name: ti.types.matrix(len(start), len(start[0]), float)
            if np.ndim(start) == 2
            else float
            for name, start in history.items()
        }
        return ti.Struct.field(kinds, shape=count)


@dataclass(frozen=True)
class Group:
    """All particles of one material: begin ... end - 1, and its number within its law."""

    material: Material
    law: Law
    number: int
    begin: int
    end: int


def groups_of(materials, dim, dx, H) -> list[Group]:
    """A group for each material, whose particles start with H [n, dim, dim]; those of a law lie
    side by side in `materials`."""
    ends = np.cumsum([len(h) for h in H])
    groups = []
    for _, together in groupby(range(len(materials)), key=lambda k: type(materials[k])):
        mine = list(together)
        begin = ends[mine[0]] - len(H[mine[0]])
        law = Law([materials[k] for k in mine], dim, dx, int(begin), [H[k] for k in mine])
        groups += [
            Group(materials[k], law, number, int(ends[k] - len(H[k])), int(ends[k]))
            for number, k in enumerate(mine)
        ]
    return groups


class Particles:
    """x [m], H = F - I [-], m [kg], V0 [m^dim], id (place in the order of the scene), and the rows
    that travel between particles and nodes (kernels/rows.py); where the scene needs them,
    half_width [cells] for a basis that takes particles as extended, and X [m], the place before
    deformation, for a body force that depends on it.

    `lost` is the least id of a particle outside the domain, or the number of particles."""

    def __init__(self, bodies, basis, transfer, dx, keeps_pic=False, body_force=None):
        self.dim = bodies[0].x.shape[1]
        self.count = sum(len(body.x) for body in bodies)
        self.layout = RowLayout(transfer, self.dim, keeps_pic, body_force is not None)
        self.transfer, self.basis, self.dx = transfer, basis, dx
        materials = list(dict.fromkeys(body.material for body in bodies))
        laws = list(dict.fromkeys(map(type, materials)))
        materials.sort(key=lambda material: laws.index(type(material)))
        self.group_count = len(materials)
        kind = np.repeat([materials.index(body.material) for body in bodies],
                         [len(body.x) for body in bodies])  # fmt: skip
        id = np.argsort(kind, kind="stable")
        ends = np.cumsum(np.bincount(kind, minlength=len(materials)))
        H = np.concatenate([body.displacement_gradient for body in bodies])[id]
        self.groups = groups_of(materials, self.dim, dx, np.split(H, ends[:-1]))
        self.laws = list(dict.fromkeys(group.law for group in self.groups))
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
        self.X = self.x
        if body_force is not None and body_force.variables & {"X", "Y", "Z"}:
            self.X = ti.Vector.field(self.dim, float, self.count)
            self.carried.append((self.X, self.carried[0][1]))
        if basis.extended:
            self.half_width: Any = ti.field(float, self.count)
            self.carried.append((self.half_width, reals))
        self.carried = [(field, scratch, 0) for field, scratch in self.carried] + [
            (law.state, law.scratch, law.begin) for law in self.laws if law.has_state
        ]

        self.dtype = np.dtype(self.x.to_numpy().dtype.name)
        m = np.concatenate([body.material.density * body.V0 for body in bodies])[id]
        v = np.concatenate([body.v for body in bodies])[id]
        V0 = np.concatenate([body.V0 for body in bodies])[id]
        if self.X is not self.x:
            self.X.from_numpy(np.concatenate([body.undeformed for body in bodies])[id])
        if basis.extended:
            self.half_width.from_numpy(0.5 * V0 ** (1 / self.dim) / dx)
        self.x.from_numpy(np.concatenate([body.x for body in bodies])[id])
        self.H.from_numpy(H)
        self.V0.from_numpy(V0)
        self.m.from_numpy(m)
        self.id.from_numpy(id)
        self.lost[None] = self.count
        L = np.concatenate([body.velocity_gradient for body in bodies])[id]
        self.rows.from_numpy(self.gathered(m, v, L))

    def gathered(self, m, v, L):
        """Rows as after a gather of velocities v and their gradient L, which serves as C too."""
        rows = np.zeros((self.count, self.layout.count, 4))
        rows[:, 0, : self.dim] = v
        rows[:, self.layout.pic, : self.dim] = v
        inverse_moment = self.basis.inverse_moment or 1.0
        for at, unit in (self.layout.moments, 1 / inverse_moment), (self.layout.gradient, 1.0):
            for d, row in enumerate(at):
                rows[:, row, : self.dim] = self.dx * unit * L[:, :, d]
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
