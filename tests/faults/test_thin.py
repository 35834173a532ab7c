"""Domains one, two and three cells thin, up to a thousand times as long: refused in words before
anything is allocated, or the motion of one dimension.

A bar of 8 cells, density 1, wave speed 1 and nu = 0 fills the domain across, and swings from
v = V cos(pi X / 8) on.  Nothing depends on the place across, so that sides which close on
themselves, let slide, let go or are open, at any thickness and along any axis, must all give the
motion of the same method in one dimension, written out here."""

from itertools import product
from typing import Any

import numpy as np
import pytest

from mpm_taichi import Simulation
from mpm_taichi.bases import BASES
from mpm_taichi.errors import InputError
from mpm_taichi.reference import bases as twin_bases
from mpm_taichi.scene import Scene

SIDES = (("left", "right"), ("bottom", "top"), ("back", "front"))
WALLS = ("none", "slip", "separate", "periodic")
LOW, LENGTH, SPEED, RIDES, STEP, STEPS = 4, 8, 0.01, 0.37, 0.3, 20
MARGIN = LENGTH + 2 * LOW
"""Cells along the axis of a strip that is no longer than the bar needs."""

ROUNDING = 4 * 1.1e-16 * STEPS
"""Of a place 1 cell from the origin: 4 u in each step."""


def strip(basis, dim, axis, walls, thickness, length=MARGIN) -> Scene:
    """The bar at the far end of a strip.  Where that closes on itself the bar rides across at
    RIDES, twice around a strip of one cell."""
    across, place = [d for d in range(dim) if d != axis], length - LENGTH - LOW
    cells = [length if d == axis else thickness for d in range(dim)]
    low, high = [0.0] * dim, [float(n) for n in cells]
    low[axis], high[axis] = float(place), float(place + LENGTH)
    velocity: list[Any] = [RIDES if walls == "periodic" else 0.0] * dim
    velocity[axis] = f"{SPEED} * cos(pi * ({'XYZ'[axis]} - {place}) / {LENGTH})"
    steel = {"type": "fixed_corotated", "density": 1, "youngs_modulus": 1, "poissons_ratio": 0}
    bar = {
        "name": "bar", "material": "steel", "velocity": velocity,
        "shape": {"type": "box", "min": low, "max": high},
        "particles": {"type": "lattice", "per_cell": 2},
    }  # fmt: skip
    content: dict[str, Any] = {
        "version": 1,
        "domain": {
            "size": [float(n) for n in cells], "cells": cells,
            "walls": {side: walls for d in across for side in SIDES[d]},
        },
        "method": {"basis": basis.name, "transfer": {"type": "flip"}},
        "time": {"end": STEP * STEPS, "step": STEP},
        "materials": {"steel": steel}, "bodies": [bar],
        "output": {"images": "none", "every": STEP * STEPS},
    }  # fmt: skip
    return Scene(**content)


def is_possible(basis, walls, thickness) -> bool:
    return walls == "periodic" or thickness >= basis.support


@pytest.mark.parametrize("basis", BASES)
def test_too_thin_is_refused(basis):
    """Where a stencil is wider than the domain and its sides are not one: named are the first such
    axis, the least number of cells, and the basis.  A scene allocates nothing."""
    for dim, walls, thickness in product((2, 3), (*WALLS, "sticky"), (1, 2, 3)):
        for axis in range(dim):
            if is_possible(basis, walls, thickness):
                strip(basis, dim, axis, walls, thickness)
                continue
            first = 1 if axis == 0 else 0
            words = rf"domain.cells\[{first}\]: must be at least {basis.support}.* {basis.name} ba"
            with pytest.raises(InputError, match=words):
                strip(basis, dim, axis, walls, thickness)


def in_one_dimension(basis):
    """Ways, velocities and strains of the bar's particles at the end: FLIP, USL."""
    twin = getattr(twin_bases, basis.__name__)
    X = LOW + (np.arange(2 * LENGTH) + 0.5) / 2
    x, v, F = X.copy(), SPEED * np.cos(np.pi * (X - LOW) / LENGTH), np.ones(2 * LENGTH)
    m, half = 0.5, 0.25
    for _ in range(STEPS):
        first = twin.first(x)
        w, dw = twin.weights(x - first, half), twin.slopes(x - first, half)
        i = first + np.arange(basis.support)[:, None]
        mass, mv, impulse = np.zeros((3, MARGIN))
        np.add.at(mass, i, w * m)
        np.add.at(mv, i, w * m * v)
        np.add.at(impulse, i, -STEP * dw * m * (F - 1) * F)
        v_old = mv / np.where(mass > 0, mass, 1)
        v_new = v_old + impulse / np.where(mass > 0, mass, 1)
        v += (w * (v_new - v_old)[i]).sum(axis=0)
        x += STEP * (w * v_new[i]).sum(axis=0)
        F *= 1 + STEP * (dw * v_new[i]).sum(axis=0)
    return x - X, v, F - 1


def check(basis, dim, axis, walls, thickness, length=MARGIN):
    """The motion along the bar is that of one dimension, all across it; across, the bar is where it
    should be: to 4 u a step of its distance from the origin.  Mass is that of the start, the
    momentum along the bar 0."""
    print(basis.name, f"{dim}D, axis {axis}, {walls}, {thickness} thin, {length} long")
    scene = strip(basis, dim, axis, walls, thickness, length)
    simulation = Simulation(scene, precision="f64")
    start, rounding = simulation.snapshot, ROUNDING * length
    simulation.run()
    now = simulation.snapshot
    way = now.position - start.position
    along = way[:, axis], now.velocity[:, axis], now.deformation_gradient[:, axis, axis] - 1
    place = np.round(2 * (start.position[:, axis] - (length - LENGTH - LOW)) - 0.5).astype(int)
    for ours, exact in zip(along, in_one_dimension(basis), strict=True):
        assert np.abs(ours - exact[place]).max() < rounding
        assert np.abs(exact).max() > 1e-3
    across = np.delete(way, axis, axis=1) - (RIDES * now.time if walls == "periodic" else 0.0)
    across -= thickness * np.round(across / thickness) if walls == "periodic" else 0.0
    assert np.abs(across).max() < ROUNDING * MARGIN
    assert now.mass.sum() == start.mass.sum()
    assert abs(now.mass @ now.velocity[:, axis]) < rounding * now.mass.sum()


@pytest.mark.slow
def test_a_thin_strip(rng, monkeypatch):
    """A strip of 1000 cells, along either axis, of any basis, thickness and sides that are
    possible, with Taichi's checks of bounds."""
    monkeypatch.setenv("TI_DEBUG", "1")
    cases = [case for case in product(BASES, WALLS, (1, 2, 3)) if is_possible(*case)]
    basis, walls, thickness = cases[rng.integers(len(cases))]
    check(basis, 2, int(rng.integers(2)), walls, thickness, 1000)


@pytest.mark.slow
@pytest.mark.campaign
@pytest.mark.parametrize(("dim", "length"), [*product((2, 3), (MARGIN, 1000))])
@pytest.mark.parametrize("walls", WALLS)
@pytest.mark.parametrize("basis", BASES)
def test_all_thin_strips(monkeypatch, basis, walls, dim, length):
    """As above, each, also thin across two axes."""
    monkeypatch.setenv("TI_DEBUG", "1")
    for axis, thickness in product(range(dim), (1, 2, 3)):
        if is_possible(basis, walls, thickness):
            check(basis, dim, axis, walls, thickness, length)
