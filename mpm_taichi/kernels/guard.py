"""Looks for particles whose numbers are none, or no longer those of matter."""

import numpy as np
import taichi as ti

from ..materials.invariants import volume_strain
from ..runtime import Template
from ..stages import stage

HUGE = 1e15
"""An entry of H = F - I beyond this is no deformation."""

PARTING = 0.6
"""Of the distance at which two particles share no node: from there on a bar may bear less than its
law says (hard_cases.md, H12)."""

SPARSE, STRETCHED = 0.8, 1.1
"""Cells: a lattice so stretched that neighbors are further apart is on its way to one particle per
cell, where tension makes it unstable whatever the basis (benchmarks/lattice_stability.py)."""


@ti.func
def size(x, bits: Template):
    """Of a number: its bits without the sign grow with |x|, and what is no number is larger than
    all others.  Fast-math takes x != x for false, but leaves integers alone."""
    all_but_the_sign = bits(ti.static(2**63 - 1 if bits == ti.u64 else 2**31 - 1))
    return ti.bit_cast(x, bits) & all_but_the_sign


@ti.func
def is_bad(p, particles: Template, law: Template, largest, huge, bits: Template):
    worst = size(particles.x[p][0], bits)
    for d in ti.static(range(1, particles.dim)):
        worst = ti.max(worst, size(particles.x[p][d], bits))
    for row in ti.static(range(particles.layout.count)):
        for lane in ti.static(range(4)):
            worst = ti.max(worst, size(particles.rows[p, row][lane], bits))
    H, deformed = particles.H[p], size(huge, bits)
    for i, j in ti.static(ti.ndrange(particles.dim, particles.dim)):
        deformed = ti.max(deformed, size(H[i, j], bits))
    bad = worst > size(largest, bits) or deformed > size(huge, bits)
    if ti.static(not law.kind.invertible):
        bad = bad or not (1.0 + volume_strain(H) > 0.0)
    return bad


@ti.func
def is_parting(p, particles: Template, limit):
    """Whether neighbors, V0^(1/dim) apart when undeformed, are by F_ij further apart than `limit`
    [m] along some axis."""
    H, most = particles.H[p], 0.0
    for i, j in ti.static(ti.ndrange(particles.dim, particles.dim)):
        most = ti.max(most, ti.abs(H[i, j] + ti.static(float(i == j))))
    dim = ti.static(particles.dim)
    return most > STRETCHED and particles.V0[p] * most**dim > limit**dim


@ti.kernel
def look(
    particles: Template, law: Template, begin: int, end: int, largest: float, huge: float,
    limit: float, bits: Template,
):  # fmt: skip
    for p in range(begin, end):
        if is_bad(p, particles, law, largest, huge, bits):
            ti.atomic_min(particles.bad[None], particles.id[p])
        if is_parting(p, particles, limit):
            ti.atomic_add(particles.parting[None], 1)


@stage
def guard(particles):
    """On return `particles.bad` is the least id of a particle with a number that is none, a
    deformation beyond `HUGE`, or, under a law that is not made for it, det F <= 0; or the number of
    particles.  `particles.parting` counts those that what is stored elastically has stretched so
    far that they may soon lose their neighbors (numerics.md, chapter 3, row 4)."""
    particles.bad[None], particles.parting[None] = particles.count, 0
    limit = min(PARTING * particles.reach, SPARSE) * particles.dx
    bits = ti.u64 if particles.dtype == np.float64 else ti.u32
    largest = float(np.finfo(particles.dtype).max)
    for group in particles.groups:
        look(particles, group.law, group.begin, group.end, largest, HUGE, limit, bits)
