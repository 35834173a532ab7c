"""H9: a free elastic disk of radius R = 8 cells, w R / c = 0.1, five revolutions.

Angular momentum is kept by APIC, with either form of its force, to rounding; the disk widens by
some (w R / c)^2 / 4 and breathes.  In plane strain the volume at its center grows, at rest in the
turning frame, by 2 A = (w R / c)^2 (2 lam + 3 mu) / (4 (lam + mu)), 0.6 % with nu = 0.3.  It starts
without strain and swings beyond, at the center by more than as much again, since waves from the rim
meet there: the radial modes of linear elasticity, added up (finite elements along r), come to J =
1.0133 within five revolutions (hard_cases.md has 1.01, of a set-up that it does not give).  PIC
loses all, FLIP 7 %, FLIP with 1 % of PIC 80 % (hard_cases.md, H9, measured).

In f32 rounding is left, 1e-5 where it averages out.  In 3D the disk turns about z and particles
keep their places along it, so that the sum of their weights there is off 1 by the same part of u in
every step: n u after n steps (at z = 1/4 and 3/4 cubic splines have 2 to 8e-5, of 3e-4; those of
quadratic splines are whole there)."""

import numpy as np
from experiments import schemes

from mpm_taichi import diagnostics

from .case import Case, Draw, Figure, Found, U
from .scenes import clamps, simulate, solid, vector

R, CELLS, OMEGA = 8, 24, 0.1 / 8


def measure(scheme, draw: Draw) -> Found:
    """Of the offsets drawn (one with --quick, two in 3D), and of a sense of rotation, the worst."""
    offsets = draw.offsets(1 if draw.quick else 8 if draw.dimension == 2 else 2, 2)
    w = OMEGA * float(np.linalg.det(draw.orientation(2)))
    runs = [once(scheme, place, w, draw.dimension) for place in offsets]
    figures = [
        max(each, key=badness) for each in zip(*(found.figures for found in runs), strict=True)
    ]
    return Found(figures, runs[0].clamps)


def badness(figure: Figure) -> float:
    return -figure.value if figure.at_least else figure.value


def once(scheme, offset, w, dim) -> Found:
    """In 3D a slice of a cylinder one cell thick, which closes on itself: plane strain too."""
    center = CELLS / 2 + offset - 0.5
    shape, cells, domain = {"type": "ball", "center": [CELLS / 2] * 2}, [CELLS] * 2, {}
    if dim == 3:
        cells, domain = [CELLS, CELLS, 1], {"walls": {"back": "periodic", "front": "periodic"}}
        shape = {"type": "cylinder", "center": [*shape["center"], 0.5], "axis": "z", "length": 1}
    rest = [0.0] * (dim - 2)
    disk = {
        "name": "disk", "material": "solid", "shape": shape | {"radius": R},
        "particles": {"type": "lattice", "per_cell": 2},
        "displacement": vector([*(offset - 0.5), *rest]),
        "velocity": [f"{-w!r} * (Y - {CELLS / 2})", f"{w!r} * (X - {CELLS / 2})", *rest],
    }  # fmt: skip
    end = 5 * 2 * np.pi / abs(w)
    simulation = simulate(scheme, cells, [disk], solid(), end, domain=domain)
    moments, energies, radii, volumes = [], [], [], []
    for now in simulation.frames():
        s = now.snapshot
        moments.append(diagnostics.angular_momentum(s)[-1])
        energies.append(diagnostics.kinetic_energy(s) + diagnostics.elastic_energy(s))
        radii.append(np.linalg.norm(s.position[:, :2] - center, axis=1).max())
        volumes += [s.volume_ratio.min(), s.volume_ratio.max()]
    exact = 1e-11
    if scheme.precision == "f32":
        stays = dim == 3 and scheme.basis != "quadratic"
        exact = simulation.step_count * U["f32"] if stays else 1e-5
    figures = [
        Figure("|dL| / L", np.abs(np.array(moments) / moments[0] - 1).max(), exact),
        Figure("dE / E", energies[-1] / energies[0] - 1, -0.005, at_least=True),
        Figure("radius", max(radii) / radii[0] - 1, 0.005),
        Figure("least J", min(volumes), 0.99, at_least=True),
        Figure("largest J", max(volumes), 1.0133),
    ]
    return Found(figures, clamps(simulation))


CASE = Case(
    "H9", "Spin", measure,
    schemes("gimp: apic; quadratic: pic, flip, flip 0.99, apic, mls; cubic: apic, mls"),
    schemes("quadratic: pic, mls"), fails={"quadratic pic": "|dL| / L"},
    reported=("quadratic flip", "quadratic flip 0.99"), dimensions=(2, 3),
)  # fmt: skip
