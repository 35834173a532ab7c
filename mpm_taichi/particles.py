"""Particle fields: one contiguous range per material, sorted by place within it; the materials of a
law side by side."""

from dataclasses import dataclass
from itertools import groupby
from typing import Any

import numpy as np
import taichi as ti

from .fields import SCRATCH, particle_fields, state_fields, uses_undeformed_place
from .kernels.fill import fill, fill_particles
from .kernels.rows import RowLayout
from .materials import Material
from .runtime import real_type


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
        """Which take no memory."""
        return np.broadcast_to(0.0, (*self.x.shape, self.x.shape[1]))


class Law:
    """What the materials of one law share on the device, so that it is compiled once: `constants`
    [materials], the particles ends[k] ... ends[k + 1] - 1 of material k, and the history `state` of
    all from `begin` on.  `first` is the number of material 0 among those of all laws.

    H [n, dim, dim] of each material's particles is where the history starts."""

    def __init__(self, materials, dim, dx, first, begin, H):
        self.kind, self.first, self.begin = type(materials[0]), first, begin
        numbers = [material.constants(dx) for material in materials]
        self.constants = ti.Struct.field(dict.fromkeys(numbers[0], float), shape=len(materials))
        fill(self.constants, numbers)
        self.ends: Any = ti.field(int, len(materials) + 1)
        for k, end in enumerate(begin + np.cumsum([0, *map(len, H)])):
            self.ends[k] = int(end)
        plans = state_fields(materials[0], dim, sum(map(len, H)))
        self.has_state = bool(plans)
        if self.has_state:
            starts = [material.start(h) for material, h in zip(materials, H, strict=True)]
            elements = {name: plan.element for name, plan in plans.items()}
            self.state = ti.Struct.field(elements, shape=sum(map(len, H)))
            self.scratch = ti.Struct.field(elements, shape=sum(map(len, H)))
            for name in plans:
                values = np.concatenate([start[name] for start in starts])
                if values.any():
                    self.state.get_member_field(name).from_numpy(values)


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
        law = Law([materials[k] for k in mine], dim, dx, mine[0], int(begin), [H[k] for k in mine])
        groups += [
            Group(materials[k], law, number, int(ends[k] - len(H[k])), int(ends[k]))
            for number, k in enumerate(mine)
        ]
    return groups


def grouped(bodies):
    """The bodies with those of a material, and the materials of a law, side by side; these
    materials; and the id of the first particle of each."""
    materials = list(dict.fromkeys(body.material for body in bodies))
    laws = list(dict.fromkeys(map(type, materials)))
    materials.sort(key=lambda material: laws.index(type(material)))
    order = sorted(range(len(bodies)), key=lambda k: materials.index(bodies[k].material))
    ends = np.cumsum([len(body.x) for body in bodies])
    ids = [int(ends[k]) - len(bodies[k].x) for k in order]
    return [bodies[k] for k in order], materials, ids


def displacement_gradients(bodies):
    """H [n, dim, dim] of all of them; takes no memory where none starts deformed."""
    if any(body.H is not None for body in bodies):
        return np.concatenate([body.displacement_gradient for body in bodies])
    dim = bodies[0].x.shape[1]
    return np.broadcast_to(0.0, (sum(len(body.x) for body in bodies), dim, dim))


def turns(carried):
    """In which the sort moves what is carried, (field, scratch, begin) each: what to bring back
    from its scratch, and what to take there next."""
    waves = []
    for k, record in enumerate(carried):
        turn = sum(scratch is record[1] for _, scratch, _ in carried[:k])
        if turn == len(waves):
            waves.append([])
        waves[turn].append(record)
    return list(zip([[], *waves], [*waves, []], strict=True))


class Particles:
    """x [m], H = F - I [-], m [kg], V0 [m^dim], id (place in the order of the scene), and the rows
    that travel between particles and nodes (kernels/rows.py); where the scene needs them,
    half_width [cells] for a basis that takes particles as extended, and X [m], the place before
    deformation, for a body force that depends on it.

    `lost` is the least id of a particle outside the domain, `bad` of one whose numbers are none
    (kernels/guard.py), or the number of particles; `parting` counts those far from their neighbors
    (the same), `brought_in` those that were put back (kernels/outside.py)."""

    def __init__(
        self, bodies, basis, transfer, dx, keeps_pic=False, body_force=None, audited=False
    ):
        self.dim = bodies[0].x.shape[1]
        self.count = sum(len(body.x) for body in bodies)
        self.layout = RowLayout(transfer, self.dim, keeps_pic, body_force is not None, audited)
        self.transfer, self.basis, self.dx = transfer, basis, dx
        self.dtype = real_type()
        bodies, materials, ids = grouped(bodies)
        self.group_count = len(materials)
        self.groups = groups_of(
            materials, self.dim, dx,
            [displacement_gradients([b for b in bodies if b.material == m]) for m in materials],
        )  # fmt: skip
        self.laws = list(dict.fromkeys(group.law for group in self.groups))
        plans = particle_fields(self.count, self.dim, self.layout.count, basis, body_force)
        fields = {name: plan.field() for name, plan in plans.items()}
        self.x, self.H, self.rows = fields["x"], fields["H"], fields["rows"]
        self.m, self.V0 = fields["m"], fields["V0"]
        self.id, self.order = fields["id"], fields["order"]
        self.lost: Any = ti.field(int, ())
        self.bad: Any = ti.field(int, ())
        self.brought_in: Any = ti.field(int, ())
        self.parting: Any = ti.field(int, ())
        scratch = {name: fields[name + SCRATCH] for name in ("x", "H", "m", "id", "rows")}
        self.carried = [(fields[name], room, 0) for name, room in scratch.items()]
        self.carried.append((self.V0, scratch["m"], 0))
        self.X = self.x
        if uses_undeformed_place(body_force):
            self.X = fields["X"]
            self.carried.append((self.X, scratch["x"], 0))
        if basis.extended:
            self.half_width: Any = fields["half_width"]
            self.carried.append((self.half_width, scratch["m"], 0))
        for law in self.laws:
            if law.has_state:
                self.carried.append((law.state, law.scratch, law.begin))
        self.turns = turns(self.carried)
        self.reach = self._reach(bodies)
        self.fill(bodies, ids)

    def _reach(self, bodies):
        """How far apart two particles may be that share a node [cells] (numerics.md, chapter 3)."""
        if not self.basis.extended:
            return self.basis.support - 1
        return 1 + min(body.V0.min() for body in bodies) ** (1 / self.dim) / self.dx

    def fill(self, bodies, ids):
        """Values at the start; ids[k] is that of the first particle of body k.  Arrays are made in
        the precision of the run, and those of a body are gone before the next."""

        def put(field, values):
            field.from_numpy(np.concatenate(list(map(values, bodies)), dtype=self.dtype))

        first = 0
        for body, id in zip(bodies, ids, strict=True):
            m = body.material.density * body.V0
            x, m_p, V0 = (np.ascontiguousarray(each, self.dtype) for each in (body.x, m, body.V0))
            rows = self.gathered(m, body.v, body.velocity_gradient)
            fill_particles(self, first, id, x, m_p, V0, rows)
            first += len(m)
        self.lost[None] = self.count
        if any(body.H is not None for body in bodies):
            put(self.H, lambda body: body.displacement_gradient)
        if self.X is not self.x:
            put(self.X, lambda body: body.undeformed)
        if self.basis.extended:
            put(self.half_width, lambda body: 0.5 * body.V0 ** (1 / self.dim) / self.dx)

    def gathered(self, m, v, L):
        """Rows [n, rows, 4] as after a gather of velocities v and their gradient L, which serves as
        C too."""
        rows = np.zeros((len(m), self.layout.count, 4), self.dtype)
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

    @property
    def stored(self) -> dict[str, Any]:
        """The fields that a checkpoint keeps, by name, as they lie."""
        names = ["x", "H", "m", "V0", "id", "rows", "brought_in"]
        names += ["X"] * (self.X is not self.x) + ["half_width"] * self.basis.extended
        fields = {name: getattr(self, name) for name in names}
        for number, law in enumerate(self.laws):
            if law.has_state:
                for name in law.state.keys:
                    fields[f"law{number}.{name}"] = law.state.get_member_field(name)
        return fields

    def to_numpy(self, name):
        """A field (`x`, `H`, `m`, `V0`, `rows`) in the order of the scene, float64."""
        values = getattr(self, name).to_numpy().astype(float)
        ordered = np.empty_like(values)
        ordered[self.id.to_numpy()] = values
        return ordered
