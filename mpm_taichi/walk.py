"""One time step, stage by stage, with what a picture of it needs: 2D.

walk = Walk(Simulation(load_scene("scenes/two_disks.yaml")), particle=7)
stage = walk.advance()
print(stage.name, stage.formula, stage.numbers)"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from .errors import InputError
from .kernels.clear import clear
from .simulation import Simulation
from .snapshot import Snapshot
from .stage_formulas import formulas
from .touched_nodes import TouchedNodes


class Number(NamedTuple):
    """A quantity of the picked particle or of the node nearest to it: one number, a vector [2] or a
    matrix [2, 2]."""

    symbol: str
    value: float | np.ndarray
    unit: str


class Stage(NamedTuple):
    """The step after one of its stages.  n particles in the order of the scene, N nodes that can
    have mass, k of them in the stencil of the picked particle."""

    name: str  # of stage_formulas.stage_names
    formula: tuple[str, ...]  # lines, see stage_formulas.py
    time: float  # s, at the start of the step
    dt: float  # s
    position: np.ndarray  # [n, 2] m, now
    position_before: np.ndarray  # [n, 2] m, at the start of the step
    velocity: np.ndarray  # [n, 2] m/s, now
    node_position: np.ndarray  # [N, 2] m; ghost nodes lie outside of the domain
    node_mass: np.ndarray  # [N] kg; that of ghost nodes is with their images behind the wall
    node_velocity_before: np.ndarray  # [N, 2] m/s, before the grid update
    node_velocity: np.ndarray  # [N, 2] m/s, now
    moved_node: np.ndarray  # [N, 2] m, x_i + dt v_i once nodes have been updated
    particle: int  # the picked one
    nodes: np.ndarray  # [k] of its stencil, among the N
    weights: np.ndarray  # [k]
    gradients: np.ndarray  # [k, 2] 1/m
    numbers: tuple[Number, ...]


class Walk:
    """Leads a simulation through its steps one stage at a time, in the kernels of the step itself:
    after the last stage, the reset of the nodes, it stands where `Simulation.step` would have
    brought it.  Until then nothing else may advance it.

    `particle`, the picked one by its place in the scene, may change at any time."""

    def __init__(self, simulation: Simulation, particle: int = 0):
        if simulation.scene.dimension != 2:
            raise InputError("a step is shown stage by stage in 2D only")
        self.simulation, self.particle = simulation, particle
        self._stages: Iterator[str] | None = None
        self._name = ""

    @property
    def is_amid_step(self) -> bool:
        return self.simulation.is_amid_step

    def advance(self) -> Stage:
        """Take the next stage.  MotionError as of `Simulation.step`."""
        solver = self.simulation.solver
        if self._stages is None:
            self._before, self._dt = self.simulation.snapshot, self.simulation.dt
            self._stages = self.simulation.stages()
            self._name = next(self._stages)
            self._nodes = TouchedNodes(solver)
        else:
            self._name = next(self._stages, "reset")
        if self._name == "reset":
            self._stages = None
            clear(solver.grid)
        self._nodes.read(self._name)
        return self.stage

    def finish(self) -> None:
        """Take the stages that are left of a step that has begun."""
        while self.is_amid_step:
            self.advance()

    @property
    def stage(self) -> Stage:
        """Where the walk stands after `advance`, for the particle that is picked now."""
        nodes, now = self._nodes, self.simulation.snapshot
        stencil, w, dw = nodes.stencil(self.particle)
        return Stage(
            name=self._name,
            formula=formulas(self.simulation.scene, self._name),
            time=self._before.time,
            dt=self._dt,
            position=now.position,
            position_before=self._before.position,
            velocity=now.velocity,
            node_position=nodes.position,
            node_mass=nodes.mass,
            node_velocity_before=nodes.velocity_before,
            node_velocity=nodes.velocity,
            moved_node=nodes.position + nodes.is_moved * self._dt * nodes.velocity,
            particle=self.particle,
            nodes=stencil,
            weights=w,
            gradients=dw,
            numbers=tuple(self._numbers(now, stencil, w, dw)),
        )

    def _numbers(self, now: Snapshot, stencil, w, dw) -> Iterator[Number]:
        p, nodes = self.particle, self._nodes
        yield Number("m_p", float(now.mass[p]), "kg")
        yield Number("x_p", now.position[p], "m")
        yield Number("v_p", now.velocity[p], "m/s")
        if any(line.startswith("L_p") for line in formulas(self.simulation.scene, self._name)):
            yield Number("L_p", self._velocity_gradient(nodes.velocity[stencil], w, dw), "1/s")
        yield Number("F_p", now.deformation_gradient[p], "-")
        yield Number("sigma_p", now.cauchy_stress[p, :2, :2], "Pa")
        nearest = int(w.argmax())
        i = stencil[nearest]
        yield Number("w_ip", float(w[nearest]), "-")
        yield Number("x_i", nodes.position[i], "m")
        yield Number("m_i", float(nodes.mass[i]), "kg")
        yield Number("v_i", nodes.velocity[i], "m/s")

    def _velocity_gradient(self, v, w, dw) -> np.ndarray:
        """Of the velocities v [k, 2] that the nodes of the stencil have now."""
        method, nodes = self.simulation.scene.method, self._nodes
        if method.transfer_class.gradient:
            return v.T @ dw
        p, dx = self.particle, self.simulation.scene.cell_size
        r = nodes.position[nodes.stencil(p)[0]] - self._before.position[p]
        return (w[:, None] * v).T @ r * method.basis_class.inverse_moment / dx**2
