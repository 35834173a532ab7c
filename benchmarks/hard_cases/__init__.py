"""The suite of hard cases (hard_cases.md): one file for each, in the order in which they run."""

from . import (
    dense_on_light,
    drops,
    fluid_at_rest,
    free_flight,
    galilean_pair,
    gas_shock,
    inversion,
    lone_particle,
    long_rest,
    null_space,
    slope,
    spin,
)
from .case import Case, Draw, Figure, Found

__all__ = ["CASES", "Case", "Draw", "Figure", "Found"]

CASES = {
    module.CASE.name: module.CASE
    for module in (
        free_flight,
        null_space,
        lone_particle,
        spin,
        galilean_pair,
        inversion,
        dense_on_light,
        fluid_at_rest,
        drops,
        gas_shock,
        slope,
        long_rest,
    )
}
