"""What a reader of the results should know: what was cut off, clamped, deleted or shortened."""

import numpy as np

from .kernels.slivers import EVERY_STEPS

UNEVEN = 0.02
"""Part of the particles that may seem to part because they are large: in a mesh of tetrahedra one
of a hundred is 1.26 times as wide as the mean, among smaller ones."""


def cautions(simulation) -> dict[str, int]:
    """In words, with counts."""
    found = {}
    cut = simulation.solver.grid.cut[None]
    if cut:
        found["nodes below the mass cut-off, taken as empty (counted each step)"] = cut
    if simulation.lookout.slivers:
        cure = "basis: quadratic, or stress_update: musl, has none"
        words = f"nodes too light for the step (looked for every {EVERY_STEPS} steps; {cure})"
        found[words] = simulation.lookout.slivers
    if simulation.lookout.parting > UNEVEN * simulation.ranges[-1]:
        words = (
            "particles stretched so far that they may lose their neighbors (numerical fracture), "
            "most at an output; more particles per cell hold longer"
        )
        found[words] = simulation.lookout.parting
    brought_in = simulation.solver.particles.brought_in[None]
    if brought_in and simulation.scene.domain.outside == "delete":
        gone = simulation.start_mass - float(simulation.body_mass.sum())
        found[f"particles deleted at the border of the domain, {gone:.6g} kg"] = brought_in
    elif brought_in:
        found["times that a particle was clamped to the border of the domain"] = brought_in
    for law in simulation.solver.particles.laws:
        for name, words in law.kind.counters.items():
            count = int(np.nansum(law.state.get_member_field(name).to_numpy(), dtype=float))
            if count:
                found[f"{words} (counted each step)"] = count
    if simulation.time_step.shortened:
        found["steps shorter than time.step, since a limit asked for it"] = (
            simulation.time_step.shortened
        )
    elif simulation.time_step.is_too_long(simulation.limit):
        found[f"steps longer than the {simulation.limit.name} limit"] = simulation.step_count
    return found
