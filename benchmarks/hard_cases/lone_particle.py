"""H7: the longest step of a particle alone, from both sides, under USL.

With M_d = d lam + 2 mu, and H_max and D^-1 those of the basis (hard_cases.md, chapter 1):

    PIC, FLIP  dt <= sqrt(2 rho / (M_d H_max))
    APIC       dt <= sqrt(2 rho / (M_d (H_max - D^-1 / 2)))
    MLS        dt <= sqrt(4 rho / (M_d D^-1)) = 2 / w

At 0.98 of it a small strain stays below 1 / sqrt(1 - 0.98^2) = 5.03 times its start, which an
oscillator reaches, for 1e4 steps; at 1.02 that of the worst place grows tenfold; and an automatic
step is no longer.  Clamping or damping cannot satisfy both sides.  Linear: no limit above zero, and
the automatic step must say so."""

import numpy as np
from experiments import schemes

from mpm_taichi.errors import RunError
from mpm_taichi.reference import bases
from mpm_taichi.scene import Method

from .case import Case, Draw, Figure, Found, U
from .scenes import body, clamps, simulate, solid

SPACING = 8  # cells from one to the next
SIDE = {2: 8, 3: 4}  # particles along an axis
STRAIN = 1e-5
"""The bounds are those of the linear motion, which 0.98 of the limit amplifies by 25 times what the
stiffness changes: at 1e-3 a neo-Hookean particle of MLS reached 5.09 instead of 5.03."""

CHANGE = 100 * STRAIN
"""Of that growth, by the change of stiffness at its largest strain, 5 STRAIN, times 25."""

ROUNDING = 40
"""Units of round-off: four times that of a velocity gradient in a step, some 10, since sums over a
stencil begin at its first node, 1.5 cells away (2.25 beside the moment 1/4).  It adds up as a
random walk, and an oscillator so close to its limit amplifies it by 1 / (1 - 0.98^2) = 25: 0.6 % in
f32."""

STEEPEST = {"gimp": 28 / 3, "quadratic": 6.0, "cubic": 3.14}
INVERSE_MOMENT = {"quadratic": 4.0, "cubic": 3.0}
STEPS = 10_000


def limit(scheme, modulus: float) -> float:
    """[s], for cells of 1 and density 1."""
    H = STEEPEST[scheme.basis]
    if scheme.transfer == "mls":
        return np.sqrt(4 / (modulus * INVERSE_MOMENT[scheme.basis]))
    if scheme.transfer == "apic":
        H -= INVERSE_MOMENT[scheme.basis] / 2
    return np.sqrt(2 / (modulus * H))


def worst_place(scheme) -> float:
    """Where in a cell sum_i (dw_i)^2 / w_i is largest [cells]."""
    twin = getattr(bases, Method.model_validate(scheme.method).basis_class.__name__)
    places = 5 + (np.arange(1000) + 0.5) / 1000
    a = places - twin.first(places)
    w, dw = np.array(twin.weights(a, 0.25)), np.array(twin.slopes(a, 0.25))
    return places[np.argmax((dw**2 / np.where(w > 0, w, 1)).sum(axis=0))] % 1


def measure(scheme, draw: Draw) -> Found:
    """64 particles, half of them at the worst place, for nu = 0.3 and 0.499."""
    figures, counts = [], {}
    dim = draw.dimension
    places = draw.offsets(SIDE[dim] ** dim, dim)
    for nu in (0.3, 0.499):
        found, counts = of_material(scheme, places.copy(), nu)
        figures += [f._replace(name=f"{f.name} (nu {nu:g})") for f in found]
    return Found(figures, counts)


def of_material(scheme, places, nu):
    material, dim = solid(nu), places.shape[1]
    lam, mu = lame(material)
    modulus = dim * lam + 2 * mu
    automatic = alone(scheme, places, material)
    if scheme.basis == "linear":
        told = any("no limit above zero" in line for line in automatic.time_step.describe(1.0))
        return [Figure("says that there is no limit", told, 1, at_least=True)], clamps(automatic)
    places[::2] = worst_place(scheme)
    longest = limit(scheme, modulus)
    figures = [Figure("automatic dt / limit", automatic.dt / longest, 1.0)]
    below = alone(scheme, places, material, 0.98 * longest)
    largest = max(strains(below).max() for _ in below.frames())
    slack = CHANGE + ROUNDING * U[scheme.precision] * np.sqrt(STEPS) / (1 - 0.98**2)
    figures.append(Figure("growth at 0.98", largest, (1 + slack) / np.sqrt(1 - 0.98**2)))
    counts = clamps(below)  # before the next simulation, which ends this one
    above, grown = alone(scheme, places, material, 1.02 * longest), np.zeros(1)
    try:
        for _ in above.frames():
            grown = np.maximum(grown, strains(above)[::2])
            if grown.min() > 10:
                break
    except RunError:
        grown = np.full(1, np.inf)
    figures.append(Figure("growth at 1.02", grown.min(), 10.0, at_least=True))
    return figures, counts


def lame(material) -> tuple[float, float]:
    E, nu = material["youngs_modulus"], material["poissons_ratio"]
    return E * nu / ((1 + nu) * (1 - 2 * nu)), E / (2 * (1 + nu))


def alone(scheme, places, material, dt=None):
    """Each compressed by STRAIN along all axes, at its place in a cell."""
    h, bodies, dim = 0.5, [], places.shape[1]
    rows = [SIDE[dim]] * dim
    for k, place in enumerate(places):
        low = SPACING * np.array(np.unravel_index(k, rows)) + SPACING // 2
        moved = [
            f"{at - h / 2!r} - {STRAIN} * ({axis} - {x + h / 2!r})"
            for at, axis, x in zip(place.tolist(), "XYZ"[:dim], low.tolist(), strict=True)
        ]
        bodies.append(body(k, low, low + h, displacement=moved))
    steps = {} if dt is None else {"step": float(dt), "enforce": False}
    end = STEPS * (dt or 0.1)
    return simulate(
        scheme, [SPACING * n for n in rows], bodies, material, end, time=steps,
        output={"every": end / 200},
    )  # fmt: skip


def strains(simulation):
    """|F - I| of each particle, over the starting one."""
    F = simulation.snapshot.deformation_gradient
    dim = F.shape[1]
    return np.linalg.norm(F - np.eye(dim), axis=(1, 2)) / (STRAIN * np.sqrt(dim))


CASE = Case(
    "H7", "Lone particle", measure,
    schemes("linear: flip; gimp: flip; quadratic: pic, flip, apic, mls; cubic: flip, apic, mls"),
    schemes("linear: flip; quadratic: flip, mls"), dimensions=(2, 3),
)  # fmt: skip
