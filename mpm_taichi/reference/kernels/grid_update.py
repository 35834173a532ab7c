"""Stage 3: momentum to velocity, gravity, walls."""

import numpy as np

from .tally import note_cut_node, note_node


def apply_walls(v, i, grid, walls):
    """The rule of each wall acts at its nodes; those behind it are images (kernels/ghosts.py)."""
    for wall in walls:
        i_d = i[wall.axis] - grid.ghost
        n = np.eye(grid.dim)[wall.axis]
        if wall.upper:
            if i_d == grid.cells[wall.axis]:
                v = wall.rule.velocity(v, -n)
        elif i_d == 0:
            v = wall.rule.velocity(v, n)
    return v


def grid_update(grid, walls, gravity, dt, tally=None):
    """v_i = ((m v)_i + impulse_i) / m_i + dt g, then the rules of the walls, which hold for
    v_i^old = (m v)_i / m_i too: the velocity that a wall takes is no change of the motion.

    A node no heavier than the cut-off stands still and is counted; a `tally` has noted the
    energies."""
    for i in np.ndindex(grid.shape):
        if grid.m[i] > grid.mass_cutoff:
            v_old = grid.mv[i] / grid.m[i]
            v = v_old + dt * gravity + grid.impulse[i] / grid.m[i]
            grid.v[i] = apply_walls(v, i, grid, walls)
            grid.v_old[i] = apply_walls(v_old, i, grid, walls)
            if tally:
                given = grid.given[i] / grid.m[i]
                held = apply_walls(given, i, grid, walls)
                note_node(grid.m[i], given, held, grid.v[i], tally)
        elif grid.m[i] > 0:
            grid.cut += 1
            if tally:
                note_cut_node(i, grid, gravity, dt, tally)
