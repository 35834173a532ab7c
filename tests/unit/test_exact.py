"""The exact solution of a scene and the errors of a run against it."""

import json
from dataclasses import replace
from math import log, sqrt
from types import SimpleNamespace

import numpy as np
import pytest

from mpm_taichi import cli, exact, load_scene
from mpm_taichi.errors import InputError
from mpm_taichi.exact import ExactSolution
from mpm_taichi.kernels.respond import respond
from mpm_taichi.materials import LinearElastic, NeoHookean
from mpm_taichi.particles import groups_of
from mpm_taichi.recorders import Errors
from mpm_taichi.reference import materials as twins
from mpm_taichi.reference.kernels.respond import respond as respond_twin
from mpm_taichi.simulation import Simulation
from tests.command_line import history

SCENE = """\
version: 1
domain: {{size: {size}, cells: {cells}, walls: {walls}}}
time: {{end: 0.02, step: 1.0e-3}}
materials:
  rubber: {{type: {law}, density: 1000, youngs_modulus: 1.0e+4, poissons_ratio: 0.3}}
bodies:
  - name: block
    material: rubber
    shape: {{type: box, min: {low}, max: {high}}}
    particles: {{type: lattice, per_cell: 2}}
{more}
output: {{every: 0.01, images: none, history: {{every_steps: 1}}}}
"""
MU, LAM = 1e4 / 2.6, 1e4 * 0.3 / (1.3 * 0.4)
PLANE = {"size": [1.0, 1.0], "cells": [8, 8], "low": [0.25, 0.25], "high": [0.75, 0.5]}
SPACE = {
    "size": [1.0, 1.0, 1.0], "cells": [8, 8, 8], "low": [0.25, 0.25, 0.5], "high": [0.5, 0.5, 0.75],
}  # fmt: skip


def scene_file(folder, *, law="neo_hookean", walls="none", body="", exact, where=PLANE):
    """A block in the middle of a box; `body`: its further keys, `exact`: the section."""
    more = f"{body}\nexact: {exact}"
    path = folder / "scene.yaml"
    path.write_text(SCENE.format(law=law, walls=walls, more=more, **where))
    return path


@pytest.fixture
def simulation(tmp_path):
    def simulation(changes=(), **words):
        return Simulation(load_scene(scene_file(tmp_path, **words), changes))

    return simulation


@pytest.mark.parametrize(
    ("where", "law", "u", "v"),
    [
        (PLANE, "neo_hookean", ["0.1*X*Y + 0.2*t", "0.05*X - 0.1*t"], ["0.2", "-0.1"]),
        (PLANE, "linear_elastic", ["1e-3*X*Y + 0.2*t", "5e-4*X"], ["0.2", "0"]),
        (SPACE, "neo_hookean", ["0.1*Y*Z", "0.3*t*X", "-0.05*Z"], ["0", "0.3*X", "0"]),
    ],
    ids=["2D-neo_hookean", "2D-linear_elastic", "3D-neo_hookean"],
)
def test_a_state_set_to_the_solution_has_no_error(simulation, where, law, u, v):
    """A run that starts from the solution at t = 0, sheared and stretched: displacement, velocity,
    Cauchy stress with its out-of-plane part and energy agree to rounding.  The velocity is the rate
    of the displacement; fields are not 0."""
    at_start = [formula.replace("0.2*t", "0").replace("0.1*t", "0").replace("0.3*t*X", "0")
                for formula in u]  # fmt: skip
    body = f"    displacement: {at_start}\n    velocity: {v}".replace("'", '"')
    solution = ExactSolution(simulation(where=where, law=law, body=body, exact={"displacement": u}))
    errors = solution.errors()
    assert list(errors) == ["displacement", "velocity", "stress", "energy"]
    for name, found in errors.items():
        assert found.scale > 0
        assert found.error < 1e-12 * found.scale, name
    assert solution.describe().endswith("displacement, velocity, stress, energy")


def test_a_known_shift_is_the_error(simulation):
    """A body moved by (0.03, -0.04) m against a solution at rest: each particle is 0.05 m off.  It
    flies at 2 m/s where the solution has 0.5 m/s along the other axis."""
    body = "    displacement: [0.03, -0.04]\n    velocity: [2, 0]"
    errors = ExactSolution(
        simulation(body=body, exact={"displacement": [0, 0], "velocity": [0, 0.5]})
    ).errors()
    assert errors["displacement"] == pytest.approx((0.05, 0.0, 0.05), rel=1e-12)
    assert errors["velocity"] == pytest.approx((sqrt(4.25), 0.5, sqrt(4.25)), rel=1e-12)
    assert errors["stress"].error == pytest.approx(0.0, abs=1e-12)
    kinetic = 0.5 * 1000 * 0.125
    assert errors["energy"] == (pytest.approx(kinetic * 3.75), pytest.approx(kinetic * 0.25), None)


def test_norms_weigh_by_volume(simulation):
    """u = 0.1 X is missed entirely by a body at rest: the error is sqrt(mean of (0.1 X)^2) over the
    lattice points X = 9/32 ... 23/32 with weights V0, here made proportional to X; the largest is
    that of the last point."""
    run = simulation(exact={"displacement": ["0.1*X", 0]})
    run.snapshot = replace(run.snapshot, initial_volume=3 * run.initial_position[:, 0])
    X = np.arange(9, 24, 2) / 32
    found = ExactSolution(run).errors()["displacement"]
    assert found.error == pytest.approx(0.1 * np.sqrt((X**3).sum() / X.sum()), rel=1e-12)
    assert found.scale == found.error
    assert found.largest == pytest.approx(0.1 * X[-1], rel=1e-12)


@pytest.mark.parametrize("law", ["neo_hookean", "fixed_corotated", "linear_elastic"])
def test_stress_and_energy_of_a_stretch_by_hand(simulation, law):
    """F = diag(1.1, 1, 1), compared with a body at rest, so the errors are the exact values:
    neo-Hookean J sigma = mu (b - I) + lam ln J I, psi = mu/2 (tr b - 3) - mu ln J + lam/2 ln^2 J;
    fixed-corotated sigma = 2 mu (F - I) + lam (J - 1) I, psi = mu |F - I|^2 + lam/2 (J - 1)^2;
    linear sigma = 2 mu eps + lam tr(eps) I, psi = J/2 sigma : eps.  sigma_zz counts."""
    if law == "neo_hookean":
        xx, zz = (MU * 0.21 + LAM * log(1.1)) / 1.1, LAM * log(1.1) / 1.1
        psi = 0.5 * MU * 0.21 - MU * log(1.1) + 0.5 * LAM * log(1.1) ** 2
    else:
        xx, zz = (2 * MU + LAM) * 0.1, LAM * 0.1
        psi = 0.5 * (1.1 if law == "linear_elastic" else 1.0) * xx * 0.1
    errors = ExactSolution(simulation(law=law, exact={"displacement": ["0.1*X", 0]})).errors()
    norm = sqrt(xx**2 + 2 * zz**2)
    assert errors["stress"] == pytest.approx((norm, norm, norm), rel=1e-12)
    assert errors["energy"].error == pytest.approx(0.125 * psi, rel=1e-12)


def test_only_the_components_given_are_compared(simulation):
    """A body at rest against sigma_xx = 3, sigma_xy = 4 Pa: |.| = sqrt(3^2 + 2 4^2); what yy would
    be is not asked.  No displacement, no velocity: nothing else is compared."""
    errors = ExactSolution(simulation(exact={"stress": {"xx": 3.0, "xy": "4 + 0*X"}})).errors()
    norm = pytest.approx(sqrt(41), rel=1e-12)
    assert errors == {"stress": (norm, norm, norm)}


@pytest.mark.parametrize("walls", ["none", "{left: periodic, right: periodic}"])
def test_rigid_translation_has_no_error(simulation, walls):
    """A free block at (9, 0) m/s moves 0.18 m; where x is periodic its start is moved so that it
    crosses the end of the domain.  Errors stay at rounding at all times: 20 steps with coordinates
    of order 1 and velocities of order 9."""
    start = 0.3 if "left" in walls else 0.0
    body = f"    displacement: [{start}, 0]\n    velocity: [9, 0]"
    run = simulation(walls=walls, body=body, exact={"displacement": [f"{start} + 9*t", 0]})
    errors = Errors(None, run, 1)
    run.run([errors])
    found = errors.summary()
    assert found["displacement"]["error"] < 1e-13
    assert found["velocity"]["error"] < 1e-12
    assert found["displacement"]["scale"] == pytest.approx(start + 0.18, rel=1e-12)
    assert found["stress"]["relative"] is None
    assert "the exact one is 0" in errors.describe()
    if start:
        assert run.snapshot.position[:, 0].max() > 1 or run.snapshot.position[:, 0].min() < 0.25


def test_velocities_are_compared_half_a_step_earlier(simulation):
    """Free fall in steps of dt: the velocity after n of them is -g n dt, so at t_n - dt/2 the field
    -g (t + dt/2) fits to rounding, and compared at t_n it would be off by g dt/2 = 0.005 m/s."""
    run = simulation(["gravity=[0, -10]"], exact={"velocity": [0, "-10*(t + 5e-4)"]})
    solution = ExactSolution(run)
    assert solution.errors()["velocity"].error == pytest.approx(0.005, rel=1e-12)
    for _ in range(3):
        run.step()
        assert solution.errors()["velocity"].error < 1e-13


def test_laws_that_are_not_elastic(simulation, monkeypatch):
    """Stress and energy do not follow from the displacement: they are left out, in words."""
    monkeypatch.setattr(exact, "ELASTIC", (LinearElastic,))
    solution = ExactSolution(simulation(exact={"displacement": [0, 0]}))
    assert list(solution.errors()) == ["displacement", "velocity"]
    assert "for elastic laws alone, and rubber has another" in solution.describe()


@pytest.mark.parametrize(
    ("section", "said"),
    [
        ({"displacement": ["sqrt(X - 0.5)", 0]}, "exact.displacement: gives no number at [0.28125"),
        ({"displacement": ["-2*X", 0]}, "exact.displacement: gives no stress at [0.28125"),
        ({"stress": {"xx": "1/t"}}, "exact.stress: gives no number at [0.28125"),
    ],
)
def test_a_solution_that_is_no_number(simulation, section, said):
    """Named by key, place and time.  F = 1 - 2 < 0 has no neo-Hookean stress."""
    with pytest.raises(InputError) as found:
        ExactSolution(simulation(exact=section)).errors()
    assert said in str(found.value)


def test_the_folder_of_a_run_has_its_errors(tmp_path, capfd):
    """errors.csv has a row for each row of history.csv; run.json the largest error over time, when
    it was, and the value at the end; the last lines on the console say it.  The body flies at
    1 m/s and the solution at 3 m/s: off by 2 t, in the end by 0.04 m of 0.06 m, 67 %."""
    path = scene_file(tmp_path, body="    velocity: [1, 0]", exact={"displacement": ["3*t", 0]})
    assert cli.main([str(path), "-o", str(tmp_path / "out")]) == 0
    said = capfd.readouterr().err
    assert "compared with the exact solution: displacement, velocity, stress, energy" in said
    assert "displacement 67 % (0.04 m at t = 0.02 s), velocity 67 % (2 m/s at t = 0 s)" in said
    rows = np.genfromtxt(tmp_path / "out" / "errors.csv", delimiter=",", names=True)
    assert rows["time"].tolist() == history(tmp_path / "out")["time"].tolist()
    assert rows["displacement_error"] == pytest.approx(2 * rows["time"], abs=1e-14)
    content = json.loads((tmp_path / "out" / "run.json").read_text())["errors"]
    assert content["displacement"] == pytest.approx(
        {
            "error": 0.04,
            "at": 0.02,
            "at_end": 0.04,
            "largest": 0.04,
            "scale": 0.06,
            "relative": 2 / 3,
        }
    )
    assert content["stress"]["relative"] is None
    assert content["velocity"]["at"] == 0.0


def test_a_run_without_a_solution_writes_no_errors(tmp_path):
    """No section `exact`: no errors.csv, and no errors in run.json."""
    path = scene_file(tmp_path, exact={"displacement": [0, 0]})
    path.write_text(path.read_text().replace("exact: {'displacement': [0, 0]}", ""))
    assert cli.main([str(path), "-q", "-o", str(tmp_path / "out")]) == 0
    assert sorted(p.name for p in (tmp_path / "out").iterdir()) == [
        "history.csv", "run.json", "scene.yaml", "snapshots",
    ]  # fmt: skip
    assert "errors" not in json.loads((tmp_path / "out" / "run.json").read_text())


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("law", [LinearElastic, NeoHookean])
def test_response_is_that_of_the_twin(exact, rng, dim, law):
    """Kirchhoff stress, energy and out-of-plane stress of random H to 1e-12 of the largest: the
    same sums in another order."""
    material = law(
        type={LinearElastic: "linear_elastic", NeoHookean: "neo_hookean"}[law],
        density=1000, youngs_modulus=1e5, poissons_ratio=0.3,
    )  # fmt: skip
    H = rng.uniform(-0.2, 0.2, (50, dim, dim))
    start = material.start(H)
    (group,) = groups_of([material], dim, 0.1, [np.zeros_like(H)])
    c = SimpleNamespace(**material.constants(0.1))
    twin = SimpleNamespace(law=getattr(twins, law.__name__), constants=c)
    for ours, theirs in zip(respond(group, H, start), respond_twin(twin, H, start), strict=True):
        assert ours == pytest.approx(theirs, rel=0, abs=1e-12 * np.abs(theirs).max())
