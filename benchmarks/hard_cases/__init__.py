"""The suite of hard cases (hard_cases.md): one file for each, in the order in which they run."""

from . import (
    free_flight,
    galilean_pair,
    lone_particle,
    null_space,
    numerical_fracture,
    self_weight,
    sliver,
    spin,
    two_bar_impact,
)
from .case import Case, Draw, Figure, Found

__all__ = ["CASES", "Case", "Draw", "Figure", "Found"]

CASES = {
    module.CASE.name: module.CASE
    for module in (
        free_flight,
        null_space,
        lone_particle,
        sliver,
        spin,
        galilean_pair,
        self_weight,
        two_bar_impact,
        numerical_fracture,
    )
}
