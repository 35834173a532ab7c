"""`converge`: refinement, observed orders, verdicts, and what the command leaves behind."""

import csv
import json
import sys
from types import SimpleNamespace

import numpy as np
import pytest

from mpm_taichi import cli, converge, load_scene
from mpm_taichi.errors import InputError, RunError
from mpm_taichi.grid_convergence import trend_of_errors, trend_of_results
from mpm_taichi.refinement import refined, refuse
from mpm_taichi.shapes.box import Box
from mpm_taichi.yardsticks import KineticEnergyAtEnd
from tests.command_line import SCENES

STRIP = """\
version: 1
domain: {size: [1.0, 0.125], cells: [8, 1], walls: {left: slip, right: slip, bottom: periodic,
  top: periodic}}
method: {transfer: {type: apic, force: mls}}
time: {end: 0.005, step: 2.0e-4}
definitions: {A: 1.0e-4, c: 100, S: "sin(pi*c*t)", F: "1 + A*pi*cos(pi*X)*S"}
body_force: ["pi**2*A*sin(pi*X)*S/1000*(5e6*(1 + 1/F**2) - 1e7)", 0]
materials:
  bar: {type: neo_hookean, density: 1000, youngs_modulus: 1.0e+7, poissons_ratio: 0}
bodies:
  - name: bar
    material: bar
    shape: {type: box, min: [0, 0], max: [1, 0.125]}
    particles: {type: lattice, per_cell: 2}
    velocity: ["A*pi*c*sin(pi*X)", 0]
exact: {displacement: ["A*sin(pi*X)*S", 0]}
output: {every: 1.0e-3, history: {every_steps: 1}}
"""


PER_CELL = "{type: lattice, per_cell: 2}"


@pytest.fixture
def strip(tmp_path):
    """A scene file: the manufactured bar of numerics.md 8.1 in a strip, with passages replaced."""

    def strip(*changes):
        text = STRIP
        for old, new in changes:
            assert old in text, old
            text = text.replace(old, new)
        path = tmp_path / "strip.yaml"
        path.write_text(text)
        return path

    return strip


BODY_FORCE = 'body_force: ["pi**2*A*sin(pi*X)*S/1000*(5e6*(1 + 1/F**2) - 1e7)", 0]\n'
EXACT = 'exact: {displacement: ["A*sin(pi*X)*S", 0]}\n'
FREE = (
    ("left: slip, right: slip, ", ""),
    ('velocity: ["A*pi*c*sin(pi*X)", 0]', "velocity: [20, 0]"),
    ("max: [1, 0.125]", "max: [0.5, 0.125]"),
    (BODY_FORCE, ""),
)
"""Changes that leave half a bar in free flight."""


def test_orders_of_errors_that_shrink_by_a_power(rng):
    """e = C h^p: each pair of grids gives p to rounding, and nothing is at fault."""
    C, p = rng.uniform(0.1, 1), rng.uniform(0.6, 4)
    errors = [C * 0.5 ** (p * level) for level in range(4)]
    trend = trend_of_errors(errors, 1e-12)
    assert trend.orders[0] is None
    assert trend.orders[1:] == pytest.approx([p] * 3, rel=1e-12)
    assert (trend.uncertainty, trend.fault) == (errors[-1], None)


@pytest.mark.parametrize(
    ("errors", "fault"),
    [
        ([0.4, 0.1, 0.1], "no smaller error"),
        ([0.4, 0.1, 0.2], "no smaller error"),
        ([0.4, 0.1, 0.08], "order 0.32 is below 0.5"),
        ([0.4, 0.1, None], "the finest level failed"),
        ([0.4, None, 0.1], "the level before the finest failed"),
        ([None, 0.1, 0.025], None),
        ([1e-13, 2e-13, 4e-13], None),
    ],
)
def test_errors_that_do_not_converge(errors, fault):
    """Judged by the finest pair; what is rounding at every level has no fault."""
    found = trend_of_errors(errors, 1e-8).fault
    assert found is fault if fault is None else fault in found


def test_richardson_on_a_power(rng):
    """f = f0 + C h^p with p below 2: the order is p, and the index is 1.25 times the true relative
    error of the finest grid, since |f2 - f1| / (2^p - 1) is that error exactly."""
    f0, C, p = rng.uniform(5, 6), rng.uniform(0.1, 0.5), rng.uniform(0.8, 2)
    f = [f0 + C * 0.5 ** (p * level) for level in range(5)]
    trend = trend_of_results(f, f[-1], 1e-12)
    assert trend.orders[:2] == [None, None]
    assert trend.orders[2:] == pytest.approx([p] * 3, rel=1e-10)
    assert trend.uncertainty == pytest.approx(1.25 * abs(f[-1] - f0) / f[-1], rel=1e-10)
    assert trend.fault is None


def test_an_order_above_that_of_the_method_is_luck():
    """1, 0.1 and 0.01 above f0: order log2(10) = 3.3; the index divides by 2^2 - 1 all the same."""
    trend = trend_of_results([11.0, 10.1, 10.01], 10.01, 1e-12)
    assert trend.orders[-1] == pytest.approx(np.log2(10))
    assert trend.uncertainty == pytest.approx(1.25 * 0.09 / 10.01 / 3)


@pytest.mark.parametrize(
    ("results", "fault"),
    [
        ([1.0, 1.1, 1.05], "up and down"),
        ([1.0, 1.1, 1.3], "do not shrink"),
        ([1.0, 1.25, 1.5], "do not shrink"),
        ([1.0, 1.0, 1.2], "do not shrink"),
        ([1.0, 1.5, 1.8], "above 5 %"),
        ([1.0, None, 1.2, 1.3], "not all done"),
        ([1.0, 1.1], "not all done"),
        ([1.0, 1.1, 1.1], None),
        ([2.0, 2.0, 2.0 + 1e-12], None),
    ],
)
def test_results_that_depend_on_the_grid(results, fault):
    found = trend_of_results(results, 1.5, 1e-8)
    assert found.fault is fault if fault is None else fault in found.fault


def test_refined_plane():
    """Level 2: four times the cells along each axis, a quarter of the step, no pictures; per_cell,
    outputs, bodies, physics as they were.  Level 0 is the scene without pictures."""
    changes = ["output.every=0.7", *(f"bodies[{k}].particles={PER_CELL}" for k in (0, 1))]
    scene = load_scene(SCENES / "two_disks_lattice.yaml", changes)
    fine = refined(scene, 2)
    assert fine.domain.cells == [4 * count for count in scene.domain.cells]
    assert fine.domain.size == scene.domain.size
    assert (scene.time.step, fine.time.step) == (1e-3, 2.5e-4)
    assert fine.output.images == "none"
    assert (fine.output.every, fine.bodies, fine.materials) == (0.7, scene.bodies, scene.materials)
    assert refined(scene, 0) == load_scene(
        SCENES / "two_disks_lattice.yaml", [*changes, "output.images=none"]
    )


def test_refined_spacings_and_automatic_steps():
    """Spacings and mesh sizes halve with the cells; an automatic step follows by itself."""
    path = SCENES / "two_disks_lattice.yaml"
    for particles in ("{type: lattice, spacing: 0.02}", "{type: gmsh, size: 0.02}"):
        changes = [f"bodies[0].particles={particles}", f"bodies[1].particles={PER_CELL}"]
        scene = load_scene(path, [*changes, "time.step=auto"])
        fine = refined(scene, 1)
        found = fine.bodies[0].particles
        assert (getattr(found, "spacing", None) or getattr(found, "size", None)) == 0.01
        assert fine.bodies[1].particles == scene.bodies[1].particles
        assert fine.time.step == "auto"


def test_refined_strip(strip):
    """A periodic axis with one cell keeps it and gets thinner, with the bodies."""
    fine = refined(load_scene(strip()), 3)
    assert fine.domain.cells == [64, 1]
    assert fine.domain.size == [1.0, 0.125 / 8]
    assert fine.bodies[0].shape == Box(type="box", min=[0, 0], max=[1, 0.125 / 8])
    assert fine.time.step == 2e-4 / 8


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ([("{type: box, min: [0, 0], max: [1, 0.125]}",
           "{type: ball, center: [0.5, 0.06], radius: 0.05}")],
         "bodies[0].shape (bar): along y, periodic with one cell"),
        ([('velocity: ["A*pi', 'velocity: ["Y*A*pi')], "bodies[0].velocity: uses Y"),
        ([('["pi**2*A', '["y*pi**2*A')], "body_force: uses y"),
        ([("definitions: {A: 1.0e-4", "definitions: {A: 1.0e-4*Y")], "exact.displacement: uses Y"),
        ([("cells: [8, 1]", "cells: [1, 1]"), ("[1.0, 0.125]", "[0.125, 0.125]"),
          ("left: slip, right: slip", "left: periodic, right: periodic"),
          ("max: [1, 0.125]", "max: [0.125, 0.125]")],
         "domain.cells: no axis is left to refine"),
    ],
)  # fmt: skip
def test_scenes_that_cannot_be_refined(strip, changes, said):
    """In words, with the place."""
    with pytest.raises(InputError) as found:
        refuse(load_scene(strip(*changes)))
    assert said in str(found.value)


def test_a_mesh_file_cannot_be_refined(tmp_path):
    """Its resolution is given."""
    (tmp_path / "disk.msh").touch()
    text = (SCENES / "two_disks_lattice.yaml").read_text()
    (tmp_path / "scene.yaml").write_text(text)
    scene = load_scene(
        tmp_path / "scene.yaml",
        ["bodies[0].particles={type: mesh, file: disk.msh}", "bodies[0].shape=null"],
    )
    with pytest.raises(InputError, match="a mesh file has one resolution"):
        refuse(scene)


def test_too_many_cells(tmp_path):
    """What does not fit at a finer level is told before anything runs."""
    scene = load_scene(
        SCENES / "two_disks_lattice.yaml", ["domain.cells=[20000, 20000]", "time.step=auto"]
    )
    with pytest.raises(InputError, match=r"at level 2 of the refinement: domain\.cells makes"):
        refined(scene, 2)


def table(folder):
    with (folder / "converge.csv").open(newline="") as file:
        return list(csv.DictReader(file))


@pytest.mark.slow
def test_second_order_of_a_manufactured_solution(strip, tmp_path, capfd):
    """A small standing wave (numerics.md 8.1, A = 1e-4) over a quarter of its period on 8, 16 and
    32 cells: the displacement converges with order 2, at least 1.8 between the finest two.  The
    table is on stdout and progress on stderr; table, CSV, JSON and picture say the same."""
    folder = tmp_path / "out"
    assert cli.main(["converge", str(strip()), "--levels", "3", "-o", str(folder)]) == 0
    out, err = capfd.readouterr()
    rows = table(folder)
    assert [row["cells"] for row in rows] == ["8 x 1", "16 x 1", "32 x 1"]
    assert [float(row["dx"]) for row in rows] == [0.125, 0.0625, 0.03125]
    assert [int(row["particles"]) for row in rows] == [32, 64, 128]
    assert [int(row["steps"]) for row in rows] == [25, 50, 100]
    errors = [float(row["displacement"]) for row in rows]
    order = float(rows[-1]["displacement_order"])
    assert order == pytest.approx(np.log2(errors[1] / errors[2]), rel=1e-12)
    assert 1.8 < order < 2.6, errors
    content = json.loads((folder / "converge.json").read_text())
    assert content["status"] == "done"
    assert [level["values"]["displacement"] for level in content["levels"]] == errors
    assert content["trends"]["displacement"]["orders"][-1] == order
    assert not any(flag.startswith("displacement") for flag in content["flags"])
    assert (folder / "converge.png").read_bytes().startswith(b"\x89PNG")
    assert f"displacement: order {order:.2f}, error {100 * errors[-1]:.2g} %" in out
    assert out.splitlines()[1].split()[:3] == ["level", "cells", "dx"]
    assert "level 2: done, 100 steps" in err
    assert load_scene(folder / "scene.yaml") == load_scene(strip())


@pytest.mark.slow
def test_results_without_an_exact_solution(strip, tmp_path, capfd):
    """Half a bar in free flight at 20 m/s for 5 ms, in strips of 1/8, 1/16 and 1/32 m: it has moved
    by 0.1 m, and its kinetic energy for the width of the scene is 500 kg/m^3 0.5 m 0.125 m 400
    m^2/s^2, at every level.  Nothing changes from level to level, so nothing is at fault; what is 0
    is left out."""
    folder = tmp_path / "out"
    words = ["converge", str(strip(*FREE, (EXACT, ""))), "--levels", "3", "-q", "-o", str(folder)]
    assert cli.main(words) == 0
    rows = table(folder)
    for row in rows:
        assert float(row["kinetic_energy"]) == pytest.approx(12500, rel=1e-12)
        assert float(row["bar_center_x"]) == pytest.approx(0.1, rel=1e-12)
    assert not {"elastic_energy", "bar_center_y"} & rows[0].keys()
    assert json.loads((folder / "converge.json").read_text())["flags"] == []
    out, err = capfd.readouterr()
    assert err == ""
    assert "result at the end" in out


def test_kinetic_energy_at_the_end():
    """Free fall in steps of 0.1 s to t = 1 s: v lives at t - 0.05 s, E = t^2 / 2 there.  The line
    through the last two, at 0.85 and 0.95 s, gives 0.49625 at the end, of 0.5; the last alone has
    0.45125.  Earlier steps are not looked at."""
    kinetic, end, dt = KineticEnergyAtEnd(), 1.0, 0.1
    for step in range(11):
        half = max(0.0, (step - 0.5) * dt)
        snapshot = SimpleNamespace(mass=np.ones(1), velocity=np.array([[0.0, half]]))
        now = SimpleNamespace(
            time=step * dt, dt=dt, last_dt=dt if step else 0.0, end=end, snapshot=snapshot
        )
        kinetic.record(now, is_output=step == 10)
    assert kinetic.value(end) == pytest.approx(0.49625, rel=1e-12)


@pytest.mark.slow
def test_a_level_that_fails(strip, tmp_path, monkeypatch, capfd):
    """Its row has the first sentence of the failure, and the other levels run."""
    start = converge._start

    def fails_at_16_cells(scene, options):
        if scene.domain.cells[0] == 16:
            raise RunError("t = 1 s, step 2: particle 3 is lost. A shorter step may help.")
        return start(scene, options)

    monkeypatch.setattr(converge, "_start", fails_at_16_cells)
    folder = tmp_path / "out"
    words = ["converge", str(strip()), "--levels", "3", "-q", "-o", str(folder)]
    assert cli.main(words) == 0
    failures = [row["failure"] for row in table(folder)]
    assert failures == ["", "t = 1 s, step 2: particle 3 is lost", ""]
    out, _ = capfd.readouterr()
    assert "failed: t = 1 s, step 2: particle 3 is lost\n" in out
    assert "displacement: error" in out
    assert "does not converge: the level before the finest failed" in out


@pytest.mark.slow
def test_every_level_fails(strip, tmp_path, capfd):
    """A bar that flies out of the domain: exit code 1, and the table says why."""
    scene = strip(*FREE, ("velocity: [20, 0]", "velocity: [-500, 0]"))
    folder = tmp_path / "out"
    words = ["--levels", "2", "--set", "time.enforce=false", "-q", "-o", str(folder)]
    assert cli.main(["converge", str(scene), *words]) == 1
    out, _ = capfd.readouterr()
    assert out.count("has left the domain") == 2
    assert json.loads((folder / "converge.json").read_text())["status"] == "failed"
    assert not (folder / "converge.png").exists()


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--levels", "1"], "must be a whole number from 2 to 8 (got '1')"),
        (["--levels", "9"], "must be a whole number from 2 to 8 (got '9')"),
        (["--levels", "2"], "without the section exact of a scene, orders come from 3 successive"),
        (["--frames", "3"], "unrecognized arguments"),
        (["--set", "bodies[0].particles={type: gmsh, size: -1}"], "must be greater than 0"),
    ],
)
def test_bad_input_is_refused_in_words(tmp_path, monkeypatch, capfd, words, said):
    """Exit code 2, a sentence on stderr, nothing on stdout, no folder made."""
    monkeypatch.chdir(tmp_path)
    try:
        code = cli.main(["converge", str(SCENES / "two_disks_lattice.yaml"), *words])
    except SystemExit as end:  # argparse's way
        code = end.code
    out, err = capfd.readouterr()
    assert (code, out) == (2, "")
    assert said in err
    assert "Traceback" not in err
    assert list(tmp_path.iterdir()) == []


def test_without_matplotlib(tmp_path, monkeypatch, capfd):
    """It is optional: exit code 2 and the line that installs it, before anything runs."""
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    monkeypatch.chdir(tmp_path)
    assert cli.main(["converge", str(SCENES / "two_disks_lattice.yaml")]) == 2
    assert 'pip install "matplotlib>=3.8"' in capfd.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_a_study_does_not_replace_a_run(tmp_path, capfd):
    """--overwrite replaces a folder of the same kind alone."""
    (tmp_path / "run.json").write_text("{}")
    words = ["converge", str(SCENES / "two_disks_lattice.yaml"), "-o", str(tmp_path)]
    assert cli.main(words) == 2
    assert "replace the convergence study in it" in capfd.readouterr().err
    assert cli.main([*words, "--overwrite"]) == 2
    assert "holds no convergence study (no converge.json)" in capfd.readouterr().err
    assert [path.name for path in tmp_path.iterdir()] == ["run.json"]
