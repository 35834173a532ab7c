"""For the audit: what walls, gravity and body forces give and what each stage does to the kinetic
energy, added up where it arises."""

import numpy as np

from .stencil import moment, weigh

TURNS = {2: ((0, 1),), 3: ((1, 2), (2, 0), (0, 1))}
"""The plane of each component of an angular momentum."""


def cross(a, b):
    """The components of a x b that the dimension has."""
    return np.array([a[d] * b[e] - a[e] * b[d] for d, e in TURNS[len(a)]])


def note_node(m, given, held, v, tally):
    """A node in the grid update: the velocity it was given, the same after the walls, and v.  In
    an increment the walls take nothing of it from the particles."""
    tally.sums["given"] += (
        0.5 * m * (held if tally.increment else given) @ (held if tally.increment else given)
    )
    tally.sums["held"] += 0.5 * m * held @ held
    tally.sums["end"] += 0.5 * m * v @ v


def note_cut_node(i, grid, gravity, dt, tally):
    """A node that the mass cut-off empties: what its particles do not get back."""
    taken = 0.5 * grid.given[i] @ grid.given[i] / grid.m[i]
    tally.sums["given"] += taken
    tally.sums["cut"] += taken
    kept = grid.given[i] if tally.increment else 0.0
    tally.sums["lost"] += grid.mv[i] + grid.impulse[i] + dt * grid.m[i] * gravity - kept


def affine_energy(p, particles, grid, basis, transfer):
    """Of what was gathered: m tr(C D C^T) / 2, C = B D^-1 or the velocity gradient."""
    if not transfer.affine:
        return 0.0
    _, a, w, _ = weigh(p, particles, grid, basis)
    D = moment(w, a) * grid.dx**2
    if transfer.moments:
        D = D if not basis.inverse_moment else 1 / grid.inverse_moment
        return 0.5 * particles.m[p] * (particles.B[p] ** 2 / D).sum()
    return 0.5 * particles.m[p] * (particles.S[p] ** 2 * D).sum()


def kinetic_energy(particles, grid, basis, transfer):
    """Of what was gathered, with that of the affine motion."""
    return sum(
        0.5 * particles.m[p] * particles.v_pic[p] @ particles.v_pic[p]
        + affine_energy(p, particles, grid, basis, transfer)
        for p in range(particles.count)
    )


def note_particles(particles, grid, basis, transfer, dt, tally):
    """After the gather."""
    m, sums = particles.m[:, None], tally.sums
    if not tally.increment:
        sums["kinetic"][0] = kinetic_energy(particles, grid, basis, transfer)
        sums["kinetics"] += sums["kinetic"]
    if tally.falls:
        sums["path"] += dt * (m * particles.v_pic).sum(axis=0)
        sums["moment"] += dt * (m * particles.x).sum(axis=0)
    if tally.force:
        sums["push"] += particles.force.sum(axis=0)
        for x, f in zip(particles.x, particles.force, strict=True):
            sums["twist"] += cross(x, f)
        sums["pushing"] += (particles.force * particles.v_pic).sum()


def note_stress(p, L, V0_tau, dt, particles, tally):
    """The work of the stress in a step, V0 / 2 (tau_old : dt L + tau : dt L (I + dt L)^-1), which
    is that of P along the straight way from F to (I + dt L) F, by the trapezoidal rule."""
    if dt > 0:
        inverse = np.linalg.inv(np.eye(len(L)) + dt * L)
        old, new = particles.V0_tau[p], V0_tau @ inverse.T
        tally.sums["work"] += 0.5 * dt * ((old + new) * L).sum()
    particles.V0_tau[p] = V0_tau


def can_act(i, grid, walls):
    """Whether a wall can act at node i: at its own, and along folded axes at ghost nodes and their
    images."""
    return any(
        abs(i[wall.axis] - grid.ghost - grid.cells[wall.axis] * wall.upper)
        <= (grid.ghost - 1 if wall.axis in grid.folded else 0)
        for wall in walls
    )


def note_at_walls(grid, gravity, dt, alpha, tally, when):
    """At the nodes where a wall can act, of a step of length dt [s] with the FLIP part alpha:
    before the fold what particles have `given`, after the grid update the energy that nodes have
    `kept`, and after the fill what particles have `taken` back."""
    part = alpha if tally.increment else 0.0
    for i in np.ndindex(grid.shape):
        if not can_act(i, grid, tally.walls):
            continue
        m, v = grid.m[i], grid.v[i]
        change = np.zeros(grid.dim)
        if when == "given":
            tally.wall_mass[i] = m
            change = (part - 1) * grid.mv[i] - grid.impulse[i]
        elif when == "taken":
            m = tally.wall_mass[i]
            change = m * (v - part * grid.v_old[i] - dt * gravity)
        if tally.lets_go and when != "given":
            tally.sums["images"] += (1 if when == "taken" else -1) * 0.5 * m * v @ v
        tally.sums["impulse"] += change
        tally.sums["turn"] += cross((np.array(i) - grid.ghost) * grid.dx, change)


def note_start(particles, grid, basis, transfer, tally):
    """The kinetic energy of the particles before the first step, whose values are as after a
    gather; of transfers without increment."""
    tally.sums["kinetic"][0] = kinetic_energy(particles, grid, basis, transfer)
