"""The folder of a run: none is ever reused unasked, and nothing but a run is ever replaced."""

import json
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from mpm_taichi import cli, run_folder
from mpm_taichi.errors import InputError
from mpm_taichi.simulation import Simulation
from mpm_taichi.whole_files import write_json
from tests.command_line import SCENES

SHORT = (
    str(SCENES / "two_disks_lattice.yaml"), "-q", "--set", "time.end=0.002",
    "--set", "output.every=0.001",
)  # fmt: skip
BARE = (*SHORT, "--set", "output.images=none")
SMALL = (*SHORT, "--set", "output.images.size=64")


def names(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.iterdir())


def fake_run(folder: Path, frames: int = 0) -> None:
    """What a run leaves behind, to the last name."""
    folder.mkdir()
    for name in ("scene.yaml", "run.json", "history.csv"):
        (folder / name).write_text("old")
    if frames:
        (folder / "frames").mkdir()
    for number in range(frames):
        (folder / "frames" / f"frame_{number:04d}.png").write_text("old")


def test_folders_are_numbered(tmp_path, monkeypatch):
    """runs/<scene>-001, -002, ... of the current folder; one that is there, for whatever reason and
    even empty, is left alone."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "runs" / "drop-002").mkdir(parents=True)
    made = [run_folder.create("drop", None, False) for _ in range(3)]
    assert made == [Path(f"runs/drop-00{k}") for k in (1, 3, 4)]
    assert run_folder.create("ball", None, False) == Path("runs/ball-001")


def test_overwrite_is_about_a_folder_that_is_named(tmp_path, monkeypatch):
    """Without -o it would be accepted and ignored; a name that no folder can have is told."""
    monkeypatch.chdir(tmp_path)
    with pytest.raises(InputError, match=r"--overwrite: is for -o DIR"):
        run_folder.create("drop", None, True)
    with pytest.raises(InputError, match=r"-o: File name too long"):
        run_folder.refuse(Path("x" * 300), False)
    assert names(tmp_path) == []


def test_runs_started_at_once_get_folders_of_their_own(tmp_path, monkeypatch):
    """mkdir decides, not a look beforehand, which another run may prove wrong: where nothing seems
    to be there, each still gets a folder of its own, 40 at once 40."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(Path, "exists", lambda _: False)
    with ThreadPoolExecutor(8) as pool:
        made = list(pool.map(lambda _: run_folder.create("drop", None, False), range(40)))
    assert len(set(made)) == 40
    assert Path("runs/drop-040") in made


def test_a_run_takes_the_next_folder(tmp_path, monkeypatch, capfd):
    """Named after the scene; the run before it is as it was.  --quiet says nothing."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "runs").mkdir()
    fake_run(tmp_path / "runs" / "two_disks_lattice-001")
    assert cli.main(list(BARE)) == 0
    assert names(tmp_path / "runs") == ["two_disks_lattice-001", "two_disks_lattice-002"]
    old, new = ((folder / "run.json").read_text() for folder in sorted(Path("runs").iterdir()))
    assert old == "old"
    assert json.loads(new)["status"] == "done"
    assert capfd.readouterr() == ("", "")


def test_a_folder_of_the_users_is_refused(tmp_path, capfd):
    """Not empty: exit code 2, also with --overwrite where it holds no run; nothing changes."""
    (tmp_path / "thesis.tex").write_text("years of work")
    for words, said in (([], "not empty"), (["--overwrite"], "holds no run (no run.json)")):
        assert cli.main([*BARE, "-o", str(tmp_path), *words]) == 2
        assert said in capfd.readouterr().err
    assert names(tmp_path) == ["thesis.tex"]
    assert (tmp_path / "thesis.tex").read_text() == "years of work"


@pytest.mark.parametrize("overwrite", [False, True])
def test_a_file_is_no_folder(tmp_path, overwrite):
    """-o FILE, and -o FILE/below: refused, and the file is as it was."""
    file = tmp_path / "notes.txt"
    file.write_text("mine")
    with pytest.raises(InputError, match="this is a file; name a folder"):
        run_folder.refuse(file, overwrite)
    with pytest.raises(InputError, match="the run folder cannot be made"):
        run_folder.create("x", file / "below", overwrite)
    assert file.read_text() == "mine"


def test_runs_is_a_file(tmp_path, monkeypatch):
    """Where the current folder has a file `runs`, the reason is given."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "runs").write_text("")
    with pytest.raises(InputError, match=r"the run folder cannot be made: .*exists.*runs"):
        run_folder.create("x", None, False)


def test_an_empty_or_a_new_folder_will_do(tmp_path):
    """With its parents, and as often as it is empty."""
    deep = tmp_path / "a" / "b"
    assert run_folder.create("x", deep, False) == deep
    assert run_folder.create("x", deep, False) == deep
    assert deep.is_dir()


def test_overwrite_replaces_the_run_and_nothing_else(tmp_path, capfd):
    """The files of a run go, with all its pictures, of which it had more; a user's own files stay,
    beside them and among the pictures."""
    folder = tmp_path / "out"
    fake_run(folder, frames=9)
    mine = [folder / "notes.txt", folder / "frames" / "film.mp4", folder / "frames_kept" / "a.png"]
    for path in mine:
        path.parent.mkdir(exist_ok=True)
        path.write_text("mine")
    assert cli.main([*SMALL, "-o", str(folder)]) == 2
    assert (folder / "history.csv").read_text() == "old"
    assert cli.main([*SMALL, "-o", str(folder), "--overwrite"]) == 0, capfd.readouterr().err
    assert [path.read_text() for path in mine] == ["mine"] * 3
    assert names(folder) == [
        "frames", "frames_kept", "history.csv", "notes.txt", "run.json", "scene.yaml", "snapshots",
    ]  # fmt: skip
    assert names(folder / "frames") == ["film.mp4", *(f"frame_000{k}.png" for k in range(3))]
    assert json.loads((folder / "run.json").read_text())["status"] == "done"


def test_overwrite_leaves_no_empty_folder(tmp_path):
    """A run without pictures and snapshots in place of one with: no empty folder remains."""
    folder = tmp_path / "out"
    fake_run(folder, frames=2)
    (folder / "snapshots").mkdir()
    for name in ("particles.npz", "snapshot_0000.npz", "snapshot_0001.npz.part"):
        (folder / "snapshots" / name).write_text("old")
    run_folder.create("x", folder, True)
    assert names(folder) == []


def test_a_refused_scene_leaves_the_old_run_alone(tmp_path, capfd):
    """--overwrite removes the old run only when the new one is seeded and ready."""
    folder = tmp_path / "out"
    fake_run(folder, frames=1)
    words = [*BARE, "-o", str(folder), "--overwrite", "--set", "bodies[0].particles.spacing=5"]
    assert cli.main(words) == 2
    assert "no point inside" in capfd.readouterr().err
    assert (folder / "run.json").read_text() == "old"
    assert names(folder / "frames") == ["frame_0000.png"]


def test_a_run_says_that_it_runs(tmp_path, monkeypatch, capfd):
    """run.json is there from the start, `running`: a run that was killed is known as one."""
    folder, seen = tmp_path / "out", []
    monkeypatch.setattr(
        Simulation, "run", lambda *_: seen.append(json.loads((folder / "run.json").read_text()))
    )
    assert cli.main([*BARE, "-o", str(folder)]) == 0
    assert (seen[0]["status"], seen[0]["steps"]) == ("running", 0)
    assert capfd.readouterr().out == ""


def test_files_appear_whole(tmp_path):
    """Written beside and renamed: an old file is complete until the new one is, no part remains."""
    path = tmp_path / "run.json"
    write_json(path, {"a": 1})
    with pytest.raises(TypeError):
        write_json(path, {"a": object()})
    assert json.loads(path.read_text()) == {"a": 1}
    write_json(path, {"a": 2})
    assert json.loads(path.read_text()) == {"a": 2}
    assert names(tmp_path) == ["run.json"]
