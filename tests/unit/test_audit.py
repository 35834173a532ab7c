"""The books of a run: what they say, where they fail, and what that does to the exit code."""

import json
import time
from types import SimpleNamespace

import numpy as np
import pytest
from rich.console import Console
from taichi._snode.fields_builder import FieldsBuilder

from mpm_taichi import Simulation, load_scene
from mpm_taichi.attempts import Attempts
from mpm_taichi.audit import Books, Line, audit, describe
from mpm_taichi.errors import InputError
from mpm_taichi.history_table import read_history
from mpm_taichi.renderers.ledger import draw_ledger
from mpm_taichi.run import carry_out

TEXT = """\
version: 1
domain: {size: [1.0, 1.0], cells: [6, 6], walls: {bottom: slip, left: sticky}}
time: {end: 0.03}
gravity: [0, -9.81]
materials:
  jelly: {type: neo_hookean, density: 1000, youngs_modulus: 1e4, poissons_ratio: 0.3}
bodies:
  - name: block
    material: jelly
    shape: {type: box, min: [0, 0], max: [0.5, 0.5]}
    particles: {type: lattice, per_cell: 2}
    velocity: [0.5, -1]
output: {every: 0.01, images: none, audit: true, history: {every_steps: 1}}
"""
OPTIONS = SimpleNamespace(strict=True, json=False)
CONSOLE = Console(quiet=True)


@pytest.fixture(scope="module")
def done(tmp_path_factory):
    """One run to its end, with --strict."""
    folder = tmp_path_factory.mktemp("run")
    (folder / "given.yaml").write_text(TEXT)
    simulation = Simulation(load_scene(folder / "given.yaml"))
    attempts = Attempts(simulation, folder, CONSOLE)
    code = carry_out(attempts, OPTIONS, CONSOLE, time.perf_counter())
    return SimpleNamespace(simulation=simulation, folder=folder, attempts=attempts, code=code)


def test_a_sound_run_passes(done):
    """Whole steps of a block that is thrown at two walls: mass, momenta and energy pass, and what
    cannot be judged says why; run.json has the lines.  Memory is as planned, but for constants."""
    assert done.code == 0 and done.simulation.solver.is_whole
    lines = {
        line["name"]: line for line in json.loads((done.folder / "run.json").read_text())["audit"]
    }
    judged = {"mass", "momentum_x", "momentum_y", "angular_momentum", "energy"}
    assert {name for name, line in lines.items() if line["verdict"] == "PASS"} == judged
    assert lines["volume"]["verdict"] == "reported" and lines["volume"]["note"]
    assert abs(lines["momentum_y"]["supplied"]) > 0.1 * abs(lines["momentum_y"]["start"])
    assert "p2g" in lines["energy"]["note"] and "g2p" in lines["energy"]["note"]
    allocated = sum(root._cell_size_bytes for root in FieldsBuilder._finalized_roots())
    assert 0 <= allocated - done.simulation.memory.fields < 1536


@pytest.mark.parametrize(
    ("column", "line"),
    [
        ("wall_impulse_y", "momentum_y"),
        ("gravity_turn", "angular_momentum"),
        ("loss_g2p", "energy"),
    ],
)
def test_a_missing_entry_fails_its_line(done, tmp_path, column, line):
    """A wall impulse that is off by 1e-9 of itself, no moment of gravity, a loss of 2 % of the
    energy that no stage owns up to: the line fails, alone, and is told."""
    table = read_history(done.folder / "history.csv")
    table[column] = table[column] * (1 + 1e-9 if column == "wall_impulse_y" else 0)
    table[column][-1] += 0.02 * table["kinetic_energy"].max() * (column == "loss_g2p")
    rows = [
        ",".join(table),
        *(",".join(map(repr, map(float, row))) for row in zip(*table.values(), strict=True)),
    ]
    (tmp_path / "history.csv").write_text("\n".join([*rows, ""]))
    lines = audit(done.simulation, tmp_path / "history.csv")
    assert [one.name for one in lines if one.verdict == "FAIL"] == [line]
    assert f"FAIL     {line}: " in describe(lines)


def test_without_the_counts_walls_are_reported(done):
    """A run without output.audit has no wall impulses: its momentum is reported, with the reason,
    and nothing is made up."""
    table = read_history(done.folder / "history.csv")
    first, last = ({name: values[k] for name, values in table.items()} for k in (0, -1))
    books = Books(done.simulation, first, last, table)
    books.is_audited = False
    for line in (*books.momentum(), *books.angular_momentum(), books.energy()):
        assert line.verdict == "reported"
        assert "output.audit" in line.note


def test_what_leaves_the_domain_takes_momentum_with_it(done, monkeypatch):
    """Deleted or clamped particles: only the mass is judged, and it is said why."""
    count = {None: 3}
    monkeypatch.setattr(done.simulation.solver.particles, "brought_in", count)
    lines = audit(done.simulation, done.folder / "history.csv")
    assert [line.name for line in lines if line.verdict != "reported"] == ["mass"]
    assert all("border" in line.note for line in lines if line.name not in ("mass", "volume"))


def test_strict_turns_a_failing_line_into_exit_code_1(done, monkeypatch, capsys):
    """The results stay, and the status is done."""
    bad = Line("energy", 1.0, 2.0, 0.0, 1.0, 1.0, 0.01)
    monkeypatch.setattr("mpm_taichi.run.audit", lambda *_: [bad])
    again = Attempts(done.simulation, done.folder, CONSOLE)
    for strict, code in ((False, 0), (True, 1)):
        options = SimpleNamespace(strict=strict, json=False)
        assert carry_out(again, options, CONSOLE, time.perf_counter()) == code
        assert json.loads((done.folder / "run.json").read_text())["status"] == "done"
    assert "--strict" in capsys.readouterr().err


def test_only_on_the_cpu(tmp_path):
    """Counters are written by one worker each, which a GPU does not have."""
    (tmp_path / "scene.yaml").write_text(TEXT)
    with pytest.raises(InputError, match=r"output\.audit: is for --device cpu"):
        Simulation(load_scene(tmp_path / "scene.yaml"), device="vulkan")


def test_picture_of_a_ledger(tmp_path):
    """From the columns alone; rows that are zero throughout are left out."""
    pytest.importorskip("matplotlib")
    t = np.linspace(0, 1, 5)
    columns = {"time": t, "particle_kinetic_energy": 1 - t, "elastic_energy": t / 2}
    columns |= {"dissipated_energy": t / 4, "loss_g2p": t / 4, "work_of_gravity": 0 * t}
    draw_ledger(tmp_path / "audit.png", columns | {"energy_residual": 1e-3 * t})
    assert (tmp_path / "audit.png").stat().st_size > 10_000
