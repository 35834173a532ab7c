"""The nodes that particles touch in one step, and what lies there after each stage."""

from itertools import product

import numpy as np

from .kernels.blocks import CHUNK
from .kernels.weights import weights


class TouchedNodes:
    """At the first pause of a step, before particles move: the N nodes, and the stencil of each
    particle among them.  `position` [N, dim] (m), of ghost nodes outside of the domain.

    `read` takes from the grid what a stage has left there: `mass` [N] (kg), that of ghost nodes
    being with their images; `velocity` and, of before the grid update, `velocity_before` [N, dim]
    (m/s); and `is_moved`, whether x_i + dt v_i is where the step would take the nodes."""

    def __init__(self, solver):
        self._grid, dim = solver.grid, solver.grid.dim
        self._base, self._w, self._dw = weights(solver.particles, solver.grid, solver.basis)
        self._offsets = np.array(list(product(range(solver.basis.support), repeat=dim)))
        touched = self._lanes()[..., dim] > 0
        touched[tuple((self._base[:, None] + self._offsets).reshape(-1, dim).T)] = True
        self._places = tuple(np.argwhere(touched).T)
        self._number = np.full(touched.shape, -1)
        self._number[self._places] = np.arange(len(self._places[0]))
        self.position = (np.stack(self._places, axis=1) - self._grid.ghost) * self._grid.dx
        self._forget()

    def _forget(self):
        self.mass, self.is_moved = np.zeros(len(self.position)), False
        self.velocity = self.velocity_before = np.zeros_like(self.position)

    def stencil(self, p: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """The nodes of particle p [k], their weights [k] and weight gradients [k, dim] (1/m)."""
        axes = range(self._grid.dim)
        w = np.stack([self._w[p, self._offsets[:, d], d] for d in axes], axis=1)
        dw = np.stack([self._dw[p, self._offsets[:, d], d] for d in axes], axis=1) / self._grid.dx
        slopes = [np.where(np.arange(len(axes)) == d, dw, w).prod(axis=1) for d in axes]
        nodes = self._number[tuple((self._base[p] + self._offsets).T)]
        return nodes, w.prod(axis=1), np.stack(slopes, axis=1)

    def read(self, stage: str) -> None:
        """What the stage of that name (stage_formulas.py) has left."""
        if stage == "reset":
            self._forget()
            return
        if stage == "nodes to particles":
            return
        lanes = self._lanes()[self._places]
        found, mass = lanes[:, : self._grid.dim], lanes[:, self._grid.dim]
        if stage == "particles to nodes":
            found = np.divide(found, mass[:, None], where=mass[:, None] > 0, out=0 * found)
        self.is_moved = stage == "grid update"
        self.velocity = found
        if not self.mass.any() or stage == "particles to nodes":
            self.mass, self.velocity_before = mass, found

    def _lanes(self) -> np.ndarray:
        """The first record of each node [*shape, 4]; 0 where old values lie, which no particle can
        reach."""
        grid = self._grid
        reached = np.repeat(grid.reached.to_numpy() == 1, CHUNK)[: grid.nodes, None]
        lanes = np.where(reached, grid.node.to_numpy()[: grid.nodes], 0).astype(float)
        return lanes.reshape(*grid.extent, 4)[tuple(map(slice, grid.shape))]
