"""The suite of hard cases (hard_cases.md): one file for each, in the order in which they run.

Others of the document are tests by themselves, under tests/:

    H3   order while crossing cells      verification/test_orders.py
    H5   column under gravity            scenes/test_column.py
    H10  superposed rotation             properties/test_materials.py, test_polar.py
    H11  vortex, manufactured motion     scenes/test_vortex.py, test_manufactured.py
    H19  exit, edges, thin domains       faults/test_outside.py, test_thin.py,
                                         properties/test_symmetries.py
    H23  shock tube                      scenes/test_sod.py (the piston is here)
    H24  Taylor bar                      scenes/test_taylor_bar.py
    H25  yield surfaces, dissipation     properties/test_materials.py (the slope is here)
    H26  interruption and damage         faults/test_kill.py, test_resume.py, test_hostile_files.py

H13, H16, H17 and the tilted half of H6 need surface loads, contact and friction."""

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
    numerical_fracture,
    self_weight,
    sliver,
    slope,
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
        inversion,
        dense_on_light,
        fluid_at_rest,
        drops,
        gas_shock,
        slope,
        long_rest,
    )
}
