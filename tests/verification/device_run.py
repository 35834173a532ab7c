"""Short runs on one device, in a process of their own: Taichi aborts where a process changes from
Vulkan to the CPU.

    python -m tests.verification.device_run DEVICE PRECISION OUT.npz
"""

import sys

import numpy as np

from mpm_taichi import runtime
from mpm_taichi.bases import QuadraticBSpline
from mpm_taichi.transfers import FLIP, MLS

from .motions import JELLY, advance, ball_points, solver

CELLS = 12


def run(device, precision, dim, transfer):
    """x and H of a ball in swirling motion after 40 steps."""
    runtime.start(device, precision)
    x, V0 = ball_points(dim, CELLS, 0.3, 0.003)
    v = np.sin(7 * x[:, ::-1])
    mpm = solver(x, v, V0, CELLS, QuadraticBSpline, transfer, atomic=device != "cpu")
    advance(mpm, 0.05 / CELLS / JELLY.wave_speed(), 40)
    return mpm.particles.to_numpy("x"), mpm.particles.to_numpy("H")


def main(device, precision, path):
    results = {}
    for dim, transfer in ((2, FLIP), (3, MLS)):
        x, H = run(device, precision, dim, transfer)
        results |= {f"{dim} {transfer.__name__} x": x, f"{dim} {transfer.__name__} H": H}
    np.savez(path, **results)


if __name__ == "__main__":
    main(*sys.argv[1:])
