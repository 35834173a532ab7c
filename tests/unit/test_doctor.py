"""`doctor`: what works here, told also where things crash."""

import json
import re
import sys
from pathlib import Path

import pytest

from mpm_taichi import cli, doctor
from tests.command_line import ROOT


def fake_python(folder: Path, script: str) -> str:
    """A program in place of Python."""
    path = folder / "python"
    path.write_text(f"#!/bin/sh\n{script}\n")
    path.chmod(0o755)
    return str(path)


def test_the_cpu_works():
    """In a process of its own: both precisions, with logarithms, and the folder of the cache."""
    answers, fault = doctor.probe("cpu")
    assert fault is None
    assert [said for said in answers if "precision" in said] == [
        {"precision": "f32", "logarithm": True}, {"precision": "f64", "logarithm": True},
    ]  # fmt: skip
    assert answers[0]["cache"]


@pytest.mark.skipif(sys.platform == "win32", reason="needs a shell")
@pytest.mark.parametrize(
    "script, said",
    [
        ("kill -SEGV $$", "crashes (signal 11)"),
        ("echo '{\"a\": 1}'; echo cannot open >&2; exit 1", "fails: cannot open"),
        ("echo '{\"a\": 1}'; exec sleep 30", "no answer within 0.3 s"),
    ],
)
def test_a_probe_that_ends_badly(tmp_path, monkeypatch, script, said):
    """A crash, an error and an endless wait are words; answers given before are kept."""
    monkeypatch.setattr(sys, "executable", fake_python(tmp_path, script))
    answers, fault = doctor.probe("window", timeout=0.3 if "sleep" in script else 60)
    assert fault == said
    assert answers == ([{"a": 1}] if "echo" in script else [])


@pytest.mark.skipif(sys.platform == "win32", reason="needs a shell")
def test_a_computer_on_which_everything_crashes(tmp_path, monkeypatch, capfd):
    """Every probe dies of a signal: doctor tells so, for each backend, with exit code 1, and asks
    for all libraries.  Its JSON says the same."""
    monkeypatch.setattr(sys, "executable", fake_python(tmp_path, "kill -SEGV $$"))
    monkeypatch.setenv("DISPLAY", ":0")
    assert cli.main(["doctor"]) == 1
    out = capfd.readouterr().out
    for name in ("cpu", "cuda", "vulkan", "window"):
        assert re.search(rf"-- +{name} +crashes \(signal 11\)", out), name
    assert "sudo apt-get install libx11-6" in out
    assert cli.main(["doctor", "--json"]) == 1
    found = json.loads(capfd.readouterr().out)
    assert found["backends"]["cpu"] == {"works": [], "notes": ["crashes (signal 11)"]}
    assert found["window"] == {"opens": False, "note": "crashes (signal 11)"}
    assert found["cores"] >= 1


def test_what_is_missing_is_named_with_its_command(monkeypatch, capfd):
    """A package, a library, a display, a cache that cannot be written: each with what brings it;
    exit code 0 as the cpu works.  A device with f64 but without its functions says so."""
    answers = {
        "cpu": [{"cache": "/proc/none/cache"}, {"precision": "f64", "logarithm": True}],
        "vulkan": [{"precision": "f64", "logarithm": False}],
        "cuda": [{"precision": p, "fault": "Arch is not supported"} for p in ("f32", "f64")],
        "libraries": [{"library": "libX11.so.6", "loads": True}],
    }
    monkeypatch.setattr(doctor, "probe", lambda word, *_: (answers.get(word, []), None))
    monkeypatch.setattr(doctor, "installed", lambda name: None if name == "matplotlib" else "1")
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.setattr(sys, "platform", "linux")
    assert cli.main(["doctor"]) == 0
    out = capfd.readouterr().out
    for line in (
        r"  ok  cpu +f64\n",
        r"  --  cuda +no such device, or no driver\n",
        r"  ok  vulkan +f64; f64 without log, exp, sin",
        r"  --  window +there is no display \(DISPLAY is not set\); pictures, videos",
        r'  --  matplotlib +optional, for .*: pip install "matplotlib>=3.8"\n',
        r"  ok  Taichi\n",
        r"  --  gmsh: sudo apt-get install libglu1-mesa libgl1",
        r"cache /proc/none/cache: cannot be written, .*TI_OFFLINE_CACHE_FILE_PATH=DIR\n",
    ):
        assert re.search(line, out), line


def test_requirements_are_those_of_the_project():
    """Each package as pyproject.toml asks for it; none that it requires is missing."""
    text = (ROOT / "pyproject.toml").read_text()
    for package in doctor.PACKAGES:
        assert f'"{package.requirement}"' in text, package
    required = text.split("dependencies = [")[1].split("\n]")[0]
    names = {re.match(r"[\w.-]+", word).group() for word in re.findall(r'"([^"]+)"', required)}  # type: ignore[union-attr]
    assert names == {package.name for package in doctor.PACKAGES if not package.is_optional}
