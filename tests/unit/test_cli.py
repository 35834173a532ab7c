"""The command line: exit codes, what goes to stdout and stderr, what a user is told."""

import json
import signal
import subprocess
import sys
import time
from pathlib import Path
from types import SimpleNamespace

import pytest

from mpm_taichi import cli, load_scene, report, run_folder
from mpm_taichi.commands import COMMANDS
from mpm_taichi.commands import run as run_command
from mpm_taichi.interruption import Interrupted, Interruption
from mpm_taichi.recorders import History
from tests.command_line import SCENES, environment, history, in_words, mpm_taichi

LATTICE = SCENES / "two_disks_lattice.yaml"
SHORT = ("--set", "time.end=0.05", "--set", "output.images=none")
TINY = ("--set", "time.end=0.002", "--set", "output.every=0.001", "--set", "output.images=none")
STAGES = {"sort", "whole_steps", "update_stress", "guard", "clear", "fold_ghosts"}
"""Of a scene with few particles; the last two of the look for nodes too light for the step."""


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    """A run of 50 steps with pictures and --json, in its own process: result and run folder."""
    folder = tmp_path_factory.mktemp("finished")
    result = mpm_taichi(
        "--json", LATTICE, "-o", "out", "--set", "time.end=0.05", "--set", "output.every=0.02",
        "--set", "output.history.every_steps=15", "--set", "output.images.size=200", cwd=folder,
    )  # fmt: skip
    return result, folder / "out"


def test_json_is_all_that_is_on_stdout(finished):
    """Exit code 0; stdout parses as JSON and is run.json: no banner, no progress, no warning."""
    result, folder = finished
    assert result.returncode == 0, result.stderr
    assert json.loads(result.stdout) == json.loads((folder / "run.json").read_text())


def test_progress_is_on_stderr(finished):
    """What runs, on what, with which step and why, that kernels are compiled, and the end."""
    lines = finished[0].stderr.splitlines()
    for words in (
        "lower: 208 particles", "cpu f64, threads 1; 20 x 20 cells", "time step 0.001 s: given",
        "compiling kernels", "kernels are ready", "done: t = 0.05 s after 50 steps",
    ):  # fmt: skip
        assert any(line.startswith(words) for line in lines), words
    assert not any("[Taichi]" in line for line in lines)


def test_outputs_end_at_the_end(finished):
    """Outputs every 0.02 s up to 0.05: pictures at 0, 0.02, 0.04 and 0.05; rows every 15 steps and
    at each output, none twice.  Output times are exact: k times the interval, and the end."""
    _, folder = finished
    assert sorted(path.name for path in (folder / "frames").iterdir()) == [
        f"frame_{k:04d}.png" for k in range(4)
    ]
    table = history(folder)
    assert table["step"].tolist() == [0, 15, 20, 30, 40, 45, 50]
    for row, t in ((0, 0.0), (2, 0.02), (4, 2 * 0.02), (6, 0.05)):
        assert table["time"][row] == t


def test_the_folder_describes_its_run(finished):
    """The scene as it ran, changes included; status, versions, machine, device, steps, seeding, and
    the time of each stage, which is part of the whole."""
    result, folder = finished
    scene = load_scene(folder / "scene.yaml")
    assert scene == load_scene(
        LATTICE,
        ["time.end=0.05", "output.every=0.02", "output.history.every_steps=15",
         "output.images.size=200"],
    )  # fmt: skip
    content = json.loads(result.stdout)
    assert (content["status"], content["error"], content["steps"]) == ("done", None, 50)
    assert content["time"] == 0.05
    assert content["command"][:3] == ["--json", str(LATTICE), "-o"]
    assert (content["device"], content["precision"], content["threads"]) == ("cpu", "f64", 1)
    assert {"mpm_taichi", "python", "taichi", "numpy"} <= content["versions"].keys()
    assert content["time_step"]["chosen_by"] == "scene"
    assert content["time_step"]["longest"] == pytest.approx(1e-3, rel=1e-12)
    assert [limit["name"] for limit in content["time_step"]["limits_at_start"]] == [
        "acoustic", "travel",
    ]  # fmt: skip
    assert [body["particles"] for body in content["seeding"]] == [208, 208]
    timing = content["timing"]
    assert timing["first_calls_seconds"].keys() == STAGES
    assert timing["stage_seconds"].keys() >= {"whole_steps"}
    spent = [*timing["first_calls_seconds"].values(), *timing["stage_seconds"].values()]
    assert min(spent) > 0
    assert sum(spent) < content["wall_seconds"] + timing["first_calls_seconds"]["update_stress"]
    assert timing["sorts"] >= 1


def test_the_report_says_what_was_kept(finished):
    """Conservation: 260 kg, no momentum, 2.6 J of free flight; start, end and change of each."""
    result, folder = finished
    kept, table = json.loads(result.stdout)["conservation"], history(folder)
    assert kept.keys() == {
        "mass", "momentum_x", "momentum_y", "angular_momentum",
        "kinetic_energy", "elastic_energy", "dissipated_energy", "gravitational_energy",
    }  # fmt: skip
    for name, entry in kept.items():
        assert entry["start"] == table[name][0]
        assert entry["end"] == table[name][-1]
        assert entry["change"] == entry["end"] - entry["start"]
    assert kept["mass"]["change"] == 0
    assert kept["mass"]["start"] == pytest.approx(260, rel=1e-13)
    assert kept["kinetic_energy"]["end"] == pytest.approx(2.6, rel=1e-12)


@pytest.fixture(scope="module")
def stopped(tmp_path_factory):
    """Two runs at once, one ended by Ctrl-C and one by SIGTERM when they are well under way."""
    folder = tmp_path_factory.mktemp("stopped")
    runs = {}
    for number in (signal.SIGINT, signal.SIGTERM):
        command = [
            sys.executable, "-m", "mpm_taichi", str(LATTICE), "--set", "output.images=none",
            "-o", str(folder / number.name),
        ]  # fmt: skip
        runs[number] = subprocess.Popen(
            command, env=environment(), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
        )
    results = {}
    for number, process in runs.items():
        table = folder / number.name / "history.csv"
        give_up = time.monotonic() + 120
        while not (table.exists() and table.stat().st_size) and process.poll() is None:
            assert time.monotonic() < give_up, "the run does not start"
            time.sleep(0.02)
        process.send_signal(number)
        out, err = process.communicate(timeout=120)
        results[number] = (process.returncode, out, err, folder / number.name)
    return results


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_ends_the_run_between_two_steps(stopped, number):
    """Exit code 128 + number (130, 143); run.json says interrupted and by what; history.csv is
    whole: a row per step up to the step of the report, each with all its columns."""
    code, out, err, folder = stopped[number]
    assert code == 128 + number
    assert out == ""
    assert in_words(err)
    assert f"interrupted: by {number.name}" in err
    content = json.loads((folder / "run.json").read_text())
    assert (content["status"], content["error"]) == ("interrupted", f"by {number.name}")
    text = (folder / "history.csv").read_text()
    assert text.endswith("\n")
    assert {line.count(",") for line in text.splitlines()} == {18}
    table = history(folder)
    assert table["step"].tolist() == list(range(content["steps"] + 1))
    assert table["time"][-1] == content["time"] < 3.5
    assert content["conservation"]["mass"]["change"] == 0


def test_a_second_signal_acts_at_once():
    """Within one step that does not end; afterward signals do again what they did before."""
    before = [signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)]
    still = SimpleNamespace(stop_asked=False)
    with Interruption() as interruption:
        interruption.record(still, is_output=False)
        signal.raise_signal(signal.SIGTERM)
        with pytest.raises(Interrupted) as found:
            interruption.record(still, is_output=False)
        assert (found.value.exit_code, found.value.is_between) == (143, True)
        assert still.stop_asked
        with pytest.raises(Interrupted) as found:
            signal.raise_signal(signal.SIGINT)
        assert (found.value.exit_code, found.value.is_between) == (130, False)
    assert [signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)] == before


def test_ctrl_c_before_the_run(monkeypatch):
    """While a scene is read or meshed there is nothing to save: exit code 130."""
    monkeypatch.setattr(run_command, "execute", lambda options: signal.raise_signal(signal.SIGINT))
    assert cli.main([str(LATTICE)]) == 130


WATCHED = """
import json, sys, threading
from pathlib import Path
sockets, threads = [], []
sys.addaudithook(lambda event, _: sockets.append(event) if event.startswith("socket.") else None)
start = threading.Thread.start
def noted(self):
    threads.append(getattr(self, "_target", None).__qualname__ if self._target else self.name)
    start(self)
threading.Thread.start = noted
from mpm_taichi.cli import main
code = main(sys.argv[1:])
links = [str(link.readlink()) for link in Path("/proc/self/fd").glob("*") if link.is_symlink()]
print(json.dumps({"code": code, "sockets": sockets, "threads": threads,
                  "links": [link for link in links if link.startswith("socket:")],
                  "modules": sorted(sys.modules)}))
"""


@pytest.fixture(scope="module")
def watched(tmp_path_factory):
    """What a run without mesh and pictures did inside its process."""
    folder = tmp_path_factory.mktemp("watched")
    program = folder / "program.py"
    program.write_text(WATCHED)
    result = subprocess.run(
        [sys.executable, str(program), str(LATTICE), *SHORT, "-o", str(folder / "out")],
        env=environment(), stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=120,
    )  # fmt: skip
    assert result.returncode == 0, result.stderr
    lines = result.stdout.splitlines()
    assert len(lines) == 1, "a run without --json prints nothing on stdout"
    return json.loads(lines[0]) | {"folder": folder / "out"}


def test_nothing_is_posted_anywhere(watched):
    """No socket is opened, and the thread with which ti.init posts to a version server is not
    started, though the environment of the user says nothing about it."""
    assert watched["code"] == 0
    assert "taichi" in watched["modules"]
    assert watched["sockets"] == []
    assert watched["links"] == []
    assert not any("version" in target for target in watched["threads"]), watched["threads"]


def test_a_run_imports_only_what_it_needs(watched):
    """No mesh: no gmsh, no meshio.  No pictures: no renderer, no Pillow, no folder of frames."""
    loaded = set(watched["modules"])
    assert {"gmsh", "meshio", "PIL", "matplotlib"}.isdisjoint(loaded)
    assert not any(name.startswith("mpm_taichi.renderers") for name in loaded)
    assert sorted(path.name for path in watched["folder"].iterdir()) == [
        "history.csv", "run.json", "scene.yaml", "snapshots",
    ]  # fmt: skip


def test_help_does_not_wait_for_taichi(capfd):
    """--help and --version need no Taichi, and a wrong word is refused without it."""
    program = (
        "import sys\nfrom mpm_taichi.cli import main\n"
        "try:\n    code = main(sys.argv[1:])\nexcept SystemExit as end:\n    code = end.code\n"
        "assert 'taichi' not in sys.modules and 'numpy' not in sys.modules\nsys.exit(code)"
    )
    for words, code in ((["--help"], 0), (["--version"], 0), (["rnu", "x.yaml"], 2)):
        command = [sys.executable, "-c", program, *words]
        assert subprocess.run(command, env=environment()).returncode == code
    out, err = capfd.readouterr()
    assert "mpm_taichi 0." in out
    assert "Traceback" not in err


def test_a_library_that_is_missing(tmp_path):
    """Where libX11 is not installed, `import taichi` fails with the loader's words: exit code 2,
    and the command that installs it."""
    fake = tmp_path / "taichi" / "__init__.py"
    fake.parent.mkdir()
    message = "libX11.so.6: cannot open shared object file: No such file or directory"
    fake.write_text(f"raise ImportError({message!r})")
    result = mpm_taichi(
        LATTICE, cwd=tmp_path, PYTHONPATH=f"{tmp_path}:{environment()['PYTHONPATH']}"
    )
    assert result.returncode == 2
    assert result.stdout == ""
    assert in_words(result.stderr)
    assert "libX11.so.6" in result.stderr
    assert "apt-get install libx11-6" in result.stderr


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["rnu", "x.yaml"], "'rnu' is neither a command nor a .yaml file; did you mean 'run'?"),
        (["chekc", "x.yaml"], "did you mean 'check'?"),
        (
            ["x.txt"],
            f"'x.txt' is neither a command nor a .yaml file ({', '.join(COMMANDS)})",
        ),
        ([str(SCENES / "two_disk.yaml")], "there is no such file; did you mean"),
        (["run", str(SCENES)], "is a folder, not a scene file"),
        ([], "the following arguments are required: COMMAND"),
        (["run"], "name a scene file: python -m mpm_taichi SCENE.yaml"),
        ([str(LATTICE), "--frames", "0"], "must be a whole number from 1 on (got '0')"),
        ([str(LATTICE), "--threads", "-1"], "must be a whole number from 1 on (got '-1')"),
        ([str(LATTICE), "--threads", "1025"], "--threads: at most 1024 (got 1025)"),
        ([str(LATTICE), "--device", "gpu"], "invalid choice: 'gpu'"),
        ([str(LATTICE), "--set", "time.ned=1"], "did you mean 'end'?"),
        ([str(LATTICE), "--overwrit", "-q"], "unrecognized arguments: --overwrit"),
    ],
)  # fmt: skip
def test_bad_input_is_refused_in_words(tmp_path, monkeypatch, capfd, words, said):
    """Exit code 2, a sentence on stderr, nothing on stdout, no traceback, no folder made."""
    monkeypatch.chdir(tmp_path)
    try:
        code = cli.main(words)
    except SystemExit as end:  # argparse's way
        code = end.code
    out, err = capfd.readouterr()
    assert code == 2
    assert out == ""
    assert in_words(err)
    assert said in err
    assert list(tmp_path.iterdir()) == []


def test_another_architecture_in_the_environment(monkeypatch, capfd):
    """TI_ARCH overrides what a program asks Taichi for, silently: refused where it differs."""
    monkeypatch.setenv("TI_ARCH", "cuda")
    assert cli.main(["check", str(LATTICE)]) == 2
    assert "TI_ARCH=cuda, which overrides --device cpu: unset it" in capfd.readouterr().err
    monkeypatch.setenv("TI_ARCH", "x64" if sys.platform != "darwin" else "arm64")


def test_check_shows_the_plan(tmp_path, monkeypatch, capfd):
    """On stderr: particles, device, step, number of steps and outputs, and the time from its first
    steps unless told not to; no folder is made.

    A step above the limit is refused, here acoustic: 0.76 0.9 dx / (c + |v|) with c^2 = 1.346
    (nu = 0.3, E = rho) and |v| = 0.1414 is 0.0263; or warned of, where the scene asks to have it as
    it is.  The disks blow up with it, which is told too."""
    monkeypatch.chdir(tmp_path)
    words = ["--frames", "7", "check", str(LATTICE), "--set", "time.step=0.05"]
    words += ["--set", "output.images=none"]
    assert cli.main(words) == 2
    assert "longer than the acoustic limit of 0.02627 s" in capfd.readouterr().err
    assert cli.main([*words, "--set", "time.enforce=false"]) == 0
    out, err = capfd.readouterr()
    assert out == ""
    assert "lower: 208 particles" in err
    assert "warning: time.step is 1.9 times the acoustic limit 0.0263 s (material rubber)" in err
    assert "about 70 steps to t = 3.5 s, 7 outputs after the start" in err
    assert "warning: the run fails in its first steps: t = " in err
    assert cli.main(["check", str(LATTICE), *TINY]) == 0
    assert "\ntime: about " in capfd.readouterr().err
    assert cli.main(["check", str(LATTICE), "--no-time"]) == 0
    assert "first steps" not in capfd.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_a_particle_that_leaves_ends_the_run(tmp_path, capfd):
    """A disk that flies out on the left, at 1.04 m/s: its first column of particles, at 0.0125 m,
    is out after 13 steps of 0.001 s, and, tried again with half of that, after 25.  Exit code 1;
    the message names particle, body, material, step and position, and says what to do; the folder
    holds the second attempt up to there."""
    folder = tmp_path / "out"
    words = [
        str(LATTICE),
        *SHORT,
        "-q",
        "-o",
        str(folder),
        "--set",
        "bodies[0].velocity=[-1.04, 0]",
    ]
    assert cli.main(words) == 1
    out, err = capfd.readouterr()
    assert out == ""
    assert in_words(err)
    for words in (
        "t = 0.0125 s, step 25: particle 0 (body lower, material rubber) has left the domain",
        "[1.0, 1.0]: it is at [-0.0005, 0.1", "walls (domain.walls",
    ):  # fmt: skip
        assert words in err
    content = json.loads((folder / "run.json").read_text())
    assert (content["status"], content["steps"]) == ("failed", 25)
    assert [failure["step"] for failure in content["failures"]] == [13, 25]
    assert "particle 0 (body lower" in content["error"]
    assert history(folder)["step"].tolist() == list(range(25))


def test_a_step_that_gets_nowhere(tmp_path, capfd):
    """More than 2^53 steps to an output, which no clock counts: exit code 1 and words, not a run
    without end; no folder is made."""
    words = [str(LATTICE), "--set", "time.step=1e-30", "-o", str(tmp_path / "out")]
    assert cli.main(words) == 1
    _, err = capfd.readouterr()
    assert in_words(err)
    assert "too short to get to the next output" in err
    assert not (tmp_path / "out").exists()


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs /dev/full")
@pytest.mark.parametrize("name", ["scene.yaml.part", "history.csv"])
def test_a_full_disk(tmp_path, monkeypatch, capfd, name):
    """A write that fails, whichever, ends in exit code 1 and words, never in `done`."""
    (tmp_path / name).symlink_to("/dev/full")
    monkeypatch.setattr(run_folder, "create", lambda *_: tmp_path)
    assert cli.main([str(LATTICE), *TINY]) == 1
    _, err = capfd.readouterr()
    assert in_words(err)
    assert f"failed: writing to {tmp_path} failed: [Errno 28] No space left on device" in err
    assert "done:" not in err


def test_a_folder_that_vanishes(tmp_path, monkeypatch, capfd):
    """Removed while the run is under way: exit code 1 and words."""
    record = History.record

    def remove(self, simulation, is_output):
        record(self, simulation, is_output)
        for path in sorted(tmp_path.glob("out/**/*"), reverse=True):
            path.rmdir() if path.is_dir() else path.unlink()
        if (tmp_path / "out").exists():
            (tmp_path / "out").rmdir()

    monkeypatch.setattr(History, "record", remove)
    words = [str(LATTICE), *TINY, "-o", str(tmp_path / "out")]
    assert cli.main(words) == 1
    _, err = capfd.readouterr()
    assert in_words(err)
    assert f"failed: writing to {tmp_path / 'out'} failed" in err


def test_a_report_without_an_unused_package(monkeypatch):
    """gmsh has no wheel for every machine: a lattice scene runs and reports without it."""
    monkeypatch.setattr(report, "PACKAGES", ("numpy", "no-such-package"))
    assert report.installed("no-such-package") is None
    assert report.installed("numpy")
