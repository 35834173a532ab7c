"""At the start: what the host knows, in one kernel, since each takes a while to compile."""

import numpy as np
import taichi as ti

from ..runtime import Array, Template, real_type


def lanes_of(field):
    """The numbers of a field of numbers or vectors, each as a field."""
    if isinstance(field, ti.MatrixField):
        return [field.get_scalar_field(d) for d in range(field.n)]
    return [field]


@ti.kernel
def fill_numbers(lanes: Template, numbers: Array):
    """lanes[n][k] = numbers[k, n], or lanes[n] = numbers[0, n] of a field without a shape."""
    for k in range(numbers.shape[0]):
        for n, lane in ti.static(enumerate(lanes)):
            if ti.static(lane.shape):
                lane[k] = numbers[k, n]
            else:
                lane[None] = numbers[k, n]


def fill(record, values):
    """On return element k of `record`, a struct field, has the numbers and vectors values[k], by
    name."""
    names = list(values[0])
    lanes = [lane for name in names for lane in lanes_of(record.get_member_field(name))]
    numbers = [np.hstack([numbers[name] for name in names]) for numbers in values]
    fill_numbers(tuple(lanes), np.array(numbers, real_type()))


@ti.kernel
def fill_particles(
    particles: Template, first: int, id: int, x: Array, m: Array, V0: Array, rows: Array
):
    """Particles first, first + 1 ... with ids from `id` on: x [n, dim], m and V0 [n], rows
    [n, rows, 4]."""
    for k in range(m.shape[0]):
        p = first + k
        particles.id[p] = id + k
        particles.m[p], particles.V0[p] = m[k], V0[k]
        for d in ti.static(range(particles.dim)):
            particles.x[p][d] = x[k, d]
        for row in range(rows.shape[1]):
            for lane in ti.static(range(4)):
                particles.rows[p, row][lane] = rows[k, row, lane]
