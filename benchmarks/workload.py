"""The work that is timed: a neo-Hookean block in shear in the middle of a box, 2^dim particles per
cell, dt = 0.1 dx / c, in a form `basis transfer` of ours, in the textbook form or Taichi's own."""

from types import SimpleNamespace

import numpy as np
from laws import LAWS

from mpm_taichi import bases, transfers
from mpm_taichi.boundaries import Separate, Wall
from mpm_taichi.materials import NeoHookean
from mpm_taichi.particles import BodyPoints
from mpm_taichi.scene.checks import moment
from mpm_taichi.solver import Solver
from mpm_taichi.transfers import FlipPart

FORMS = ("quadratic mls", "quadratic apic", "quadratic flip", "linear flip")
TEXTBOOK = ("textbook sorted", "textbook random")
PEERS = ("mpm3d sorted",)
"""Taichi's own example, which its package brings along."""

MATERIAL = NeoHookean(type="neo_hookean", density=1000, youngs_modulus=1e5, poissons_ratio=0.3)


def pair(form):
    """Basis and transfer of `basis transfer`; ValueError with a sentence where there are none."""
    named_bases = {basis.name: basis for basis in bases.BASES}
    named_transfers = {transfer.__name__.lower(): transfer for transfer in transfers.TRANSFERS}
    words = form.lower().split()
    if len(words) != 2 or words[0] not in named_bases or words[1] not in named_transfers:
        raise ValueError(
            f"'{form}' is no form: write 'BASIS TRANSFER' with one of {', '.join(named_bases)} and "
            f"one of {', '.join(named_transfers)}"
        )
    basis, transfer = named_bases[words[0]], named_transfers[words[1]]
    for _, fault in moment(SimpleNamespace(basis_class=basis, transfer_class=transfer)):
        raise ValueError(f"'{form}' does not work: {fault}")
    return basis, transfer


def block(dim, count, form, room=1):
    """x, v, V0, cells: about `count` random points in a block in the middle of the unit box; for
    hat functions a jittered lattice, since random points leave nodes of almost no mass.

    The box has `room` times as many cells along each axis, and the block as many as before."""
    rng = np.random.default_rng(0)
    side = max(1, round((count / 2**dim) ** (1 / dim)))
    near = 2 ** int(np.ceil(np.log2(2 * side + 8)))
    cells = room * near
    corner = (cells - side) // 2
    if form.startswith("linear"):
        lattice = np.indices((2 * side,) * dim).reshape(dim, -1).T
        x = corner + 0.5 * (lattice + 0.5 + 0.2 * (rng.random(lattice.shape) - 0.5))
    else:
        x = corner + side * rng.random((2**dim * side**dim, dim))
    if form.endswith("sorted"):
        first = np.floor(x - 0.5).astype(int)
        x = x[np.lexsort(first.T[::-1])]
    v = np.zeros_like(x)
    v[:, 0] = 0.1 + 2.0 * (x[:, 1] - 0.5 * cells) / near
    return x / cells, v, np.full(len(x), (0.5 / cells) ** dim), cells


def step_length(cells):
    """[s]"""
    return 0.1 / cells / MATERIAL.wave_speed()


def our_solver(dim, count, form, threads=1, room=1, law=None, **options):
    """A solver that has not started, and its step [s]; Taichi runs.  XPIC is that of order 2, a
    blend has 99 % FLIP.  With a `law` of benchmarks/laws.py the block is strained."""
    basis, transfer = pair(form)
    x, v, V0, cells = block(dim, count, form, room)
    walls = tuple(Wall(axis, upper, Separate) for axis in range(dim) for upper in (False, True))
    material, H = MATERIAL, None
    if law is not None:
        material = next(known for known in LAWS if known.type == law)
        noise = np.random.default_rng(1).normal(size=(len(x), dim, dim))
        H = 0.005 * noise - 0.01 * np.eye(dim)
    solver = Solver(
        [BodyPoints(material, x, v, V0, H=H)], (cells,) * dim, 1 / cells, basis, transfer, walls,
        [0.0] * dim, filter_order=2, threads=threads,
        flip_part=FlipPart(0.99 if transfer is transfers.FLIPBlend else 1.0), **options,
    )  # fmt: skip
    return solver, step_length(cells)
