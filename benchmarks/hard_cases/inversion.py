"""H14: matter turned inside out, F0 = diag(-0.2, 1); and a block struck at half its wave speed.

Under a law that answers to it (fixed corotated) the block relaxes to J > 0 and its energy falls;
under one of ln J (neo-Hookean) the run stops and names the particle.  A plate eight times as dense
that strikes a block of either law at 0.5 c is followed to the end, or the run stops and names a
particle.  Never a number that is none (hard_cases.md, H14, expected).

F <- (I + dt L) F keeps the sign of det F where det(I + dt L) > 0, which the deformation limit of
the step ensures: J can come to 0 from below, not pass."""

import numpy as np
from experiments import schemes

from mpm_taichi.errors import InputError, MotionError

from .case import Case, Draw, Figure, Found
from .scenes import body, clamps, energies, simulate, solid, vector

CELLS, INVERTED = 20, -0.2


def measure(scheme, draw: Draw) -> Found:
    shift = draw.offsets(1, 2)[0]
    neo_hookean = solid() | {"type": "neo_hookean"}
    figures, counts = relaxed(scheme, shift)
    named = stops(lambda: finish(inverted(scheme, shift, neo_hookean)))
    figures.append(Figure("ln J: names a particle", named is True, 1, at_least=True))
    for law, material in (("corotated", solid()), ("ln J", neo_hookean)):
        ends = stops(lambda material=material: finish(struck(scheme, shift, material)))
        figures.append(Figure(f"crush, {law}: ends well", ends is not False, 1, at_least=True))
    return Found(figures, counts)


def inverted(scheme, shift, material):
    moved = [f"{INVERTED - 1!r} * (X - {CELLS / 2}) + {float(shift[0])!r}", float(shift[1])]
    block = body("block", [6, 6], [14, 14], 8, displacement=vector(moved))
    return simulate(scheme, [CELLS] * 2, [block], material, 40.0, domain={"outside": "delete"})


def relaxed(scheme, shift):
    simulation = inverted(scheme, shift, solid())
    totals = [sum(energies(simulation)).sum()]
    totals += [sum(energies(now)).sum() for now in simulation.frames()]
    least = simulation.snapshot.volume_ratio.min()
    figures = [
        Figure("least J at the end", least, 0.0, at_least=True),
        Figure("E / E0", max(totals) / totals[0], 1.0),
    ]
    return figures, clamps(simulation)


def struck(scheme, shift, material):
    """It would come to 20 % of its height, and further, without a stress."""
    plate = {**material, "density": 8, "youngs_modulus": 8 * material["youngs_modulus"]}
    bodies = [
        body("block", [6, 0], [14, 8], displacement=vector([shift[0], 0])),
        body("plate", [6, 10], [14, 12], displacement=vector([shift[0], 0]),
             velocity=vector([0, -0.5])) | {"material": "plate"},
    ]  # fmt: skip
    return simulate(
        scheme, [CELLS] * 2, bodies, material, 20.0, materials={"plate": plate},
        domain={"walls": {"bottom": "slip"}, "outside": "delete"},
    )  # fmt: skip


def finish(simulation):
    for now in simulation.frames():
        assert np.isfinite(now.snapshot.position).all()


def stops(run) -> bool | None:
    """Whether a run stops with the name of a particle; None if it does not stop."""
    try:
        run()
    except (MotionError, InputError) as error:
        return "particle" in str(error)
    return None


CASE = Case(
    "H14", "Inversion", measure,
    schemes("linear: flip; gimp: flip; quadratic: flip, apic, mls; cubic: mls"),
    schemes("quadratic: mls"), clamps=True,
)  # fmt: skip
