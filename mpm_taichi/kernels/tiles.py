"""How the scatter is shared without atomics: by tiles, of which those of one color share no node.

A tile is a slab of planes along axis 0; of many particles in 3D, a strip of it along axis 1.  Its
color is the parity of both.  Colors are taken one after the other, so that the order in which a
node adds up does not depend on the number of threads.

Strips take 4 launches for 2, and P2G 5 % more time on one thread (15 % in 2D, where they are no
use).  But a cube of a million particles lies in 13 slabs, 6 or 7 of one color, and P2G ends when
the thread with the most of them does: on 2, 4, 8 and 16 threads after 1.05, 1.28, 1.28 and 2.56
times the mean; by strips after 1.01, 1.04, 1.08 and 1.27.

The particles of a tile in one plane, a segment, lie side by side in the order of the sort, which is
that of the cells."""

import taichi as ti

from ..runtime import Template

MANY = 50_000
"""Particles from which on two more launches are a small part of a step."""

COLORS = 4


@ti.func
def takes(worker, workers, tile, grid: Template):
    """Whether the middle of a tile lies in the worker's share of the particles of its color."""
    # In f32 the share of the last tile may round up to 1.
    return ti.min(int(grid.share[tile] * workers), workers - 1) == worker


@ti.func
def segment_of(base, grid: Template):
    """Where a particle lies whose stencil begins at a node; some segment if that is nowhere."""
    segment = base[0] * grid.strips + base[1] // grid.strip
    return ti.min(ti.max(segment, 0), grid.segments - 1)


@ti.func
def particles_in(segment, particles: Template, grid: Template):
    """In all segments of the tile that begins with this one."""
    count = 0
    for plane in range(grid.slab):
        s = segment + plane * grid.strips
        for g in range(particles.group_count):
            count += grid.start[g, s + 1] - grid.start[g, s]
    return count


@ti.func
def list_tiles(particles: Template, grid: Template):
    """From `start`: the first segment of each tile with particles, by color, and where its middle
    lies among all particles of the color, 0 ... 1."""
    listed = 0
    for color in range(COLORS):
        grid.tile_begin[color] = listed
        before = 0
        for pair, half in ti.ndrange(grid.slabs // 2, (grid.strips + 1) // 2):
            slab, strip = 2 * pair + color % 2, 2 * half + color // 2
            if strip < grid.strips:
                segment = slab * grid.slab * grid.strips + strip
                count = particles_in(segment, particles, grid)
                if count > 0:
                    grid.tile[listed] = segment
                    grid.share[listed] = before + 0.5 * count
                    before += count
                    listed += 1
        for tile in range(grid.tile_begin[color], listed):
            grid.share[tile] /= before
    grid.tile_begin[COLORS] = listed
