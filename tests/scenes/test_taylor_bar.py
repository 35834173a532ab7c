"""The Taylor bar: 21.43 mm long and 7.13 mm in radius at 80 us (axisymmetric finite elements with
B-bar, 6 x 48; benchmarks.md 6, T1; other codes 21.4 to 21.5 and 7.0 to 7.24 mm)."""

import numpy as np
import pytest

from mpm_taichi import Simulation, load_scene
from tests.command_line import SCENES

LENGTH, RADIUS = 21.43e-3, 7.13e-3
FIRST_RADIUS = 3.2e-3
AXIS = 9.6e-3  # x and z


def from_axis(x):
    return np.hypot(x[:, 0] - AXIS, x[:, 2] - AXIS)


def length(X, x, spacing):
    """Of the bar at the end, to half a spacing above the mean of its top particles, where there is
    no stress."""
    return x[X[:, 1] > X[:, 1].max() - 0.5 * spacing, 1].mean() + 0.5 * spacing


def foot(X, x, spacing):
    """Mean over the particles that were up to a spacing from the rim and are in the lowest cell:
    r + (initial distance to the rim) * hoop stretch, this being r / r0."""
    r0, r = from_axis(X), from_axis(x)
    rim = (r0 > FIRST_RADIUS - spacing) & (x[:, 1] < 2 * spacing)
    return (r + (FIRST_RADIUS - r0) * r / r0)[rim].mean()


def ledger(simulation):
    """Kinetic, elastic and dissipated energy [J]."""
    names = ("kinetic_energy", "elastic_energy", "dissipated_energy")
    return np.array([simulation.sums[name].sum() for name in names])


def end_of(*changes):
    """The simulation at its end, length and radius [m], and its energies at start and end."""
    scene = load_scene(SCENES / "taylor_bar.yaml", ["output.images=none", *changes])
    simulation = Simulation(scene, threads=1)
    energies = [ledger(now) for now in simulation.frames()]
    X, x = simulation.initial_position, simulation.snapshot.position
    spacing = scene.cell_size / 2
    found = length(X, x, spacing), foot(X, x, spacing)
    print(
        f"length {1e3 * found[0]:.3f} mm, radius {1e3 * found[1]:.3f} mm, "
        f"energies {energies[-1].round(3)} of {energies[0].sum():.3f} J, "
        f"plastic strain up to {simulation.snapshot.plastic_strain.max():.2f}"
    )
    return simulation, *found, energies


@pytest.mark.slow
def test_foot_length_and_energy():
    """FLIP, MUSL, 4 cells per radius: length within 2 %, radius within 5 % (seen 0.2 % and 0.4 %).

    Energy is handed on, from motion to heat: the three add up to what they were within 1 % at each
    output (seen: 0.2 %), what is lost never comes back, and little else is left at the end."""
    simulation, long, wide, energies = end_of()
    assert long == pytest.approx(LENGTH, rel=0.02)
    assert wide == pytest.approx(RADIUS, rel=0.05)
    total, lost = np.sum(energies, axis=1), np.array(energies)[:, 2]
    assert np.abs(total / total[0] - 1).max() < 0.01
    assert (np.diff(lost) >= 0).all()
    assert lost[-1] > 0.97 * total[0]
    assert simulation.snapshot.plastic_strain.min() >= 0


@pytest.mark.slow
@pytest.mark.campaign
@pytest.mark.parametrize(
    "changes",
    [
        ("domain.cells=[18, 63, 18]", "time.step=3.5e-8"),
        ("method={}", "domain.cells=[24, 84, 24]", "time.step=3.0e-8"),
    ],
    ids=["FLIP R/h = 6", "MLS R/h = 8"],
)
def test_foot_and_length_on_finer_grids(changes):
    """Length within 2 %, radius within 5 %: FLIP, and MLS, which on the coarse grid makes the foot
    too narrow by 9 %."""
    _, long, wide, _ = end_of(*changes)
    assert long == pytest.approx(LENGTH, rel=0.02)
    assert wide == pytest.approx(RADIUS, rel=0.05)
