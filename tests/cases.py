"""Every pair of basis and transfer that works together.

CASES has every basis and every transfer in 2D and 3D, ALL_CASES every pair in 2D.  The two methods
of the first scenes and those that are cheap to compile are in the fast tier."""

import pytest

from mpm_taichi.bases import BASES, Linear, QuadraticBSpline
from mpm_taichi.transfers import APIC, FLIP, MLS, TPIC, TRANSFERS


def works(basis, transfer):
    """MLS divides by one moment D, APIC by that of each particle, which must not vanish."""
    if transfer is MLS:
        return basis.inverse_moment is not None
    return transfer is not APIC or not basis.moment_vanishes


FIRST = {(Linear, FLIP), (QuadraticBSpline, MLS)}
PAIRS = [(basis, transfer) for basis in BASES for transfer in TRANSFERS if works(basis, transfer)]
EACH = [
    (basis, transfer)
    for basis, transfer in PAIRS
    if basis is QuadraticBSpline or transfer is TPIC or (basis, transfer) in FIRST
]


def _case(dim, basis, transfer):
    fast = (basis, transfer) in FIRST or (dim == 2 and (basis, transfer) in EACH)
    return pytest.param(
        dim, basis, transfer,
        id=f"{dim}D-{basis.name}-{transfer.__name__}",
        marks=[] if fast else [pytest.mark.slow],
    )  # fmt: skip


CASES = [_case(dim, *pair) for dim in (2, 3) for pair in EACH]
ALL_CASES = [_case(2, *pair) for pair in PAIRS] + [_case(3, *pair) for pair in EACH]
"""(dim, basis, transfer), for `pytest.mark.parametrize`."""
