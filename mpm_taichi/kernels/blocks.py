"""Fixed blocks of particles or nodes, and the share of each worker.

LLVM unrolls the body of a short loop and, under fast-math, may round its remainder otherwise.  A
plain parallel loop has one chunk per thread, so its bytes depend on the number of threads; blocks
of a fixed size do not.  Taichi gives each thread at least 512 iterations, so a stage starts one
worker per thread by a loop over 512 * threads counters of which every 512th works (the gate)."""

import taichi as ti

BLOCK = 512


@ti.func
def first_block(worker: int, threads: int, count: int) -> int:
    """First block of a worker, which is also the end of the worker before."""
    return worker * ((count + BLOCK - 1) // BLOCK) // threads
