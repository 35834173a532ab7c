"""The step: the table of contents of the method."""

from collections.abc import Iterator
from math import inf, sqrt
from typing import Any

import numpy as np
import taichi as ti

from .grid import Grid
from .kernels.body_force import push
from .kernels.clear import clear
from .kernels.clock import Clock
from .kernels.fastest import fastest
from .kernels.g2p import g2p
from .kernels.ghosts import fill_ghosts, fold_ghosts
from .kernels.grid_update import grid_update
from .kernels.outside import bring_in
from .kernels.p2g import p2g
from .kernels.residual import take_residual
from .kernels.slivers import slivers
from .kernels.sort import sort, take_up
from .kernels.start_moments import start_moments
from .kernels.stiffness import stiffest
from .kernels.tally import NoTally, note_at_walls, note_start
from .kernels.update_stress import update_stress
from .kernels.whole_steps import Desk, queued_steps, whole_steps
from .kernels.wrap import wrap
from .materials import Material
from .particles import Particles
from .tally import Tally
from .time_step import Motion, Stiffness
from .transfers import FlipPart

FEW = 8192
"""Particles up to which a step on one thread takes less time than the launches of its stages."""


class Solver:
    """Bodies in a box of `cells` cells of edge `dx` [m].

    `walls` lists the sides of the domain that have a rule, `periodic` the axes that close on
    themselves; other sides are open.  Nodes no heavier than `mass_cutoff` times the lightest
    particle are taken as empty.  `stress_update` is usl, musl or usf; `flip_part(dt)` the FLIP part
    of a blend, `filter_order` that of XPIC, `body_force` a field b(X, x, t) [m/s^2] or None.

    With `whole` the device takes several steps by itself (kernels/whole_steps.py): on a CPU those
    of few particles, whatever `threads` is.

    `threads` workers share the work on a CPU, and the result does not depend on it; `atomic` is the
    form for GPUs."""

    def __init__(
        self, bodies, cells, dx, basis, transfer, walls, gravity, mass_cutoff=None, periodic=(),
        stress_update="usl", flip_part=None, filter_order=1, body_force=None,
        audited=False, whole=False, threads=1, atomic=False,
    ):  # fmt: skip
        self.basis, self.transfer, self.walls = basis, transfer, walls
        self.stress_update, self.body_force = stress_update, body_force
        self.flip_part, self.filter_order = flip_part or FlipPart(), filter_order
        self.particles = Particles(
            bodies, basis, transfer, dx, keeps_pic=stress_update == "musl", body_force=body_force,
            audited=audited,
        )  # fmt: skip
        self.grid = Grid(
            cells, dx, basis, self.particles.group_count, self.particles.count, transfer.increment,
            self._mass_cutoff(mass_cutoff, bodies, cells), walls, periodic, threads, atomic,
            audited,
        )  # fmt: skip
        self.gravity = ti.Vector.field(self.particles.dim, float, ())
        self.gravity[None] = list(gravity)
        if transfer.moments and not basis.inverse_moment:
            start_moments(self.particles, self.grid, basis)
        self.tally: Any = NoTally
        if audited:
            self.tally = Tally(
                self.grid,
                walls,
                self.particles.count,
                self.particles.group_count,
                transfer,
                gravity,
                body_force is not None,
            )  # fmt: skip
        suits = stress_update == "usl" and not transfer.filtered
        self.is_whole = whole and suits and (atomic or self.particles.count <= FEW)
        self.desk = Desk(self.flip_part) if self.is_whole and atomic else None
        self.motion = Motion()  # of the last step
        self.drift = inf  # bound of the cells that a particle has moved since the sort
        self.sorts = 0

    def _mass_cutoff(self, part, bodies, cells):
        """`part` of the lightest particle's mass [kg].  Not given: 0 for smooth bases.  Hat
        functions have gradients that stay where the weight goes to 0, so a weight of the size of
        the rounding error of x / dx would take a full force; so do modified splines, but only where
        a wall bends them.  Under MUSL and USF the speed that the force gives strains nothing, and
        particles take as much of it as they weigh there: hat functions have 0 too."""
        if part is None:
            unbent = self.basis.modified and not self.walls
            harmless = self.stress_update != "usl" and not self.basis.modified
            smooth = unbent or harmless or self.basis.steepness(0.25) is not None
            part = 0.0 if smooth else 16 * np.finfo(self.particles.dtype).eps * max(cells)
        lightest = min((body.material.density * body.V0).min() for body in bodies)
        return float(part * lightest)

    def start(self, dt):
        """Write the rows of the first step, of length dt [s]."""
        if self.tally.is_on and not self.transfer.increment:
            note_start(self.particles, self.grid, self.basis, self.transfer, self.tally)
        self.update(0.0, dt)

    def update(self, dt, dt_next, **parts):
        for group in self.particles.groups:
            alpha = self.flip_part(dt)
            update_stress(
                self.particles, group, self.grid, self.transfer, dt, dt_next, alpha,
                tally=self.tally, **parts,
            )  # fmt: skip

    def sort_if_due(self):
        """Slabs leave room for one cell of drift, of which the steps taken tell exactly."""
        if not self.drift < 0.99:
            if self.grid.periodic:
                wrap(self.particles, self.grid)
            sort(self.particles, self.grid, self.basis)
            self.drift = 0.0
            self.sorts += 1

    def step(self, time, dt, dt_next) -> Motion:
        """Advance from `time` by dt [s], the next step being of length dt_next."""
        for _ in self.stages(time, dt, dt_next):
            pass
        return self.motion

    def stages(self, time, dt, dt_next) -> Iterator[str]:
        """The step, with a pause after each of its stages, which it names.

        USL (update stress last) takes the velocity gradient L from the new velocities of the nodes,
        which makes F the gradient of the motion; its impulse is that of the next step.  USF (first)
        takes L from the velocities at the start, MUSL (modified USL) from those of the updated
        particles, mapped to the nodes once more."""
        self.sort_if_due()
        rates = None
        if self.stress_update == "usf":
            self.map_gradient()
            self.update(dt, dt, velocity=False, move=False)
            rates = self.rates()
            yield "stress"
        yield from self.map_motion(time, dt)
        if self.stress_update == "usl":
            self.update(dt, dt_next)
        elif self.stress_update == "usf":
            self.update(dt, dt_next, stress=False)
        else:
            self.update(dt, dt_next, stress=False, move=False)
        yield "nodes to particles"
        if self.stress_update == "musl":
            self.map_gradient()
            self.update(dt, dt_next, velocity=False)
            yield "stress"
        self.motion = Motion(sqrt(self.grid.speed_squared[None]), *(rates or self.rates()))
        self.drift += dt * self.motion.speed / self.grid.dx

    def rates(self) -> tuple[float, float]:
        """The largest |grad v| and - div v [1/s] that have strained particles since the nodes were
        cleared."""
        return sqrt(self.grid.rate_squared[None]), self.grid.compression[None]

    def take_whole_steps(self, clock: Clock, most: int):
        """Up to `most` steps as `step` would take them, without a return to Python."""
        self.sort_if_due()
        clock.drift = self.drift
        scene = (
            self.particles, self.grid, self.basis, self.transfer, self.walls, self.gravity,
            self.body_force,
        )  # fmt: skip
        if self.grid.atomic:
            queued_steps(*scene, self.desk, clock, most)
        else:
            whole_steps(*scene, self.flip_part, clock, most, self.tally)
        self.drift = clock.drift

    @property
    def stored(self) -> dict[str, Any]:
        """The fields that a checkpoint keeps, by name."""
        return self.particles.stored | self.grid.stored | self.tally.stored

    def state(self) -> dict[str, Any]:
        """The numbers that belong to them."""
        return {"drift": self.drift, "sorts": self.sorts, "tally_start": list(self.tally.start)}

    def restore(self, state: dict[str, Any], arrays) -> None:
        """Go on from fields and numbers of before: on a CPU as if never interrupted, to the last
        bit."""
        for name, field in self.stored.items():
            field.from_numpy(arrays[name])
        self.drift, self.sorts = state["drift"], state["sorts"]
        self.tally.start = state["tally_start"]
        self.particles.lost[None] = self.particles.count
        if self.sorts:
            take_up(self.particles, self.grid)

    def bring_in(self, deletes, lightest):
        """Particles outside the domain: see kernels/outside.py."""
        bring_in(self.particles, self.grid, deletes, lightest)
        if deletes:
            self.drift = inf  # they are far from where the sort has found them

    def stiffness(self) -> dict[Material, Stiffness]:
        """Of each material now."""
        return {
            group.material: Stiffness(*stiffest(self.particles, group, self.grid))
            for group in self.particles.groups
        }

    def named_motion(self, dt) -> Motion:
        """Of the step of dt [s] that has just been taken, with the particles that are fastest."""
        speed, fastest_one, rate, steepest_one = fastest(
            self.particles, self.grid, self.basis, self.transfer, dt
        )
        if self.stress_update == "usf":  # the nodes have been pushed since they strained
            return self.motion._replace(fastest=fastest_one, steepest=steepest_one)
        return Motion(
            sqrt(speed), sqrt(rate), self.grid.compression[None], fastest_one, steepest_one
        )

    def slivers(self, dt) -> int:
        """How many nodes are too light for the next step, of dt [s], under USL."""
        self.sort_if_due()
        return slivers(
            self.particles, self.grid, self.basis, self.transfer, self.walls, self.gravity, dt
        )

    def map_motion(self, time, dt) -> Iterator[str]:
        """Particles to nodes, the motion of the nodes, and back; a pause where nodes are done."""
        if self.body_force is not None:
            push(self.particles, self.grid, self.body_force, time, dt)
        clear(self.grid)
        p2g(self.particles, self.grid, self.basis, self.transfer)
        self.note_at_walls(dt, "given")
        fold_ghosts(self.grid, self.walls, self.gravity, dt)
        yield "particles to nodes"
        grid_update(self.grid, self.walls, self.gravity, dt, self.tally)
        self.note_at_walls(dt, "kept")
        fill_ghosts(self.grid, self.walls, self.gravity)
        self.note_at_walls(dt, "taken")
        yield "grid update"
        g2p(self.particles, self.grid, self.basis, self.transfer, dt=dt, tally=self.tally)
        if self.transfer.filtered:
            take_residual(
                self.particles, self.grid, self.basis, self.transfer, self.walls, self.gravity,
                self.filter_order,
            )  # fmt: skip

    def map_gradient(self):
        """L of the velocities that particles have now, as the nodes see them."""
        clear(self.grid)
        p2g(self.particles, self.grid, self.basis, self.transfer, "momentum")
        fold_ghosts(self.grid, self.walls, self.gravity, 0.0)
        grid_update(self.grid, self.walls, self.gravity, 0.0)
        fill_ghosts(self.grid, self.walls, self.gravity)
        g2p(self.particles, self.grid, self.basis, self.transfer, "gradient")

    def note_at_walls(self, dt, when):
        if self.tally.has_walls:
            note_at_walls(self.grid, self.gravity, dt, self.flip_part(dt), self.tally, when)
