"""What each law costs beside neo-Hookean: the same block in shear, strained by half a percent about
a compression of 1 %, so that what can flow does."""

from interleaved import in_turns
from tables import markdown

from mpm_taichi.materials import (
    DruckerPrager,
    FixedCorotated,
    Fluid,
    Gas,
    Hencky,
    Hypoelastic,
    LinearElastic,
    Material,
    NeoHookean,
    Snow,
    VonMises,
)

SOLID = {"density": 1000.0, "youngs_modulus": 1e5, "poissons_ratio": 0.3}
LAWS: list[Material] = [
    NeoHookean(type="neo_hookean", **SOLID),
    LinearElastic(type="linear_elastic", **SOLID),
    Hypoelastic(type="hypoelastic", **SOLID),
    FixedCorotated(type="fixed_corotated", **SOLID),
    Hencky(type="hencky", **SOLID),
    VonMises.model_validate({"type": "von_mises", "yield_stress": 1e3, **SOLID}),
    DruckerPrager.model_validate({"type": "drucker_prager", "friction_angle": 30.0, **SOLID}),
    Snow(
        type="snow", critical_compression=0.015, critical_stretch=0.0025, hardening=10.0,
        largest_hardening=1.5, **SOLID,
    ),
    Fluid(type="fluid", density=1000.0, bulk_modulus=1e5, viscosity=0.1),
    Gas(type="gas", density=1000.0, pressure=1e5),
]  # fmt: skip


def measured(dim, precision, count, form, rounds) -> list[dict]:
    """A row for each law: least CPU time of the stress stage and of a step without its sort
    [ns per particle-step], beside those of the first law in the same turns."""
    specs = [
        {
            "kind": "stages", "dim": dim, "precision": precision, "particles": count,
            "form": form, "threads": 1, "law": law.type,
        }
        for law in LAWS
    ]  # fmt: skip
    rows = []
    for child in in_turns(specs, rounds):
        stages = {
            name: min(ns for turn in child.turns for ns in turn["cpu"][name])
            for name in child.turns[0]["cpu"]
            if name != "sort"
        }
        rows.append({
            "case": f"{dim}D {precision} {form}", "law": child.spec["law"],
            "stress": stages["update_stress"], "step": sum(stages.values()),
            "first_step_cpu": child.about["first_step_cpu"],
            "bytes_per_particle": child.about["bytes_per_particle"],
        })  # fmt: skip
    for row in rows:
        row["of_first"] = row["step"] / rows[0]["step"]
    return rows


def table(rows) -> str:
    """A line for each row of `measured`."""
    head = ["case", "stress", "step", "of neo-Hookean", "B/particle", "CPU to first step"]
    lines = [
        [
            f"{row['case']} {row['law']}", f"{row['stress']:.1f}", f"{row['step']:.1f}",
            f"{row['of_first']:.2f}", f"{row['bytes_per_particle']:.0f}",
            f"{row['first_step_cpu']:.1f} s",
        ]
        for row in rows
    ]  # fmt: skip
    return markdown(head, lines)
