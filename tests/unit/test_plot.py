"""plot and compare: which curves are drawn, what is said of the others, and a picture."""

import csv
import json
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from mpm_taichi import cli
from mpm_taichi import plot as plots
from mpm_taichi.renderers.palette import eight_bit, rgb
from mpm_taichi.renderers.panels import COLORS

TIME = np.linspace(0, 0.02, 41)
FALLING = {
    "time": TIME,
    "step": np.arange(41.0),
    "time_step": np.where(TIME > 0, 5e-4, 0),
    "mass": 2 + 0 * TIME,
    "momentum_x": 1e-15 * np.sin(1000 * TIME),
    "momentum_y": -2 * 9.81 * TIME,
    "kinetic_energy": 9.81**2 * TIME**2,
    "elastic_energy": 0 * TIME,
    "dissipated_energy": 0 * TIME,
    "gravitational_energy": 19.62 - 9.81**2 * TIME**2,
}
"""Two kilograms that fall from a height of 1 m."""

LIMITS = [
    {"name": "acoustic", "seconds": 1e-3, "cause": "material rubber"},
    {"name": "acoustic", "seconds": 1.2e-3, "cause": "material steel"},
    {"name": "travel", "seconds": 2.0e-3, "cause": "speed 3 m/s"},
    {"name": "gravity", "seconds": 0.1, "cause": "gravity"},
]


def write_run(folder: Path, columns=FALLING, limits=LIMITS) -> Path:
    folder.mkdir()
    report = {
        "status": "done", "steps": 40, "time": 0.02, "time_step": {"limits_at_start": limits}
    }  # fmt: skip
    (folder / "run.json").write_text(json.dumps(report))
    with (folder / "history.csv").open("w", newline="") as file:
        table = csv.writer(file)
        table.writerow(columns)
        table.writerows(zip(*columns.values(), strict=True))
    return folder


@pytest.fixture
def drawn(monkeypatch):
    """Panels by quantity, as they were to be drawn."""
    found = {}

    def note(path, title, panels, columns):
        found.update({panel.quantity: panel for panel in panels}, title=title, columns=columns)

    monkeypatch.setattr(plots, "draw_panels", note)
    return found


def test_plot_shows_a_history(tmp_path, drawn, capfd):
    """Energies with their sum, which free fall keeps at 0 where the gravitational one is counted
    from the start; momentum whose axis makes no hills of rounding errors; the step, of which there
    is none before the first, with the nearest limit of each name, but for those too far to show.
    What is 0 throughout is left out, and said."""
    run = write_run(tmp_path / "fall")
    assert cli.main(["plot", str(run)]) == 0
    assert drawn["title"] == "fall: done after 40 steps, t = 0.02 s"
    energies = {curve.label.split(",")[0]: curve.value for curve in drawn["energy"].curves}
    assert list(energies) == ["kinetic energy", "gravitational energy", "total energy"]
    assert energies["gravitational energy"][0] == 0
    assert energies["total energy"] == pytest.approx(0 * TIME, abs=1e-14)
    assert [curve.label for curve in drawn["momentum"].curves] == ["momentum x", "momentum y"]
    most = 2 * 9.81 * 0.02
    assert drawn["momentum"].span == pytest.approx(1e-3 * most)
    steps = drawn["time step"]
    assert np.isnan(steps.curves[0].value[0])
    assert set(steps.curves[0].value[1:]) == {5e-4}
    assert list(steps.levels.values()) == [1e-3, 2e-3]
    assert [" ".join(label.split()) for label in steps.levels] == [
        "acoustic limit at the start (material rubber)",
        "travel limit at the start (speed 3 m/s)",
    ]
    said = capfd.readouterr().out
    assert f"picture: {run / 'plot.png'}" in said
    assert "0 throughout, and not drawn: elastic energy, dissipated energy" in said


def test_columns_that_are_missing_are_said(tmp_path, drawn, capfd):
    """The sum is of those that are there; what is no number leaves a gap."""
    columns = {name: FALLING[name] for name in ("time", "momentum_x", "kinetic_energy")}
    columns["kinetic_energy"] = columns["kinetic_energy"].copy()
    columns["kinetic_energy"][7] = np.inf
    run = write_run(tmp_path / "old", columns)
    assert cli.main(["plot", str(run)]) == 0
    assert [curve.label for curve in drawn["energy"].curves] == ["kinetic energy", "total energy"]
    assert np.flatnonzero(np.isnan(drawn["energy"].curves[0].value)).tolist() == [7]
    assert "time step" not in drawn
    assert (
        f"{run}: history.csv has no elastic_energy, dissipated_energy, gravitational_energy, "
        "momentum_y, time_step"
    ) in capfd.readouterr().out


def test_compare_draws_a_panel_for_each_quantity(tmp_path, drawn, capfd, monkeypatch):
    """A curve for each run that has it, in the style of its run; an energy that one run has is
    shown.  Runs of the same name in different folders are told apart."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "a").mkdir()
    (tmp_path / "b").mkdir()
    first = write_run(tmp_path / "a" / "run")
    second = write_run(tmp_path / "b" / "run", FALLING | {"elastic_energy": 1 + TIME})
    short = {name: values for name, values in FALLING.items() if name != "momentum_x"}
    third = write_run(tmp_path / "short", short)
    assert cli.main(["compare", str(first), str(second), str(third)]) == 0
    quantities = [" ".join(name.split()) for name in drawn if name not in ("title", "columns")]
    assert quantities == [
        "kinetic energy", "elastic energy", "gravitational energy, since the start",
        "total energy", "momentum x", "momentum y", "time step",
    ]  # fmt: skip
    labels = [curve.label for curve in drawn["elastic energy"].curves]
    assert labels == [str(first), str(second), str(third)]
    assert [curve.style for curve in drawn["momentum x"].curves] == [0, 1]
    said = capfd.readouterr().out
    assert f"picture: {Path('runs/compare-001.png')}" in said
    assert f"{third}: history.csv has no momentum_x" in said
    assert "0 throughout, and not drawn: dissipated energy" in said


def test_a_picture(tmp_path, monkeypatch):
    """A PNG of a whole page, with pixels of the color of each curve."""
    run = write_run(tmp_path / "fall")
    other = write_run(tmp_path / "other", FALLING | {"momentum_y": FALLING["momentum_y"] / 2})
    picture = tmp_path / "made" / "both.png"
    assert cli.main(["plot", str(run)]) == 0
    assert cli.main(["compare", str(run), str(other), "-o", str(picture)]) == 0
    for path, curves in ((run / "plot.png", 3), (picture, 2)):
        with Image.open(path) as image:
            assert min(image.size) > 1000
            pixels = np.asarray(image.convert("RGB")).reshape(-1, 3)
        for color in rgb(*(code[1:] for code in COLORS[:curves])):
            assert (pixels == eight_bit(color)).all(axis=1).sum() > 100
    assert not list(tmp_path.rglob("*.part"))


def test_nothing_is_overwritten_unasked(tmp_path, drawn, capfd):
    run = write_run(tmp_path / "fall")
    (run / "plot.png").write_text("mine")
    other = tmp_path / "mine.png"
    other.write_text("mine")
    for words in (["plot"], ["plot", "-o", str(other)], ["compare", str(run), "-o", str(other)]):
        assert cli.main([*words[:1], str(run), *words[1:]]) == 2
        assert "is there already; name another one (-o), or add --overwrite" in (
            capfd.readouterr().err
        )
    assert not drawn
    assert cli.main(["plot", str(run), "--overwrite"]) == 0
    assert drawn


def test_wrong_words(tmp_path, drawn, capfd):
    """Each a sentence and exit code 2, and nothing is drawn."""
    run = write_run(tmp_path / "fall")
    young = write_run(tmp_path / "young", {name: values[:1] for name, values in FALLING.items()})
    odd = write_run(tmp_path / "odd", {"time": TIME, "weather": TIME})
    for words, said in (
        (["plot", tmp_path], "has no run.json, so it is no run"),
        (["plot", young], "has no two rows yet"),
        (["plot", odd], "none of the columns"),
        (["plot", run, "-o", "a.pdf"], "the picture is a .png file"),
        (["compare", run], "name two runs or more"),
    ):
        assert cli.main([str(word) for word in words]) == 2
        assert said in capfd.readouterr().err
    assert not drawn


def test_without_matplotlib_the_command_that_installs_it_is_told(tmp_path, monkeypatch, capfd):
    monkeypatch.setattr(plots, "find_spec", lambda _: None)
    run = write_run(tmp_path / "fall")
    for words in (["plot", run], ["compare", run, run]):
        assert cli.main([str(word) for word in words]) == 2
        assert 'pip install "matplotlib>=3.8"' in capfd.readouterr().err
