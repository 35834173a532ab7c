"""Stages 2b and 3b: nodes behind a wall are mirror images, and a periodic axis closes on itself.

v_n(-k) = - v_n(k) and v_t(-k) = +- v_t(k), + where the rule lets material slide; a wall that lets
go reflects only where its node is pressed on it."""

import numpy as np


def reflected(value, grid, wall):
    """The mirror image of a vector (masses are as they are) behind a wall."""
    signs = [-1.0 if d == wall.axis or wall.rule.holds else 1.0 for d in range(grid.dim)]
    return value * signs if value.ndim else value


def is_pressed(i, grid, wall, gravity, dt, updated):
    """Whether the wall node i moves into the wall, or stands: before the grid update judged by its
    momentum and impulses, after it by its velocity."""
    momentum = grid.mv[i] + grid.impulse[i] + dt * gravity * grid.m[i]
    across = (grid.v[i] if updated else momentum)[wall.axis]
    return across >= 0 if wall.upper else across <= 0


def exchange(ghost, image, grid, wall, fill, records):
    """Between a ghost node and its image: fill the ghost, or give what it has to the image."""
    for field in records:
        value = field[image if fill else ghost]
        value = value if wall is None else reflected(value, grid, wall)
        if fill:
            field[ghost] = value
        else:
            field[image] += value
            field[ghost] = 0.0


def exchange_along(line, axis, grid, walls, gravity, dt, updated, fill, records):
    """All ghost nodes of a line along an axis: `line` is its multi-index, without meaning there."""
    cells, ghosts = grid.cells[axis], grid.ghost

    def node(k):
        return (*line[:axis], k, *line[axis + 1 :])

    if axis in grid.periodic:
        for k in range(grid.shape[axis]):
            if k < ghosts or k >= ghosts + cells:
                image = (k - ghosts) % cells + ghosts
                exchange(node(k), node(image), grid, None, fill, records)
    for wall in (wall for wall in walls if wall.axis == axis):
        at_wall = ghosts + cells * wall.upper
        outward = 1 if wall.upper else -1
        if not wall.rule.lets_go or is_pressed(node(at_wall), grid, wall, gravity, dt, updated):
            for k in range(1, ghosts):
                ghost, image = at_wall + k * outward, at_wall - k * outward
                exchange(node(ghost), node(image), grid, wall, fill, records)


def exchange_all(grid, walls, gravity, dt, updated, fill, records):
    for axis in grid.folded:
        for line in np.ndindex(*grid.shape[:axis], 1, *grid.shape[axis + 1 :]):
            exchange_along(line, axis, grid, walls, gravity, dt, updated, fill, records)


def fold_ghosts(grid, walls, gravity, dt, updated=False):
    """On return ghost nodes are empty, and what they had been given is with their images: mass,
    momentum and impulse before the grid update, after it (`updated`) the residual."""
    records = (grid.residual,) if updated else (grid.m, grid.mv, grid.impulse, grid.given)
    exchange_all(grid, walls, gravity, dt, updated, False, records)


def fill_ghosts(grid, walls, gravity):
    """After the grid update.  On return ghost nodes are images of the nodes inside."""
    records = (grid.m, grid.v, grid.v_old, grid.residual)
    exchange_all(grid, walls, gravity, 0.0, True, True, records)
