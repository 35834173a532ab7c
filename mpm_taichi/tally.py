"""What a run adds up for its audit (audit.py), step by step and where it arises.

Sums do not depend on the number of threads: each row of a table is written by one worker, in order,
and the rows are added up when somebody asks.  Numbers are f64 where every device of the kind has
it."""

from math import prod
from types import SimpleNamespace
from typing import Any

import numpy as np
import taichi as ti

from .fields import FieldPlan
from .kernels.blocks import BLOCK
from .kernels.tally import TURNS
from .runtime import widest_float


def planes_at_walls(layout, walls, folded) -> list[np.ndarray]:
    """Of each axis which planes of nodes a wall can act in, [shape]: its own, and along folded axes
    ghost nodes and their images."""
    planes = [np.zeros(n, bool) for n in layout.shape]
    for wall in walls:
        reach = layout.ghost - 1 if wall.axis in folded else 0
        at = layout.ghost + layout.cells[wall.axis] * wall.upper
        planes[wall.axis][max(at - reach, 0) : at + reach + 1] = True
    return planes


def nodes_in(planes, strides) -> np.ndarray:
    """Linear indices, rising, of the nodes in one of these planes."""
    near = np.zeros([len(plane) for plane in planes], bool)
    for axis, plane in enumerate(planes):
        near |= plane.reshape([-1 if d == axis else 1 for d in range(near.ndim)])
    found = sum(k * stride for k, stride in zip(np.nonzero(near), strides, strict=True))
    return np.asarray(found, np.int32)


class TallyLayout:
    """Columns of the tables, and their fields.

    at_nodes      kinetic energy of the nodes as given by the particles, as the walls leave it
                  (held), and at the end of the grid update [J]; what the mass cut-off has taken of
                  the first (cut), and of momentum and impulses (lost) [kg m/s]
    of_particles  sum over the steps (kinetics) and last value (kinetic) of the kinetic energy
                  with that of the affine motion [J], of transfers without increment; under gravity
                  sum dt m v (path) [kg m] and sum dt m x (moment) [kg m s]; impulse of a body force
                  (push), its moment (twist) and work (pushing)
    of_stress     work of the stress, which the laws store or lose (work) [J]
    at_walls      impulse of the walls [kg m/s], its moment (turn) [kg m^2/s] and the kinetic energy
                  that images have and nodes had not (images) [J]"""

    def __init__(self, layout, walls, folded, count, groups, transfer, falls, force):
        dim, turns = layout.dim, len(TURNS[layout.dim])
        self.falls, self.force = falls, force
        self.lets_go = any(wall.rule.lets_go for wall in walls)
        self.planes = planes_at_walls(layout, walls, folded)
        inside = prod(len(plane) - int(plane.sum()) for plane in self.planes)
        self.node_count = prod(layout.shape) - inside
        self.nodes = columns(given=1, held=1, end=1, cut=1, lost=dim)
        self.particles = columns(
            kinetics=not transfer.increment, kinetic=not transfer.increment,
            path=dim * falls, moment=dim * falls,
            push=dim * force, twist=turns * force, pushing=int(force),
        )  # fmt: skip
        self.stress = columns(work=1)
        self.walls = columns(impulse=dim, turn=turns, images=int(self.lets_go))
        walled = self.node_count
        self.has_walls, self.has_particles = walled > 0, self.particles.count > 0
        self.fields = {
            "tally_at_nodes": table(layout.chunks, self.nodes),
            "tally_of_particles": table(-(-count // BLOCK), self.particles),
            "tally_of_stress": table(count // BLOCK + groups + 1, self.stress),
            "tally_at_walls": table(-(-walled // BLOCK), self.walls),
            "wall_node": FieldPlan(int, (), (walled,)),
            "wall_mass": FieldPlan(float, (), (walled,)),
        }
        self.fields = {name: plan for name, plan in self.fields.items() if plan.bytes("f64")}


def columns(**widths) -> SimpleNamespace:
    """The first column of each, and `count`, that of all."""
    starts = np.cumsum([0, *widths.values()]).tolist()
    return SimpleNamespace(**dict(zip([*widths, "count"], starts, strict=True)), widths=widths)


def table(rows, of) -> FieldPlan:
    return FieldPlan(ti.f64, (), (rows, of.count))


class Tally(TallyLayout):
    """The tables of a run.  `start` has the energies that its ledger starts with, [kinetic, what
    the laws store, what they have lost] (J)."""

    is_on = True

    def __init__(self, grid, walls, count, groups, transfer, gravity, force):
        falls = any(gravity)
        super().__init__(grid, walls, grid.folded, count, groups, transfer, falls, force)
        self.real = widest_float()
        self.increment, self.stress_in_affine = transfer.increment, not transfer.gradient
        self.start = [0.0, 0.0, 0.0]
        fields = {name: plan.field() for name, plan in self.fields.items()}
        self.at_nodes: Any = fields["tally_at_nodes"]
        self.of_stress: Any = fields["tally_of_stress"]
        self.tables = [(self.at_nodes, self.nodes), (self.of_stress, self.stress)]
        if self.has_particles:
            self.of_particles: Any = fields["tally_of_particles"]
            self.tables.append((self.of_particles, self.particles))
        if self.has_walls:
            self.at_walls: Any = fields["tally_at_walls"]
            self.tables.append((self.at_walls, self.walls))
            self.wall_node: Any = fields["wall_node"]
            self.wall_mass: Any = fields["wall_mass"]
            self.wall_node.from_numpy(nodes_in(self.planes, grid.strides))

    def totals(self) -> dict[str, np.ndarray]:
        """Of each name in the layout that the run has, the sum since its start, [1] or a vector."""
        found = {}
        for values, of in self.tables:
            total = values.to_numpy().astype(float).sum(axis=0)
            for name, width in of.widths.items():
                if width:
                    found[name] = total[getattr(of, name) :][:width]
        return found

    @property
    def stored(self) -> dict[str, Any]:
        """The fields that a checkpoint keeps, by name."""
        return {f"tally_{k}": values for k, (values, _) in enumerate(self.tables)}
