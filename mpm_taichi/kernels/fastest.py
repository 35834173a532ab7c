"""For the time step: whose speed and whose velocity gradient are the largest of all particles."""

import numpy as np
import taichi as ti

from ..runtime import Array, Template
from .blocks import first_block
from .g2p import gather
from .rows import vector
from .stencil import index, weigh_at
from .sums import MOST_BLOCKS

SPEED, RATE = range(2)


@ti.func
def motion(p, particles: Template, grid: Template, basis: Template, transfer: Template, dt):
    """|sum_i w_i v_i|^2 and |L|^2, gathered once more where the particle was before it moved."""
    dim = ti.static(grid.dim)
    g, zero = grid.constants[None], ti.Vector.zero(float, 4)
    v_pic = vector(particles.rows, p, particles.layout.pic, dim)
    if ti.static(not particles.layout.pic):
        v_pic /= particles.m[p]
    base, a, w, dw = weigh_at(particles.x[p] - dt * v_pic, p, particles, grid, basis)
    v = zero
    moments = [zero for row in particles.layout.moments]
    slopes = [zero for row in particles.layout.gradient]
    gather(index(grid, base), 0, grid, w, dw, v, moments, slopes)
    B, L = ti.Matrix.zero(float, dim, dim), ti.Matrix.zero(float, dim, dim)
    for d in ti.static(range(len(moments))):
        for e in ti.static(range(dim)):
            B[e, d] = (moments[d][e] - a[d] * v[e]) * g.dx
    for d in ti.static(range(len(slopes))):
        for e in ti.static(range(dim)):
            L[e, d] = slopes[d][e] * g.inv_dx
    _C, L_of = transfer.gradients(B, L, g.inverse_moment)
    return v_pic.norm_sqr(), L_of.norm_sqr()


@ti.func
def find_share(
    particles: Template, grid: Template, basis: Template, transfer: Template, dt, size,
    largest: Template, places: Template, worker, workers,
):  # fmt: skip
    blocks = largest.shape[0]
    for block in range(
        first_block(worker, workers, blocks), first_block(worker + 1, workers, blocks)
    ):
        first = block * size
        speed_most, speed_place, rate_most, rate_place = -1.0, first, -1.0, first
        for p in range(first, ti.min(first + size, particles.count)):
            speed, rate = motion(p, particles, grid, basis, transfer, dt)
            if speed > speed_most:
                speed_most, speed_place = speed, p
            if rate > rate_most:
                rate_most, rate_place = rate, p
        largest[block, SPEED], places[block, SPEED] = speed_most, particles.id[speed_place]
        largest[block, RATE], places[block, RATE] = rate_most, particles.id[rate_place]


@ti.kernel
def find(
    particles: Template, grid: Template, basis: Template, transfer: Template, dt: float, size: int,
    largest: Array, places: Array, workers: int,
):  # fmt: skip
    for counter in range(grid.gate * workers):
        if counter % grid.gate == 0:
            find_share(
                particles, grid, basis, transfer, dt, size, largest, places, counter // grid.gate,
                workers,
            )  # fmt: skip


def fastest(particles, grid, basis, transfer, dt) -> tuple[float, int, float, int]:
    """The largest |sum_i w_ip v_i|^2 [m^2/s^2] and whose it is (its place in the scene), and the
    largest |L|^2 [1/s^2] and whose that is, of the step of dt [s] that has just been taken: nodes
    still hold its velocities."""
    size = max(grid.block, -(-particles.count // MOST_BLOCKS["gpu" if grid.atomic else "cpu"]))
    blocks = -(-particles.count // size)
    largest = np.zeros((blocks, 2), particles.dtype)
    places = np.zeros((blocks, 2), np.int32)
    workers = grid.workers(blocks)
    find(particles, grid, basis, transfer, dt, size, largest, places, workers)
    at = largest.argmax(axis=0)
    speed, rate = ((float(largest[at[k], k]), int(places[at[k], k])) for k in (SPEED, RATE))
    return *speed, *rate
