"""An unsymmetric state in the fast form and in the twin, and the fields of both, side by side."""

import numpy as np

from mpm_taichi import bases, boundaries, transfers
from mpm_taichi.boundaries import Wall
from mpm_taichi.materials import LinearElastic, NeoHookean
from mpm_taichi.particles import BodyPoints
from mpm_taichi.reference import bases as twin_bases
from mpm_taichi.reference import boundaries as twin_boundaries
from mpm_taichi.reference import transfers as twin_transfers
from mpm_taichi.reference.kernels.stencil import weigh
from mpm_taichi.reference.solver import Solver as TwinSolver
from mpm_taichi.solver import Solver
from mpm_taichi.transfers import FlipPart

CELLS = {2: (7, 9), 3: (6, 7, 8)}
DX = 0.1


def bodies(rng, dim, ends=()):
    """Clouds of two unlike materials that overlap and fly at each other, beside walls or, along the
    axes `ends`, across both ends of the box; the body of the second material lies between the two
    of the first in the order of the scene.

    No particle, and no face of one, is within a twentieth of a cell of a plane through nodes or
    midway between them, where a stencil begins and ends: nodes of almost no mass magnify the
    rounding errors that are compared."""
    center = 0.5 * DX * np.array(CELLS[dim])
    soft = NeoHookean(type="neo_hookean", density=900, youngs_modulus=2e5, poissons_ratio=0.3)
    hard = LinearElastic(
        type="linear_elastic", density=1100, youngs_modulus=1e5, poissons_ratio=0.2
    )
    clouds = [(hard, -1.2, 1.0, 9), (soft, 0.0, -1.0, 13), (hard, 1.5, 2.0, 11)]
    for material, shift, sign, count in clouds:  # always as many: Taichi's cache knows the kernels
        xi = center / DX + shift + 2.4 * (rng.random((500, dim)) - 0.5)
        V0 = DX**dim / 8 * (0.5 + rng.random((500, 1)))
        half = 0.5 * V0 ** (1 / dim) / DX
        knots = np.concatenate([2 * xi, 2 * (xi + half), 2 * (xi - half)], axis=1) % 1
        clear = ((knots > 0.1) & (knots < 0.9)).all(axis=1)
        for d in ends:
            xi[:, d] = (xi[:, d] - 0.5 * CELLS[dim][d]) % CELLS[dim][d]
        mine = np.flatnonzero(clear)[:count]
        v = rng.normal(size=(len(mine), dim)) + sign * np.arange(2, dim + 2)
        L, H = rng.normal(size=(2, len(mine), dim, dim))
        yield BodyPoints(material, DX * xi[mine], v, V0[mine, 0], H=0.05 * H, L=10 * L)


def walls(dim, rules):
    """Unlike rules on the sides, the last one open."""
    sides = [(axis, upper) for axis in range(dim) for upper in (False, True)][:-1]
    names = ["Sticky", "Slip", "Separate", "Slip", "Separate"]
    return tuple(
        Wall(*side, getattr(rules, name)) for side, name in zip(sides, names, strict=False)
    )


def build(rng, dim, basis, transfer, ends=(), whole=False, **options):
    """The same bodies in the fast solver, which takes whole steps if asked to, and in
    the twin."""
    common = list(bodies(rng, dim, ends))
    gravity = rng.normal(size=dim)
    closed = options.get("periodic", ())
    part = float(rng.random())
    options |= {"flip_part": FlipPart(part), "filter_order": 3}

    def make(solver, b, t, rules, **of_its_own):
        sides = tuple(wall for wall in walls(dim, rules) if wall.axis not in closed)
        return solver(
            common, CELLS[dim], DX, getattr(b, basis), getattr(t, transfer), sides, gravity,
            **options, **of_its_own,
        )  # fmt: skip

    return (
        make(Solver, bases, transfers, boundaries, whole=whole),
        make(TwinSolver, twin_bases, twin_transfers, twin_boundaries),
    )


def nodes(grid, lane):
    """Lanes of the first and, with an increment, of the second record, as arrays over the nodes."""
    records = grid.node.to_numpy()
    shape = tuple(n + 1 + 2 * grid.ghost for n in grid.cells)
    inside = tuple(slice(n) for n in shape)

    def box(first):
        return records[first : first + grid.nodes].reshape(*grid.extent, 4)[inside][..., lane]

    return box(0), box(grid.apart) if grid.increment else 0 * box(0)


def reachable(twin):
    """The nodes that particles can reach while they drift by a cell at most: only these are kept
    up to date in the fast form."""
    particles, grid, basis = twin.particles, twin.grid, twin.basis
    reached = np.zeros(grid.shape, bool)
    for p in range(particles.count):
        base = weigh(p, particles, grid, basis)[0]
        reached[tuple(slice(max(i - 1, 0), i + basis.support + 1) for i in base)] = True
    return reached


def particle_fields(fast, twin):
    """Pairs (fast, twin) of everything that particles carry after a step."""
    particles, layout, dim = fast.particles, fast.particles.layout, fast.grid.dim
    rows = particles.to_numpy("rows")
    columns = lambda at: rows[:, list(at), :dim].swapaxes(1, 2)  # noqa: E731
    pairs = {
        "x": (particles.to_numpy("x"), twin.particles.x),
        "H": (particles.to_numpy("H"), twin.particles.H),
        "mass": (rows[:, 0, dim], twin.particles.m),
        "momentum": (rows[:, 0, :dim], twin.particles.m[:, None] * twin.particles.v),
    }
    if fast.transfer.affine:
        pairs["A"] = (columns(layout.affine) / fast.grid.dx, twin.particles.A)
    if fast.transfer.gradient:
        pairs["T"] = (columns(layout.gradient) * fast.grid.dx, twin.particles.T)
    return pairs


def largest_difference(a, b):
    """Relative to the largest value of the field."""
    scale = np.abs(b).max()
    return np.abs(a - b).max() / (scale if scale > 0 else 1.0)
