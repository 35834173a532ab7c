"""Every pair of basis and transfer that works together.

CASES has every basis and every kind of transfer in 2D, the first methods in 3D; ALL_CASES, for the
parity with the twin, every basis and every transfer in 2D and 3D, and all pairs in a campaign.  The
methods of the first scenes and one of each kind in 2D are in the fast tier."""

import pytest

from mpm_taichi.bases import (
    BASES,
    GIMP,
    CubicBoundary,
    CubicBSpline,
    Linear,
    QuadraticBoundary,
    QuadraticBSpline,
)  # fmt: skip
from mpm_taichi.transfers import APIC, FLIP, MLS, PIC, TPIC, TRANSFERS, XPIC, FLIPBlend


def works(basis, transfer):
    """MLS divides by one moment D, APIC by that of each particle, which must not vanish."""
    if transfer is MLS:
        return basis.inverse_moment is not None
    return transfer is not APIC or not basis.moment_vanishes


FIRST = [(Linear, FLIP), (QuadraticBSpline, MLS)]
KINDS = [(QuadraticBSpline, XPIC), (QuadraticBSpline, APIC), (GIMP, TPIC), (CubicBoundary, TPIC)]
LIKE_OTHERS = [
    (QuadraticBSpline, PIC), (QuadraticBSpline, FLIP), (QuadraticBSpline, FLIPBlend),
    (QuadraticBSpline, TPIC), (QuadraticBoundary, TPIC), (CubicBoundary, TPIC), (Linear, TPIC),
]  # fmt: skip
"""In 3D these differ from others of the suite in one part that does not depend on dimension."""
PAIRS = [(basis, transfer) for basis in BASES for transfer in TRANSFERS if works(basis, transfer)]
EACH = [
    (basis, transfer)
    for basis, transfer in PAIRS
    if basis is QuadraticBSpline or transfer is TPIC or (basis, transfer) in FIRST
]


def _case(dim, basis, transfer):
    pair = (basis, transfer)
    marks = []
    if not (pair in FIRST or (dim == 2 and pair in KINDS)):
        marks = [pytest.mark.slow]
    if pair not in EACH or (dim == 3 and pair in LIKE_OTHERS):
        marks.append(pytest.mark.campaign)
    return pytest.param(
        dim, basis, transfer, id=f"{dim}D-{basis.name}-{transfer.__name__}", marks=marks
    )


SOME = [*FIRST, *KINDS, (CubicBSpline, TPIC), (QuadraticBoundary, TPIC)]
CASES = [_case(2, *pair) for pair in SOME] + [_case(3, *pair) for pair in FIRST]
ALL_CASES = [_case(2, *pair) for pair in PAIRS] + [_case(3, *pair) for pair in EACH]
"""(dim, basis, transfer), for `pytest.mark.parametrize`."""
