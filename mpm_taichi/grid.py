"""Nodes of a box of cells: a 1-D field of four-lane records, addressed by one linear index."""

from itertools import product
from math import prod
from typing import Any

import numpy as np
import taichi as ti

from .errors import InputError
from .fields import FieldPlan
from .kernels.blocks import BLOCK, CHUNK, GATE
from .kernels.fill import fill
from .kernels.tiles import COLORS, MANY

PAD = 4  # nodes


def folded_axes(basis, walls, periodic) -> tuple[int, ...]:
    """Axes with ghost nodes that are images.  Hat functions and modified splines give nothing to
    the nodes behind a wall."""
    mirrors = basis.support > 2 and not basis.modified
    return tuple(sorted({*periodic, *(wall.axis for wall in walls if mirrors)}))


class NodeLayout:
    """Where nodes lie in memory, and the fields that a grid of them has, by name.

    The box [0, cells] has ghost nodes around it, as wide as the stencil.  `groups` is the number of
    materials, `particles` that of particles; with `increment`, or `audited`, each node has a second
    record."""

    def __init__(self, cells, basis, groups, particles, increment, audited=False):
        self.dim, self.cells = len(cells), tuple(cells)
        self.increment, self.audited = increment, audited
        self.ghost = self.support = basis.support
        self.records = tuple(range(1 + (increment or audited)))
        # Rows and planes are PAD nodes longer than the box: strides of a power of two would put
        # the lines of a stencil into the same few sets of the first-level cache.
        self.shape = tuple(n + 1 + 2 * self.ghost for n in cells)
        self.lines_along = [prod(self.shape) // n for n in self.shape]
        self.extent = (self.shape[0], *(n + PAD for n in self.shape[1:]))
        strides = [1]
        for n in reversed(self.extent[1:]):
            strides.insert(0, n * strides[0])
        self.strides = tuple(strides)
        self.nodes = self.extent[0] * self.strides[0]
        # The mask tells LLVM that index + offset cannot overflow (offsets become displacements of
        # one address), and keeps a lost particle inside the field, longer by one stencil.
        self.mask = 2 ** (self.nodes - 1).bit_length() - 1
        self.apart = self.mask + 1 + basis.support * sum(self.strides)
        length = self.apart * len(self.records)
        if length >= 2**31:
            raise InputError(
                f"domain.cells: {' x '.join(map(str, cells))} cells need {length:.2e} nodes, more "
                "than the 2^31 that an index can count: take fewer, larger cells"
            )
        # Tiles of fixed width (kernels/tiles.py): two of one color share no node while particles
        # are within a cell of where the sort found them.
        self.slab = basis.support + 1
        self.slabs = 2 * -(-self.extent[0] // (2 * self.slab))
        self.strip = self.slab if self.dim == 3 and particles >= MANY else self.extent[1]
        self.strips = -(-self.extent[1] // self.strip)
        tiles, self.segments = self.slabs * self.strips, self.slabs * self.slab * self.strips
        self.chunks = -(-self.nodes // CHUNK)
        whole_chunks = FieldPlan(int, (), ((self.mask + 1) // CHUNK,))
        self.fields = {
            "node": FieldPlan(float, (4,), (length,)),
            "start": FieldPlan(int, (), (groups, self.segments + 1)),
            "tile": FieldPlan(int, (), (tiles,)),
            "tile_begin": FieldPlan(int, (), (COLORS + 1,)),
            "share": FieldPlan(float, (), (tiles,)),
            "count": FieldPlan(int, (), (self.mask + 1,)),
            "occupied": whole_chunks,
            "reached": whole_chunks,
            "active": FieldPlan(int, (), (self.chunks,)),
        }


class Grid(NodeLayout):
    """Node i at (i - ghost) dx holds (momentum [kg m/s], mass [kg]) after P2G and (velocity [m/s],
    mass) after the grid update, in lanes 0 .. dim - 1 and dim.  With `increment` it has a second
    record, at i + apart: (impulse of the stress [kg m/s], 0), then (v - v_old [m/s], 0); `audited`
    has the first of these too.

    The closed domain [0, size] has `cells` cells.  `mass_cutoff` is the mass [kg] up to which a
    node counts as empty, `walls` and `periodic` the sides with a rule and the axes that close on
    themselves."""

    def __init__(
        self, cells, dx, basis, groups, particles, increment, mass_cutoff, walls, periodic, threads,
        atomic, audited=False,
    ):  # fmt: skip
        super().__init__(cells, basis, groups, particles, increment, audited)
        self.dx, self.threads, self.atomic = dx, threads, atomic
        self.colors = 1 if atomic else COLORS if self.strips > 1 else 2
        # See kernels/blocks.py.
        self.gate, self.block, self.node_block = (1, 1, 1) if atomic else (GATE, BLOCK, CHUNK)
        self.periodic = tuple(sorted(periodic))  # as `folded`: images of images
        self.bounded = tuple(axis for axis in range(self.dim) if axis not in self.periodic)
        self.walled = tuple((wall.axis, wall.upper) for wall in walls)
        self.folded = folded_axes(basis, walls, self.periodic)
        self.lines = list(product(range(basis.support), repeat=self.dim - 1))
        fields = {name: plan.field() for name, plan in self.fields.items()}
        self.node = fields["node"]
        self.start = fields["start"]  # first particle [group, segment]
        self.tile = fields["tile"]  # first segment, of tiles with particles, by color
        self.tile_begin = fields["tile_begin"]  # in that list [color]
        self.share = fields["share"]  # part of the particles of a color before a tile's middle
        self.count = fields["count"]  # of the sort, 0 outside of it
        # Chunks of nodes: those where stencils begin, those that particles can reach, their list.
        self.occupied, self.reached = fields["occupied"], fields["reached"]
        self.active = fields["active"]
        self.active_count: Any = ti.field(int, ())
        self.placed: Any = ti.field(int, ())
        self.lowest: Any = ti.Vector.field(self.dim, int, ())  # first node of a stencil
        self.highest: Any = ti.Vector.field(self.dim, int, ())
        # Largest of all particles in this step: |sum_i w_i v_i|^2, |L|^2 (Frobenius), - tr L.
        self.speed_squared: Any = ti.field(float, ())
        self.rate_squared: Any = ti.field(float, ())
        self.compression: Any = ti.field(float, ())
        self.cut: Any = ti.field(int, ())  # nodes that the cut-off emptied, counted each step
        numbers = {
            "dx": dx,
            "inv_dx": 1.0 / dx,
            "inverse_moment": (basis.inverse_moment or 1.0) / dx**2,
            "mass_cutoff": mass_cutoff,
        }
        size = ti.types.vector(self.dim, float)
        self.constants = ti.Struct.field({**dict.fromkeys(numbers, float), "size": size}, shape=())
        fill(self.constants, [{**numbers, "size": [n * dx for n in cells]}])

    def note_reach(self, active_count, lowest, highest):
        """After a sort: what the host has to know of the nodes that particles can reach."""
        self.node_workers = self.workers(active_count * CHUNK)
        low, high = lowest - 1, highest + self.support
        self.near_end = (low < self.ghost) | (high > self.ghost + np.array(self.cells))
        at_end = (low <= self.ghost) | (high >= self.ghost + np.array(self.cells))
        self.is_near_wall = any(at_end[axis] for axis, _ in self.walled)

    @property
    def stored(self) -> dict[str, Any]:
        """The fields that a checkpoint keeps, by name: what the last sort has found, and the count
        of nodes cut.  From them `plan` (kernels/sort.py) makes the rest."""
        names = ("start", "occupied", "lowest", "highest", "cut")
        return {f"grid.{name}": getattr(self, name) for name in names}

    def workers(self, count):
        """How many share `count` elements."""
        return count if self.atomic else self.threads

    def is_near_end(self, axis):
        """Whether particles reach ghost nodes along an axis."""
        return axis in self.periodic or self.near_end[axis]
