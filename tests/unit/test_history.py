"""A row of history.csv against what a snapshot of the same moment adds up to."""

import numpy as np
import pytest

from mpm_taichi import Simulation, diagnostics, load_scene
from mpm_taichi.recorders import History
from tests.command_line import SCENES

TWO_DIMENSIONS = (
    "method={}", "bodies[1].shape.center=[0.5, 0.4]", "gravity=[1, -9.81]",
    "bodies[0].velocity=[Y, X*Y]",
)  # fmt: skip
LATTICE = "{type: lattice, per_cell: 2}"
THREE_DIMENSIONS = (
    "domain.cells=[24, 18, 12]", "gravity=[1, -9.81, 2]", "bodies[0].velocity=[Y, X*Z, 1]",
    f"bodies[0].particles={LATTICE}", f"bodies[1].particles={LATTICE}",
)  # fmt: skip


def row_of(simulation, tmp_path):
    """The row that History takes of the present moment, and the snapshot of the same."""
    history = History(tmp_path / "history.csv", simulation, 1)
    history.record(simulation, is_output=True)
    history.close()
    assert history.last is not None
    assert "snapshot" not in vars(simulation)  # a row does without
    return history.last, simulation.snapshot


@pytest.mark.parametrize(
    ("scene", "changes"),
    [
        pytest.param("two_disks_lattice", TWO_DIMENSIONS, id="2D"),
        pytest.param("two_balls", THREE_DIMENSIONS, id="3D", marks=pytest.mark.campaign),
    ],
)
def test_a_row_is_what_a_snapshot_adds_up_to(tmp_path, scene, changes):
    """Ten steps of MLS-MPM with two bodies of one material, which in 2D overlap, so that the sort
    mixes them, and one of which is sheared: mass, momenta, energies, center and mean velocity of
    each body, and - sum m g . x, are those of the snapshot, added in another order: 1e-13 of the
    terms."""
    simulation = Simulation(load_scene(SCENES / f"{scene}.yaml", changes))
    for _ in range(10):
        simulation.step()
    row, now = row_of(simulation, tmp_path)
    m, axes = now.mass, "xyz"[: simulation.scene.dimension]
    speed = np.linalg.norm(now.velocity, axis=1)
    momentum = 1e-13 * m @ speed
    names = ["angular_momentum"] if len(axes) == 2 else [f"angular_momentum_{a}" for a in axes]
    for name, L in zip(names, diagnostics.angular_momentum(now), strict=True):
        assert row[name] == pytest.approx(L, abs=2 * momentum)  # the box is 1 m wide
    assert row["mass"] == pytest.approx(m.sum(), rel=1e-13)
    assert row["kinetic_energy"] == pytest.approx(diagnostics.kinetic_energy(now), rel=1e-13)
    assert row["elastic_energy"] == pytest.approx(diagnostics.elastic_energy(now), rel=1e-12)
    assert row["elastic_energy"] > 0
    height = -m @ (now.position @ np.array(simulation.scene.gravity_vector))
    assert row["gravitational_energy"] == pytest.approx(height, rel=1e-13)
    center, velocity = diagnostics.body_motion(now, simulation.ranges)
    for k, a in enumerate(axes):
        p = diagnostics.momentum(now)[k]
        assert row[f"momentum_{a}"] == pytest.approx(p, abs=momentum)
        for b, body in enumerate(simulation.scene.bodies):
            assert row[f"{body.name}_center_{a}"] == pytest.approx(center[b, k], rel=1e-13)
            assert row[f"{body.name}_velocity_{a}"] == pytest.approx(velocity[b, k], rel=1e-12)


def test_single_precision_is_added_up_in_double(tmp_path):
    """In an f32 run momentum and centers are sums of f32 terms that lose nothing more: the same as
    NumPy's in f64 to 1e-13 of the terms, where sums in f32 would leave 1e-7."""
    scene = load_scene(SCENES / "two_disks_lattice.yaml", ["time.end=0.05"])
    simulation = Simulation(scene, precision="f32")
    for _ in range(10):
        simulation.step()
    row, now = row_of(simulation, tmp_path)
    p = simulation.solver.particles.to_numpy("rows")[:, 0, :2]
    center, _ = diagnostics.body_motion(now, simulation.ranges)
    for k, a in enumerate("xy"):
        assert row[f"momentum_{a}"] == pytest.approx(p[:, k].sum(), abs=1e-13 * np.abs(p).sum())
        assert row[f"lower_center_{a}"] == pytest.approx(center[0, k], rel=1e-13)
