"""Order and verdict from a sequence of grids, each with cells of half the size.

Roache (1998), Verification and Validation in Computational Science and Engineering, 5.6."""

from collections.abc import Sequence
from itertools import pairwise
from math import log2
from typing import NamedTuple

LEAST_ORDER = 0.5
FORMAL_ORDER = 2.0
LARGEST_GCI = 0.05
SAFETY = 1.25
ROUNDING = {"f64": 1e-8, "f32": 1e-4}
"""Relative changes below this are taken as rounding errors, which have no order."""


class Trend(NamedTuple):
    """What a sequence of grids says about one quantity: the observed order at each grid (None where
    the grids up to it do not give one), the relative uncertainty of the finest, and what is wrong,
    if anything."""

    orders: list[float | None]
    uncertainty: float | None
    fault: str | None


def trend_of_errors(errors: Sequence[float | None], rounding: float) -> Trend:
    """Relative errors against an exact solution, coarse to fine; None for a grid that failed.

    p = ln(e_coarse / e_fine) / ln 2.  At fault: an error of the finest grid that is not smaller
    than that of the one before, or an order below 0.5."""
    orders: list[float | None] = [None]
    for coarse, fine in pairwise(errors):
        orders.append(log2(coarse / fine) if coarse and fine else None)
    finest = errors[-1]
    if finest is None:
        return Trend(orders, None, "the finest level failed")
    if finest <= rounding:
        return Trend(orders, finest, None)
    if len(errors) < 2 or errors[-2] is None:
        return Trend(orders, finest, "the level before the finest failed")
    if finest >= errors[-2]:
        return Trend(orders, finest, "the finest level has no smaller error than the one before")
    if orders[-1] is not None and orders[-1] < LEAST_ORDER:
        return Trend(orders, finest, f"order {orders[-1]:.2f} is below {LEAST_ORDER}")
    return Trend(orders, finest, None)


def trend_of_results(results: Sequence[float | None], scale: float, rounding: float) -> Trend:
    """A result of each grid, coarse to fine, where no exact one is known; None where one failed.

    Of three grids f3, f2, f1 the order is p = ln((f3 - f2) / (f2 - f1)) / ln 2, and the grid
    convergence index 1.25 |f2 - f1| / scale / (2^p - 1) bounds the relative error of the finest.
    At fault: differences that change sign or do not shrink, and an index above 5 %."""
    orders: list[float | None] = [None, None]
    for f3, f2, f1 in zip(results, results[1:], results[2:], strict=False):
        orders.append(_order(f3, f2, f1, rounding * scale))
    if len(results) < 3 or None in results[-3:]:
        return Trend(orders, None, "the finest three levels are not all done")
    f3, f2, f1 = (result for result in results[-3:] if result is not None)
    coarse, fine = f2 - f3, f1 - f2
    if max(abs(coarse), abs(fine)) <= rounding * scale:
        return Trend(orders, max(abs(coarse), abs(fine)) / scale, None)
    if coarse * fine < 0:
        return Trend(orders, None, "it goes up and down from level to level")
    if abs(fine) >= abs(coarse):
        return Trend(orders, None, "its changes do not shrink from level to level")
    index = grid_convergence_index(abs(fine) / scale, orders[-1])
    fault = f"the index is above {100 * LARGEST_GCI:g} %" if index > LARGEST_GCI else None
    return Trend(orders, index, fault)


def grid_convergence_index(change: float, order: float | None) -> float:
    """From the relative change between two grids; no order: there is no change.

    An order above 2, that of the method, is luck and counts as 2."""
    return 0.0 if order is None else SAFETY * change / (2 ** min(order, FORMAL_ORDER) - 1)


def _order(f3: float | None, f2: float | None, f1: float | None, least: float) -> float | None:
    if f3 is None or f2 is None or f1 is None:
        return None
    coarse, fine = f2 - f3, f1 - f2
    if coarse * fine <= 0 or max(abs(coarse), abs(fine)) <= least:
        return None
    return log2(coarse / fine)
