"""Runs that die, are stopped, or fail: what is left, and how they go on."""

import json
import shutil
import signal
import subprocess
import sys
import time

import pytest

from mpm_taichi import checkpoints
from mpm_taichi.cli import main
from tests.command_line import SCENES, environment, in_words, mpm_taichi

LATTICE = SCENES / "two_disks_lattice.yaml"
FINE = ("time.step=2.5e-4", "output.every=0.25")
SAVING = ("output.images={size: 160}", "output.checkpoints=0.2")
LONG = (*FINE, *SAVING, "time.end=1.5")
"""6000 steps, a row of history each, until a third of a second after the disks have met."""
MORE = {
    "two_disks_lattice": FINE,
    "dam_break": ("domain.cells=[48, 24]", "time.end=0.2", "output.every=0.02"),
    "sod": ("time.step=2e-5", "output.every=0.02"),
    "spinning_disk": ("time.step=auto", "method.precision=f32", "time.end=1", "output.every=0.1"),
    "snowball": ("domain.cells=[48, 48]", "time.end=0.12", "output.every=0.01"),
    "sand_column": ("domain.cells=[80, 16]", "time.end=0.3", "output.every=0.02"),
}


def words(scene, changes, folder):
    changed = [word for change in changes for word in ("--set", change)]
    return [str(scene), *changed, "-q", "-o", str(folder)]


def start(scene, changes, folder):
    command = [sys.executable, "-m", "mpm_taichi", *words(scene, changes, folder)]
    return subprocess.Popen(command, env=environment(), stderr=subprocess.PIPE, text=True)


def is_under_way(process, folder) -> bool:
    """Waits for a checkpoint; False where the run was faster."""
    give_up = time.monotonic() + 200
    while not list((folder / "checkpoints").glob("step_*.sha256")):
        if process.poll() is not None:
            return False
        assert time.monotonic() < give_up, "the run writes no checkpoint"
        time.sleep(0.01)
    return True


def results(folder):
    """Bytes of the tables and pictures of a run."""
    names = ["history.csv", "errors.csv", *(f"frames/{p.name}" for p in folder.glob("frames/*"))]
    return {name: (folder / name).read_bytes() for name in names if (folder / name).exists()}


def killed_and_resumed(scene, changes, folder, times, rng):
    """The run folder of a run that was killed `times` times, at random moments."""
    process, kills = start(scene, changes, folder), 0
    while is_under_way(process, folder) and kills < times:
        time.sleep(float(rng.uniform(0, 1.5)))
        process.kill()
        process.communicate()
        if json.loads((folder / "run.json").read_text())["status"] == "done":
            break
        kills += 1
        command = [sys.executable, "-m", "mpm_taichi", "--resume", str(folder), "-q"]
        process = subprocess.Popen(command, env=environment(), stderr=subprocess.PIPE, text=True)
    _, err = process.communicate(timeout=300)
    print(f"{kills} kills; {err}")
    assert process.returncode in (0, -signal.SIGKILL)
    assert "Traceback" not in err
    return kills


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """A run that nobody disturbs."""
    folder = tmp_path_factory.mktemp("whole") / "run"
    done = mpm_taichi(*words(LATTICE, LONG, folder))
    assert done.returncode == 0, done.stderr
    return folder


@pytest.mark.slow
def test_killed_runs_go_on_as_if_nothing_had_been(whole, tmp_path, rng):
    """kill -9 at a random moment, twice: history and pictures of the resumed run are the bytes of
    the undisturbed one, without gap or duplicate, and run.json tells of the processes before."""
    kills = killed_and_resumed(LATTICE, LONG, tmp_path / "run", 2, rng)
    assert results(tmp_path / "run") == results(whole)
    report = json.loads((tmp_path / "run" / "run.json").read_text())
    assert report["status"] == "done"
    assert 1 <= len(report["processes_before"]) <= kills  # one killed early has left no report
    assert report["warnings"] == json.loads((whole / "run.json").read_text())["warnings"]


@pytest.mark.campaign
@pytest.mark.parametrize("scene", MORE)
def test_many_kills(scene, tmp_path, rng):
    """The same with twenty kills, of other laws, transfers and precisions."""
    path, changes = SCENES / f"{scene}.yaml", (*MORE[scene], *SAVING)
    done = mpm_taichi(*words(path, changes, tmp_path / "whole"))
    assert done.returncode == 0, done.stderr
    kills = 0
    while kills < 20:
        kills += killed_and_resumed(path, changes, tmp_path / "run", 20 - kills, rng)
        assert results(tmp_path / "run") == results(tmp_path / "whole")
        shutil.rmtree(tmp_path / "run")


@pytest.mark.slow
def test_ctrl_c_saves_and_says_how_to_go_on(whole, tmp_path):
    """Ctrl-C: exit code 130, a checkpoint of the step of the report, and the command that goes on;
    it ends with the results of the undisturbed run.  Then there is nothing left to go on with."""
    folder = tmp_path / "run"
    process = start(LATTICE, LONG, folder)
    assert is_under_way(process, folder)
    process.send_signal(signal.SIGINT)
    _, err = process.communicate(timeout=100)
    assert process.returncode == 130
    assert f"to go on: python -m mpm_taichi --resume {folder}" in err
    report = json.loads((folder / "run.json").read_text())
    saved = checkpoints.newest(folder / "checkpoints")
    assert saved is not None
    assert saved.meta["simulation"]["step_count"] == report["steps"]
    other = mpm_taichi("--resume", folder, "--set", "time.step=2e-4", "-q")
    assert other.returncode == 2
    assert "not the same as when the run was saved: scene" in other.stderr
    assert mpm_taichi("--resume", folder, "-q").returncode == 0
    assert results(folder) == results(whole)
    again = mpm_taichi("--resume", folder)
    assert (again.returncode, again.stderr) == (2, f"--resume {folder}: the run is done\n")


def mount(folder, size) -> bool:
    """A file system of that size there, or another size of the one that is; root alone may."""
    new = "size" if not folder.is_mount() else "remount,size"
    command = ["mount", "-t", "tmpfs", "-o", f"{new}={size}", "tmpfs", str(folder)]
    return subprocess.run(command, capture_output=True).returncode == 0


@pytest.mark.campaign
def test_a_full_disk_ends_a_run_that_goes_on_when_there_is_room(whole, tmp_path):
    """A file system that fills up at the tenth picture or so: exit code 1 and a sentence, the last
    checkpoint whole, no part of a file; with more room it ends as the undisturbed run."""
    disk = tmp_path / "disk"
    disk.mkdir()
    if not mount(disk, "420k"):
        pytest.skip("mounting needs root")
    try:
        full = mpm_taichi(*words(LATTICE, (*LONG, "output.snapshots=false"), disk / "run"))
        print(full.stderr)
        assert full.returncode == 1
        assert "No space left on device" in full.stderr
        assert in_words(full.stderr)
        assert not list(disk.rglob("*.part"))
        assert checkpoints.newest(disk / "run" / "checkpoints") is not None
        assert mount(disk, "20m")
        assert mpm_taichi("--resume", disk / "run", "-q").returncode == 0
        assert results(disk / "run") == results(whole)
    finally:
        subprocess.run(["umount", str(disk)], check=True)


FAILING = (
    "time.step=0.0125",
    "time.enforce=false",
    "time.end=2",
    "output.every=0.05",
    "output.images=none",
)


@pytest.mark.slow
def test_a_run_that_blows_up_is_tried_again_with_shorter_steps(tmp_path):
    """Hat functions have no stable step for slivers of matter in a cell: with half of the bulk
    limit a particle is turned inside out.  The run goes back and ends with steps half as long or
    shorter, and says so; its history has no row of the attempt that failed."""
    done = mpm_taichi(*words(LATTICE, FAILING, tmp_path / "run"))
    print(done.stderr)
    assert done.returncode == 0, done.stderr
    report = json.loads((tmp_path / "run" / "run.json").read_text())
    assert 1 <= len(report["failures"]) <= 5
    assert "is turned inside out: det F = " in report["failures"][0]["error"]
    assert report["failures"][0]["steps_shortened_to"] == 1.0
    assert any("what followed has shorter steps" in warning for warning in report["warnings"])
    rows = (tmp_path / "run" / "history.csv").read_text().splitlines()[1:]
    times = [float(row.split(",")[0]) for row in rows]
    assert times == sorted(set(times))
    assert times[-1] == 2.0


@pytest.mark.slow
def test_a_particle_that_leaves_is_named_and_shown(tmp_path):
    """A disk thrown out of a domain without walls: no step helps, and two attempts find that out.
    Exit code 1; trouble.json has the particle, its state and the attempts, surroundings.png shows
    where, and `replay` fails again at the same step by the same particle."""
    folder = tmp_path / "run"
    changes = ("bodies[0].velocity=[-1, 0]", "output.images=none", "time.end=1")
    failed = mpm_taichi(*words(LATTICE, changes, folder))
    print(failed.stderr)
    assert failed.returncode == 1
    assert in_words(failed.stderr)
    assert "has left the domain [1.0, 1.0]" in failed.stderr
    assert f"to see it again: python -m mpm_taichi replay {folder}" in failed.stderr
    told = json.loads((folder / "trouble" / "trouble.json").read_text())
    assert len(told["failures"]) == 2
    particle = told["particle"]
    assert (particle["body"], particle["material"], particle["det_F"]) == (
        "lower", "rubber", pytest.approx(1),
    )  # fmt: skip
    assert particle["position"][0] < 0
    picture = (folder / "trouble" / "surroundings.png").read_bytes()
    assert picture.startswith(b"\x89PNG")
    again = mpm_taichi("replay", folder)
    assert again.returncode == 1
    assert "it fails again, the same particle, at the same step" in again.stderr


def test_nothing_to_go_on_with(tmp_path, capfd):
    """No folder, no run, a run without checkpoint, a damaged report: sentences and exit code 2."""
    run = tmp_path / "run"
    run.mkdir()
    cases = [
        (("--resume", tmp_path / "none"), "is no folder of a run; name the folder of one"),
        (("replay", run), "holds no run that failed (no trouble/trouble.json)"),
        (("--resume", run, "-o", "x"), "leave out -o, --overwrite"),
        (("--resume", run, "--frames", "3"), "leave out --frames"),
        ((LATTICE, "--force"), "--force: is for --resume RUN"),
        (("run",), "name a scene file"),
    ]
    for arguments, text in cases:
        assert main([*map(str, arguments)]) == 2
        assert text in capfd.readouterr().err
    (run / "run.json").write_text("{")
    assert main(["--resume", str(run)]) == 2
    assert "run.json: cannot be read" in capfd.readouterr().err
    (run / "run.json").write_text('{"status": "running"}')
    assert main(["--resume", str(run)]) == 2
    assert "the run has no checkpoint" in capfd.readouterr().err
