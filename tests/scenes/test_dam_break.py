"""The dam break against the fronts that Martin and Moyce (1952) and Koshizuka and Oka (1996) saw.

Z = front / a over T = t sqrt(2 g / a); the front of a run is its largest x plus half the spacing of
the particles.  The clocks of the experiments do not start with the motion: each is moved so that
Z = 1.44 coincides, and the shift is bounded."""

import numpy as np
import pytest

from mpm_taichi import Simulation, load_scene
from tests.command_line import SCENES

A, G = 0.05715, 9.81
CELLS = 120
"""Along the floor in the scene, 20 to the base of the column."""

MEASURED = {
    name: np.loadtxt(SCENES / "references" / f"dam_break_{name}.csv", delimiter=",")
    for name in ("martin_moyce_small", "martin_moyce_large", "koshizuka")
}


def bulk(position, dx):
    """Which particles have water in all eight cells around their own; walls are mirrors."""
    cell = np.floor(position / dx).astype(int)
    wet = np.zeros(cell.max(axis=0) + 2, bool)
    wet[tuple(cell.T)] = True
    wet = np.pad(wet, ((1, 0), (1, 0)), mode="edge")
    for axis in (0, 1):
        wet = wet & np.roll(wet, 1, axis) & np.roll(wet, -1, axis)
    return wet[tuple(cell.T + 1)]


def collapse(method, cells):
    """T and Z of each output, and the least and largest J of bulk water."""
    changes = [f"method={method}", f"domain.cells=[{cells}, {cells // 2}]", "time.end=0.2"]
    simulation = Simulation(load_scene(SCENES / "dam_break.yaml", changes))
    dx = simulation.scene.cell_size
    T, Z, J = [], [], []
    for now in simulation.frames():
        here = now.snapshot
        T.append(now.time * np.sqrt(2 * G / A))
        Z.append((here.position[:, 0].max() + dx / 4) / A)
        J += list(here.volume_ratio[bulk(here.position, dx)])
    print(f"warnings {simulation.warnings()}")
    return np.array(T), np.array(Z), min(J), max(J)


def deviations(T, Z, measured):
    """Shift of the clock, and Z of the run over that measured, less one, for Z > 1.44 up to
    T = 3.2."""
    t, z = measured.T
    shift = np.interp(1.44, z, t) - np.interp(1.44, Z, T)
    compared = (z > 1.44) & (t <= 3.2)
    return shift, np.interp(t[compared] - shift, T, Z) / z[compared] - 1


SCHEMES = {
    "mls": "{basis: quadratic, transfer: {type: apic}}",
    "apic": "{basis: quadratic, transfer: {type: apic, force: gradient}}",
    "flip": "{basis: quadratic, transfer: {type: flip, relaxation_time: 0.01}}",
}


def case(scheme, cells, *marks):
    return pytest.param(SCHEMES[scheme], cells, id=f"{scheme}-{cells}", marks=marks)


LONG = (pytest.mark.slow, pytest.mark.campaign)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("method", "cells"),
    [
        case("mls", CELLS // 2),
        *[case(scheme, CELLS, *LONG) for scheme in SCHEMES],
        case("mls", 2 * CELLS, *LONG),
    ],
)
def test_front_is_that_of_martin_and_moyce(method, cells):
    """Both columns within 8 % with a shift of at most 0.35, whatever the scheme; the front stays
    behind that of Ritter, x = a + 2 t sqrt(g H), which is Z = 1 + 2 T.  Koshizuka and Oka's is
    told, not judged.  J of bulk water within 2 % of 1: the speed of sound is ten times
    sqrt(2 g H), which makes 1 % by the pressure rho v^2."""
    T, Z, least, largest = collapse(method, cells)
    for name, measured in MEASURED.items():
        shift, off = deviations(T, Z, measured)
        print(f"{name}: clock moved by {shift:.2f}, Z off by {np.round(100 * off, 1)} %")
        if name != "koshizuka":
            assert 0 < shift < 0.35
            assert len(off) >= 3
            assert np.abs(off).max() < 0.08
    assert (Z <= 1 + 2 * T + 1e-9).all()
    print(f"J of bulk water {least:.4f} to {largest:.4f}")
    assert 0.98 < least <= largest < 1.02


@pytest.mark.slow
@pytest.mark.campaign
def test_averaging_makes_water_thick():
    """Expected failure: PIC loses velocity in every step, and the front, at Z = 4.05 for all others
    at T = 3, has hardly left."""
    T, Z, *_ = collapse("{basis: quadratic, transfer: {type: pic}}", CELLS // 2)
    print(f"Z = {np.interp(3, T, Z):.2f} at T = 3")
    assert np.interp(3, T, Z) < 0.9 * 4.05


@pytest.mark.slow
@pytest.mark.campaign
def test_water_that_fell_back_takes_its_room():
    """When the splashes are over, the pool is as deep as its volume says: twice the height of its
    center, over a / 3, within 8 % at t = 3 s.  Fluid that remembers the gaps of its spray lies at
    0.86."""
    changes = ["domain.cells=[60, 30]", "time.end=3"]
    simulation = Simulation(load_scene(SCENES / "dam_break.yaml", changes))
    simulation.run()
    height = 2 * simulation.snapshot.position[:, 1].mean() / (A / 3)
    print(f"height {height:.3f} of a / 3, {simulation.warnings()}")
    assert height == pytest.approx(1, abs=0.08)
