"""`new`: a scene to begin with.  `list`: the gallery to look around in."""

import numpy as np
import pytest

from mpm_taichi import Simulation, cli, gallery, load_scene
from mpm_taichi.scene.document import parse
from mpm_taichi.scene.models import Scene
from mpm_taichi.seeding import expected_counts
from tests.command_line import SCENES


def test_the_new_scene_runs(tmp_path, monkeypatch, capfd):
    """The 2D one, three outputs of 1 ms with coarse cells and particles: the ball is in free fall,
    so that its center has moved by v t - g t^2 / 2 to within a part of g dt t, the error of first
    order; energies are finite and the block rests on the floor within a cell."""
    monkeypatch.chdir(tmp_path)
    assert cli.main(["new", "first.yaml"]) == 0
    assert "python -m mpm_taichi check first.yaml" in capfd.readouterr().out
    scene = load_scene(
        "first.yaml", ["domain.cells=[16,16]", "time.end=0.003", "output.every=0.001"]
    )
    simulation = Simulation(scene)
    start = simulation.snapshot.position
    simulation.run()
    ball = simulation.body_of_particle == 0
    moved = (simulation.snapshot.position - start)[ball].mean(axis=0)
    assert simulation.is_done
    expected = np.array([0.5, -0.5 * 9.81 * 0.003]) * 0.003
    assert np.abs(moved - expected).max() <= 9.81 * simulation.time_step.longest * 0.003
    assert simulation.snapshot.position[~ball].min() > 0


@pytest.mark.parametrize("dim", [2, 3])
def test_every_section_is_explained(tmp_path, dim):
    """Both dimensions load, with some thousand particles at most; each section that is required,
    and the method, gravity and output, stands below a comment; lines are at most 100 long."""
    path = tmp_path / "x.yml"
    assert cli.main(["new", str(path), "--dim", str(dim)]) == 0
    scene = load_scene(path)
    assert scene.dimension == dim
    assert 100 < sum(expected_counts(scene)) < 5000
    lines = path.read_text().splitlines()
    assert max(map(len, lines)) <= 100
    given = parse(path.read_text(), "x").value
    required = {name for name, field in Scene.model_fields.items() if field.is_required()}
    assert required | {"method", "gravity", "output"} <= given.keys()
    for section in ("domain", "method", "time", "materials", "bodies", "output"):
        number = next(k for k, line in enumerate(lines) if line.startswith(f"{section}:"))
        assert lines[number - 1].startswith("# "), section


def test_a_copy_of_the_gallery(tmp_path):
    """--like NAME or FILE: the same text."""
    for like, name in (("dam_break", "a.yaml"), (str(SCENES / "dam_break.yaml"), "b.yaml")):
        assert cli.main(["new", str(tmp_path / name), "--like", like]) == 0
        assert (tmp_path / name).read_text() == (SCENES / "dam_break.yaml").read_text()


@pytest.mark.parametrize(
    "words, said",
    [
        (["there.yaml"], "there.yaml: is there already, and is left as it is"),
        (["there.yaml", "--like", "bay"], "is there already"),
        (["x"], "a scene file ends in .yaml: say x.yaml"),
        (["no/x.yaml"], "there is no folder no; make it first"),
        (["x.yaml", "--like", "two_disk"], "in the gallery; did you mean 'two_disks'?"),
        (["x.yaml", "--like", "bay", "--dim", "2"], "give one of them"),
    ],
)  # fmt: skip
def test_nothing_is_overwritten(tmp_path, monkeypatch, capfd, words, said):
    """What cannot be is refused in words, exit code 2, and no file is made or changed."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "there.yaml").write_text("mine")
    assert cli.main(["new", *words]) == 2
    assert said in capfd.readouterr().err
    assert [path.name for path in tmp_path.iterdir()] == ["there.yaml"]
    assert (tmp_path / "there.yaml").read_text() == "mine"


def test_the_gallery_is_listed(capfd):
    """Each scene by its name, with its title, dimension, cells and source."""
    assert cli.main(["list"]) == 0
    out = capfd.readouterr().out
    for path in SCENES.glob("*.yaml"):
        assert f"{path.stem}: {load_scene(path).title}\n" in out
    assert "about 400 particles, 20 x 20 cells, Sinaie et al. 2017, section 4.1" in out
    assert "2D, meshed bodies, 20 x 20 cells, Koall 2018, demo 1" in out


def test_installed_without_a_gallery(tmp_path, monkeypatch, capfd):
    """`list` says where the scenes are and what to do instead; `new` needs none."""
    monkeypatch.setattr(gallery, "FOLDER", tmp_path / "scenes")
    assert cli.main(["list"]) == 2
    assert "the folder `scenes` of the repository" in capfd.readouterr().err
    assert cli.main(["new", str(tmp_path / "x.yaml")]) == 0
