"""Every pair of basis and transfer that works together, in 2D and 3D.

The two methods of the first scenes and all pairs in 2D are in the fast tier; the other pairs in 3D,
which differ from them in nothing but the compiler's work, are slow."""

import pytest

from mpm_taichi.bases import BASES, Linear, QuadraticBSpline
from mpm_taichi.transfers import FLIP, MLS, TRANSFERS

FIRST = {(Linear, FLIP), (QuadraticBSpline, MLS)}
PAIRS = [
    (basis, transfer)
    for basis in BASES
    for transfer in TRANSFERS
    if basis.inverse_moment is not None or not transfer.affine
]
CASES = [
    pytest.param(
        dim, basis, transfer,
        id=f"{dim}D-{basis.name}-{transfer.__name__}",
        marks=[] if dim == 2 or (basis, transfer) in FIRST else [pytest.mark.slow],
    )
    for dim in (2, 3)
    for basis, transfer in PAIRS
]  # fmt: skip
"""(dim, basis, transfer), for `pytest.mark.parametrize`."""
