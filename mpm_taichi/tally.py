"""What a run adds up for its audit (audit.py), step by step and where it arises.

Sums do not depend on the number of threads: each row of a table is written by one worker, in order,
and the rows are added up when somebody asks.  Numbers are f64 where every device of the kind has
it."""

from types import SimpleNamespace

import numpy as np
import taichi as ti

from .fields import FieldPlan
from .kernels.blocks import BLOCK
from .kernels.tally import TURNS
from .runtime import widest_float


def nodes_at_walls(layout, walls, folded) -> np.ndarray:
    """Linear indices, rising, of the nodes where a wall can act: its own, and along folded axes
    ghost nodes and their images."""
    if not walls:
        return np.zeros(0, np.int32)
    number = np.arange(np.prod(layout.shape), dtype=np.int64)
    at = np.stack(np.unravel_index(number, layout.shape))
    near = np.zeros(len(number), bool)
    for wall in walls:
        reach = layout.ghost - 1 if wall.axis in folded else 0
        k = at[wall.axis] - (layout.ghost + layout.cells[wall.axis] * wall.upper)
        near |= np.abs(k) <= reach
    strides = np.array(layout.strides)[:, None]
    return (at[:, near] * strides).sum(axis=0).astype(np.int32)


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
        self.nodes_at_walls = nodes_at_walls(layout, walls, folded)
        self.nodes = columns(given=1, held=1, end=1, cut=1, lost=dim)
        self.particles = columns(
            kinetics=not transfer.increment, kinetic=not transfer.increment,
            path=dim * falls, moment=dim * falls,
            push=dim * force, twist=turns * force, pushing=int(force),
        )  # fmt: skip
        self.stress = columns(work=1)
        self.walls = columns(impulse=dim, turn=turns, images=int(self.lets_go))
        walled = len(self.nodes_at_walls)
        self.has_walls, self.by_stage = walled > 0, True
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
    """The tables of a run.  `dt`-weighted sums run from its start."""

    def __init__(self, grid, walls, count, groups, transfer, gravity, force):
        falls = any(gravity)
        super().__init__(grid, walls, grid.folded, count, groups, transfer, falls, force)
        self.gravity, self.real = np.array(gravity, float), widest_float()
        self.increment, self.stress_in_affine = transfer.increment, not transfer.gradient
        self.at = {name: plan.field() for name, plan in self.fields.items()}
        self.at_nodes = self.at["tally_at_nodes"]
        self.of_particles = self.at.get("tally_of_particles")
        self.of_stress = self.at["tally_of_stress"]
        self.at_walls = self.at.get("tally_at_walls")
        if self.at_walls is not None:
            self.wall_node, self.wall_mass = self.at["wall_node"], self.at["wall_mass"]
            self.wall_node.from_numpy(self.nodes_at_walls)

    def totals(self) -> dict[str, np.ndarray]:
        """Of each name in the layout the sum since the start, [1] or a vector."""
        found = {}
        for values, of in (
            (self.at_nodes, self.nodes),
            (self.of_particles, self.particles),
            (self.of_stress, self.stress),
            (self.at_walls, self.walls),
        ):
            total = 0.0 if values is None else values.to_numpy().astype(float).sum(axis=0)
            for name, width in of.widths.items():
                first = getattr(of, name)
                part = np.zeros(width) if values is None else total[first : first + width]
                found[name] = part
        return found

    def state(self) -> dict[str, np.ndarray]:
        """All that a run needs to go on adding, bit for bit."""
        return {n: self.at[n].to_numpy() for n in self.at if n.startswith("tally")}

    def restore(self, state: dict[str, np.ndarray]):
        for name, values in state.items():
            self.at[name].from_numpy(values)
