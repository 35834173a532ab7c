"""What a particle-step costs at least: two limits of quadratic MLS with a neo-Hookean law.

Memory: the bytes that P2G (with the stress) and G2P must move, sorted, with 2^dim particles per
cell.  Float4 instructions: one particle at a time, a node in one register of four lanes, four
instructions in a cycle.  Both counted by hand; the bandwidth is that of a copy by NumPy on one
thread, read and write."""

import time

import numpy as np

BYTES = {(2, "f32"): 156, (2, "f64"): 312, (3, "f32"): 266, (3, "f64"): 532}
INSTRUCTIONS = {2: 320, 3: 800}
PER_CYCLE = 4

COPIED = 2**28  # bytes


def copy_bandwidth(copied=COPIED, repeats=5) -> float:
    """Bytes read and written in a second of CPU time [GB/s], best of several copies of an array."""
    source, target = np.ones(copied // 8), np.ones(copied // 8)
    best = np.inf
    for _ in range(repeats):
        before = time.process_time()
        np.copyto(target, source)
        best = min(best, time.process_time() - before)
    return 2 * copied / best / 1e9


def memory_limit(dim, precision, bandwidth) -> float:
    """[ns per particle-step]; bandwidth [GB/s]."""
    return BYTES[dim, precision] / bandwidth


def instruction_limit(dim, ghz) -> float:
    """[ns per particle-step]; clock [GHz]."""
    return INSTRUCTIONS[dim] / PER_CYCLE / ghz
