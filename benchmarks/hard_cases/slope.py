"""H25: sand on a slope, and cyclic loads on snow and on a metal that flows.

A layer of sand without end on a sticky floor, gravity turned by 20 and by 40 degrees.  In a shear
flow that keeps its volume stress and rate have the same axes, so that shear over pressure is
A / sqrt(2) with the cone's A of drucker_prager.py: 0.693 for phi = 30 degrees, the angle of repose
is 34.7 degrees.  (The cone meets Mohr and Coulomb in triaxial compression.)  So at 20 degrees it
holds: within a cell of where it was, for 10 s (hard_cases.md, H25).  It begins pressed by its
weight.  At 40 degrees every layer
flows, held back by the same part of its pressure:

    a = g (sin 40 - A / sqrt(2) cos 40) = 0.112 g.

No layer is faster, to 5 %, as transfers only add friction at a floor that holds (FLIP comes to 0.96
of it, MLS to 0.83); and after half a second, 2.7 cells of way by this formula, the center of mass
has moved by more than the cell that sand at rest may.

Single elements: J after each of 10 cycles of strain that end where they began is det F = 1, to 1e-3
per cycle.  (That stresses stay on the yield surface and that nothing flows for nothing:
tests/properties/test_materials.py.)"""

from typing import Any

import numpy as np
from experiments import schemes

from mpm_taichi import runtime
from mpm_taichi.element import Elements, cycle, deformation
from mpm_taichi.materials import Snow, VonMises

from .case import Case, Draw, Figure, Found
from .scenes import SIDES, along, body, clamps, simulate

DX, DEPTH, LENGTH, WIDTH, G = 0.05, 8, 4, 2, 9.81
SAND: dict[str, Any] = {
    "type": "drucker_prager", "density": 1600, "youngs_modulus": 1e6, "poissons_ratio": 0.3,
    "friction_angle": 30,
}  # fmt: skip
SLOPE = float(np.sin(np.radians(SAND["friction_angle"])))
FRICTION = 2 * np.sqrt(3) * SLOPE / (3 - SLOPE)
HOLDS = {True: 1.0, False: 10.0}
"""Seconds at 20 degrees: with --quick, and without."""

STIFF: dict[str, Any] = {"density": 1000.0, "youngs_modulus": 1e5, "poissons_ratio": 0.3}
SOLIDS = (
    Snow(type="snow", critical_compression=0.025, critical_stretch=0.0075, hardening=10.0, **STIFF),
    VonMises(type="von_mises", yield_stress=2e3, hardening=1e3, **STIFF),
)
CYCLES, STRAIN = 10, 0.05


def measure(scheme, draw: Draw) -> Found:
    figures, counts = [], {}
    held = layer(scheme, 20, HOLDS[draw.quick], draw.dimension)
    start, drift = held.snapshot.position, 0.0
    for now in held.frames():
        drift = max(drift, np.linalg.norm(travelled(now, start), axis=1).max())
    figures.append(Figure("cells moved at 20", drift / DX, 1.0))
    counts |= clamps(held)
    flowing = layer(scheme, 40, 0.5, draw.dimension)
    exact = G * (sine(40) - FRICTION * cosine(40))
    t, v = np.transpose([
        (now.time, now.snapshot.velocity[:, 0].mean()) for now in flowing.frames()
    ])  # fmt: skip
    counts |= clamps(flowing)
    late = len(t) // 5
    a = np.polyfit(t[late:], v[late:], 1)[0]
    figures += [
        Figure("a / exact at 40", a / exact, 1.05),
        Figure("cells moved at 40", v.mean() * t[-1] / DX, 1.0, at_least=True),
    ]
    return Found(figures + ratchets(scheme.precision, draw.dimension), counts)


def sine(degrees) -> float:
    return float(np.sin(np.radians(degrees)))


def cosine(degrees) -> float:
    return float(np.cos(np.radians(degrees)))


def travelled(simulation, start):
    """Across the periodic sides too; nothing goes half the height up or down."""
    way, size = simulation.snapshot.position - start, np.array(simulation.scene.domain.size)
    return way - size * np.round(way / size)


def layer(scheme, degrees, end, dim):
    """LENGTH x DEPTH (x WIDTH) cells, periodic along the slope and across."""
    E, nu = SAND["youngs_modulus"], SAND["poissons_ratio"]
    modulus = E * (1 - nu) / (1 + nu) / (1 - 2 * nu)
    strain = SAND["density"] * G * cosine(degrees) / modulus
    sag = f"{-strain!r} * ({DEPTH * DX} * Y - Y * Y / 2)"
    high = [LENGTH * DX, DEPTH * DX, WIDTH * DX][:dim]
    sand = body("sand", [0] * dim, high, displacement=along(1, dim, sag))
    cells = [LENGTH, DEPTH + 4, WIDTH][:dim]
    across = (side for axis in range(0, dim, 2) for side in SIDES[axis])
    sections: dict[str, Any] = {
        "domain": {
            "size": [n * DX for n in cells],
            "walls": {"bottom": "sticky"} | dict.fromkeys(across, "periodic"),
        },
        "gravity": [G * sine(degrees), -G * cosine(degrees), 0.0][:dim],
    }  # fmt: skip
    return simulate(scheme, cells, [sand], SAND, end, **sections)


def ratchets(precision, dim) -> list[Figure]:
    runtime.start("cpu", precision)
    s = np.tile(cycle(STRAIN)[1:], CYCLES)
    paths = ("uniaxial", "shear", "biaxial")
    F = np.stack([deformation(path, s, dim) for path in paths], axis=1)
    figures = []
    for material in SOLIDS:
        found = Elements(material, dim=dim, count=len(paths)).lead(F)
        ends = found.volume_ratio.reshape(CYCLES, -1, len(paths))[:, -1]
        steps = np.abs(np.diff(ends, axis=0, prepend=1.0)).max()
        assert found.dissipated_energy[-1].min() > 0
        figures.append(Figure(f"J per cycle ({material.type})", steps, 1e-3))
    return figures


CASE = Case(
    "H25", "Sand slope", measure,
    schemes("linear: flip; gimp: flip, apic; quadratic: flip, apic, mls; cubic: flip, mls"),
    schemes("quadratic: mls"), reported=("linear flip",), dimensions=(2, 3),
)  # fmt: skip
