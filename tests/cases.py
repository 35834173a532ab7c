"""Every pair of basis and transfer that works together.

CASES has every kind of basis and of transfer in 2D, and the first methods in 3D.  ALL_CASES, for
the parity with the twin, has every basis and every transfer in 2D, every kind of both in 3D, and
all pairs in a campaign.  The methods of the first scenes and one of each kind, in 2D, are in the
fast tier."""

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
OTHERS = {
    2: [(CubicBSpline, PIC), (QuadraticBoundary, FLIPBlend)],
    3: [(Linear, XPIC), (GIMP, APIC), (CubicBSpline, TPIC)],
}
"""With the first and the kinds in 2D, and with the first in 3D, each basis and each transfer."""
PAIRS = [(basis, transfer) for basis in BASES for transfer in TRANSFERS if works(basis, transfer)]


def _case(dim, basis, transfer, *marks):
    pair = (basis, transfer)
    if dim == 3 or pair not in [*FIRST, *KINDS]:
        marks = (pytest.mark.slow, *marks)
    return pytest.param(
        dim, basis, transfer, id=f"{dim}D-{basis.name}-{transfer.__name__}", marks=marks
    )


CASES = [
    *(_case(2, *pair) for pair in (*FIRST, *KINDS)),
    *(
        _case(2, *pair, pytest.mark.campaign)
        for pair in ((CubicBSpline, TPIC), (QuadraticBoundary, TPIC))
    ),
    *(_case(3, *pair) for pair in FIRST),
]
COVER = {2: [*FIRST, *KINDS, *OTHERS[2]], 3: [*FIRST, *OTHERS[3]]}
ALL_CASES = [
    _case(dim, *pair, *([] if pair in COVER[dim] else [pytest.mark.campaign]))
    for dim in (2, 3)
    for pair in PAIRS
]
"""(dim, basis, transfer), for `pytest.mark.parametrize`."""
