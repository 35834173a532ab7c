"""Particles of each output: recorded, foreseen on the disk, and read back or refused in words."""

import html
import json
import re
import zipfile
from pathlib import Path

import numpy as np
import pytest

from mpm_taichi import Simulation, cli, disk_space, load_scene, notebook
from mpm_taichi.arrays_file import write_arrays
from mpm_taichi.errors import InputError
from mpm_taichi.history_table import read_history
from mpm_taichi.player import player
from mpm_taichi.recorders import Snapshots
from mpm_taichi.recorders.snapshots import has_plastic_strain, wants_snapshots
from mpm_taichi.recording import Recording
from tests.command_line import SCENES

SCENE = SCENES / "two_disks_lattice.yaml"
CHANGES = ("time.end=0.004", "output.every=0.001", "output.images=none", "bodies[0].velocity=[X,Y]")


WORDS = [word for change in CHANGES for word in ("--set", change)]


@pytest.fixture(scope="module")
def moments(tmp_path_factory):
    """A run folder, and the Snapshots of the same run."""
    folder = tmp_path_factory.mktemp("recorded") / "run"
    assert cli.main([str(SCENE), "-q", "-o", str(folder), *WORDS]) == 0
    simulation = Simulation(load_scene(SCENE, CHANGES))
    return folder, [now.snapshot for now in simulation.frames()]


@pytest.fixture
def spoilt(moments, tmp_path):
    """A copy of the run folder that a test may damage."""
    folder = tmp_path / "run"
    for path in moments[0].rglob("*"):
        if path.is_file():
            copy = folder / path.relative_to(moments[0])
            copy.parent.mkdir(parents=True, exist_ok=True)
            copy.write_bytes(path.read_bytes())
    return folder


def test_a_recording_is_what_the_run_was(moments):
    """Each array is that of the run's Snapshot to float32, 6e-8; times and steps are the same
    numbers; the kinetic energy is 1/2 m v^2 and adds up to that of the history, 1e-6 for float32
    terms."""
    folder, snapshots = moments
    recording = Recording(folder)
    assert len(recording) == len(snapshots) == 5
    assert recording.times.tolist() == [now.time for now in snapshots]
    assert recording.body_names == ["lower", "upper"]
    assert recording.body.tolist() == [0] * 208 + [1] * 208
    assert recording.report["status"] == "done"
    table = recording.history
    for frame, now in zip(recording, snapshots, strict=True):
        assert (frame.time, frame.step) == (now.time, now.step)
        wanted = {
            "speed": now.speed, "pressure": now.pressure, "stress": now.von_mises_stress,
            "density": now.density,
        }  # fmt: skip
        assert frame.scalars.keys() == wanted.keys()
        for name, values in wanted.items():
            assert frame.scalars[name] == pytest.approx(values, rel=3e-7, abs=1e-30), name
        assert frame.position == pytest.approx(now.position, rel=6e-8)
        assert frame.velocity == pytest.approx(now.velocity, rel=6e-8)
        at = table["time"].tolist().index(frame.time)
        assert frame.kinetic_energy.sum() == pytest.approx(table["kinetic_energy"][at], rel=1e-6)
    assert recording[-1].step == recording[4].step
    with pytest.raises(IndexError):
        recording[5]


def test_a_notebook_plays_it(moments, monkeypatch):
    """`_repr_html_` is the page of `export --html`, in a frame of its own that may run scripts and
    nothing else; of a recording that is too long every few frames, and the words that say so; of
    one with too many particles the words alone."""
    folder, _ = moments
    recording = Recording(folder)
    shown = recording._repr_html_()
    frame = re.fullmatch(r'<iframe sandbox="allow-scripts" [^<>]*srcdoc="([^"]*)"></iframe>', shown)
    assert frame and html.unescape(frame[1]) == player(recording).html
    monkeypatch.setattr(notebook, "MOST_POINTS", 416 * 2)
    shown = recording._repr_html_()
    assert html.escape(player(recording, 3).html) in shown
    said = "1 of 3 frames is shown, of 5 in all; the others: python -m mpm_taichi export"
    assert f"{said} {folder}" in shown
    monkeypatch.setattr(notebook, "MOST_POINTS", 415)
    shown = recording._repr_html_()
    assert "416 particles are too many for a notebook" in shown and "iframe" not in shown


def test_the_disk_space_is_foreseen(moments):
    """run.json and the folder agree to 3 %: what a file takes beside its numbers is rounded up."""
    folder, _ = moments
    written = sum(path.stat().st_size for path in (folder / "snapshots").iterdir())
    foreseen = Recording(folder).report["disk"]["snapshots"]
    assert 0.97 * foreseen < written <= 1.03 * foreseen


def test_plastic_strain_is_recorded_where_a_law_has_it():
    """Of steel, not of rubber; a material that no body is made of does not count."""
    assert has_plastic_strain(load_scene(SCENES / "taylor_bar.yaml"))
    assert not has_plastic_strain(load_scene(SCENE, ["materials.other={preset: mild_steel}"]))


def test_snapshots_are_made_up_to_200000_particles_unless_the_scene_says_otherwise():
    scenes = {said: load_scene(SCENE, [f"output.snapshots={said}"]) for said in ("true", "false")}
    assert wants_snapshots(load_scene(SCENE), 200_000)
    assert not wants_snapshots(load_scene(SCENE), 200_001)
    assert wants_snapshots(scenes["true"], 10**9)
    assert not wants_snapshots(scenes["false"], 1)


def test_a_full_disk_is_refused_before_the_run(tmp_path, monkeypatch, capfd):
    """Exit code 2; how much is needed, of what, and what would help; nothing is made."""
    monkeypatch.setattr(disk_space.shutil, "disk_usage", lambda _: type("", (), {"free": 10**6}))
    folder = tmp_path / "deep" / "run"
    assert cli.main([str(SCENE), "-o", str(folder), *WORDS]) == 2
    said = capfd.readouterr().err
    assert "would write 69.3 KiB of particles, 69.3 KiB of them snapshots, and 977 KiB" in said
    assert "--set output.snapshots=false" in said
    assert not folder.parent.exists()
    assert (
        cli.main([str(SCENE), "-qo", str(folder), *WORDS, "--set", "output.snapshots=false"]) == 0
    )
    assert not (folder / "snapshots").exists()
    with pytest.raises(InputError, match=r"run .*run/scene\.yaml --set output\.snapshots=true"):
        Recording(folder)


def test_a_recorder_goes_on_where_its_state_says(spoilt, moments):
    """Files beyond the state, of a run that was cut off later, are removed; the next has the next
    number."""
    simulation = Simulation(load_scene(SCENE, CHANGES))
    recorder = Snapshots(spoilt / "snapshots", simulation, {"count": 2})
    assert len(Recording(spoilt)) == 2
    recorder.record(simulation, is_output=False)
    assert recorder.state() == {"count": 2}
    recorder.record(simulation, is_output=True)
    assert recorder.state() == {"count": 3}
    assert [frame.step for frame in Recording(spoilt)] == [0, moments[1][1].step, 0]


def test_damage_is_told_in_words(spoilt):
    """A file cut off, a byte changed, another shape, one missing: an InputError that names the
    file, never a traceback and never wrong numbers."""
    snapshots = spoilt / "snapshots"
    path = snapshots / "snapshot_0001.npz"
    whole = path.read_bytes()

    def refused(match):
        with pytest.raises(InputError, match=match):
            list(Recording(spoilt))

    for length in (0, 3, 200, len(whole) // 2, len(whole) - 1):
        path.write_bytes(whole[:length])
        refused(r"snapshot_0001\.npz: the recording is damaged \(.+\); run the scene again")
    flipped = bytearray(whole)
    flipped[len(whole) // 2] ^= 1
    path.write_bytes(flipped)
    refused(r"snapshot_0001\.npz.*CRC")
    with np.load(snapshots / "snapshot_0000.npz") as file:
        arrays = dict(file)
    np.savez(path, **(arrays | {"position": arrays["position"][1:]}))
    refused(r"snapshot_0001\.npz.*does not hold 416 particles in 2D")
    del arrays["pressure"]
    np.savez(path, **arrays)
    refused(r"snapshot_0001\.npz.*does not hold 416 particles in 2D")
    path.unlink()
    refused(r"snapshot_0001\.npz.*missing")


def test_what_is_no_run_is_told(tmp_path):
    """Nothing there, a file, a folder without run.json, one that is no JSON."""
    (tmp_path / "file").write_text("")
    (tmp_path / "other").mkdir()
    (tmp_path / "odd").mkdir()
    (tmp_path / "odd" / "run.json").write_text("{")
    for name, said in (
        ("none", "is no folder of a run"), ("file", "is no folder of a run"),
        ("other", r"has no run\.json, so it is no run"), ("odd", "cannot be read"),
    ):  # fmt: skip
        with pytest.raises(InputError, match=f"{name}.*: {said}"):
            Recording(tmp_path / name)


def test_a_history_that_grows_is_read_up_to_its_last_whole_line(tmp_path):
    """Cut off anywhere, as a reader may find it during a run: the rows before; words in a column
    stay words.  A row with too few values in the middle is damage."""
    path, text = tmp_path / "history.csv", "time,limit\n0.0,acoustic\n0.5,speed\n"
    table = {}
    for length in range(len(text) + 1):
        path.write_text(text[:length])
        table = read_history(path)
        lines = text[:length].count("\n")
        assert [len(column) for column in table.values()] == [max(0, lines - 1)] * 2 * (lines > 0)
    assert table["time"].tolist() == [0.0, 0.5]
    assert table["limit"].tolist() == ["acoustic", "speed"]
    path.write_text(text + "1.0\n2.0,speed\n")
    with pytest.raises(InputError, match=r"history\.csv:4: has 1 values for 2 columns"):
        read_history(path)
    with pytest.raises(InputError, match="is missing"):
        read_history(Path(tmp_path / "none.csv"))


def test_arrays_read_back(tmp_path, rng):
    """NumPy and zipfile read what is written, checksums too: numbers, an empty array, one that is
    not contiguous; and the same arrays make the same bytes."""
    arrays = {
        "time": np.float64(rng.normal()),
        "step": np.int64(7),
        "none": np.zeros((0, 3), np.float32),
        "body": rng.integers(0, 200, 1000).astype(np.uint8),
        "position": rng.normal(size=(2, 1000)).astype(np.float32).T,
    }
    paths = tmp_path / "a.npz", tmp_path / "b.npz"
    for path in paths:
        write_arrays(path, **arrays)
    assert paths[0].read_bytes() == paths[1].read_bytes()
    with zipfile.ZipFile(paths[0]) as archive:
        assert archive.testzip() is None
    with np.load(paths[0]) as file:
        assert file.files == list(arrays)
        for name, values in arrays.items():
            assert file[name].dtype == values.dtype and file[name].shape == np.shape(values)
            assert (file[name] == values).all()


def test_files_appear_whole(spoilt):
    """A part that a killed run left is not taken for a frame, and --overwrite removes it."""
    part = spoilt / "snapshots" / "snapshot_0005.npz.part"
    part.write_bytes(b"PK")
    assert len(Recording(spoilt)) == 5
    assert cli.main([str(SCENE), "-qo", str(spoilt), "--overwrite", *WORDS]) == 0
    assert not part.exists()
    assert json.loads((spoilt / "run.json").read_text())["status"] == "done"
