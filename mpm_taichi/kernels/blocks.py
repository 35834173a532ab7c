"""How the work of a stage is shared: fixed blocks of particles or nodes, and who takes which.

LLVM unrolls the body of a short loop and, under fast-math, may round its remainder otherwise.  A
plain parallel loop has one chunk per thread, so its bytes depend on the number of threads; blocks
of a fixed size do not.  Taichi gives each thread at least 512 iterations, so on a CPU a stage
starts one worker per thread by a loop over 512 * threads counters of which every 512th works (the
gate).  On a GPU gate and block are 1: each particle or node has a worker of its own.

The other way round, chunks that Taichi hands out to threads as they come free
(make_cpu_multithreading_loop=False), costs as much CPU time in 3D on two threads: 136 to 138 ns per
particle-step for 141, and 67 to 70 for 61 in the sort.  It is a switch for all loops of a process,
and not in the key of Taichi's cache.

Nodes are taken by chunks: `grid.active` lists those that particles can reach (kernels/sort.py)."""

import taichi as ti

from ..runtime import Template

GATE = 512
BLOCK = 512  # particles
CHUNK = 32  # nodes, side by side along the last axis


@ti.func
def first_block(worker, workers, blocks):
    """First block of a worker, which is also the end of the worker before."""
    return worker * (blocks // workers) + ti.min(worker, blocks % workers)


@ti.func
def blocks_of(count, size: Template):
    return (count + size - 1) // size


@ti.func
def active_blocks(grid: Template):
    """Number of blocks of active nodes."""
    return grid.active_count[None] * (CHUNK // grid.node_block)


@ti.func
def first_active_node(block, grid: Template):
    """First node of a block of active nodes."""
    return grid.active[block * grid.node_block // CHUNK] * CHUNK + block * grid.node_block % CHUNK
