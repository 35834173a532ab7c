"""What the README shows runs: its Python, its commands, its options."""

import re
import shlex

import pytest

from mpm_taichi import cli
from mpm_taichi.commands import COMMANDS
from tests.command_line import ROOT, SCENES

TEXT = (ROOT / "README.md").read_text(encoding="utf-8")
CALL = "python -m mpm_taichi"
EXAMPLES = re.findall(r"```python\n(.*?)```", TEXT, re.DOTALL)
PLACES = {"SCENE": "scenes/two_disks_lattice.yaml", "RUN": "runs/two_disks-001"}
"""What stands for a file of the reader's."""

TINY = ["--set", "time.end=0.002", "--set", "output.every=0.001", "--set", "output.images=none"]
CHEAP = {"run": TINY, "new": [], "list": [], "check": ["--no-time"], "advise": [], "materials": [],
         "schema": []}  # fmt: skip
"""Commands that are carried out here, and what makes them quick.  The others have tests of their
own: they start many processes or compile much."""


def commands() -> list[list[str]]:
    """The words after CALL, of each line of a block and of each `...` in the text; a word in
    brackets may be left out, so that such a line is two."""
    blocks = "\n".join(re.findall(r"```sh\n(.*?)```", TEXT, re.DOTALL))
    lines = [line for line in blocks.splitlines() if line.startswith(CALL)]
    lines += [code for code in re.findall(r"`([^`\n]+)`", TEXT) if code.startswith(f"{CALL} ")]
    found = []
    for line in lines:
        words = shlex.split(line, comments=True)[3:]
        found.append([word for word in words if not word.startswith("[")])
        if any(word.startswith("[") for word in words):
            found.append([word.strip("[]").replace("NAME", "snow") for word in words])
    named = (tuple(str(PLACES.get(word, word)) for word in words) for words in found)
    return list(map(list, dict.fromkeys(named)))


@pytest.fixture
def beside_the_scenes(tmp_path, monkeypatch):
    """An empty folder with scenes/ in it, as a reader has it."""
    (tmp_path / "scenes").symlink_to(SCENES, target_is_directory=True)
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.parametrize("number", range(len(EXAMPLES)))
def test_the_python_of_the_readme_runs(beside_the_scenes, capfd, number):
    """Each block by itself, word for word; each prints something, and the error that a comment
    promises."""
    assert len(EXAMPLES) >= 3
    exec(compile(EXAMPLES[number], f"README.md, block {number}", "exec"), {"__name__": "readme"})
    out = capfd.readouterr().out
    assert out.strip()
    for promised in re.findall(r"print\(error\)  # (.*)", EXAMPLES[number]):
        assert promised in out


@pytest.mark.parametrize("words", commands(), ids=" ".join)
def test_the_commands_of_the_readme_are_commands(beside_the_scenes, capfd, words):
    """The parser takes each; the quick ones run, with exit code 0."""
    options = cli.parse(words)
    if options.command in CHEAP and "--resume" not in words:
        assert cli.main([*words, *CHEAP[options.command]]) == 0, capfd.readouterr().err


def test_every_command_is_in_the_readme():
    """What is not told of is not found."""
    assert {cli.parse(words).command for words in commands()} == COMMANDS.keys()


def test_the_options_of_the_readme_exist():
    """Each `--word` in the sections on use and on trouble is an option of a command, or of pip, apt
    or git in a line of theirs."""
    known = {
        option
        for command in cli.parser()[1]
        for action in command._actions
        for option in action.option_strings
    }
    for section in ("## Use", "## Troubleshooting"):
        text = TEXT.split(f"\n{section}\n")[1].split("\n## ")[0]
        for code in re.findall(r"`([^`\n]+)`", text):
            if not code.startswith(("sudo", "pip", "gmsh")):
                assert set(re.findall(r"--[a-z][a-z0-9-]*", code)) <= known, code
