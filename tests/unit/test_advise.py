"""`advise`: what it takes from the measured table, what it says of the scene, and when it warns."""

import copy
import re

import numpy as np
import pytest

from mpm_taichi import cli, load_scene
from mpm_taichi.advise import advise, differences, shipped
from mpm_taichi.traits import Traits, traits
from tests.command_line import SCENES

KIND = Traits(
    dimension=1, laws=("neo_hookean",), per_axis=2.0, across=20.0, motion=30.0, strain=0.05,
    walls=False, bodies=1, known=True,
)  # fmt: skip


def row(scheme, level, error, seconds, **others):
    return {
        "experiment": "free_bar_riding", "scheme": scheme, "precision": "f64", "level": level,
        "across": 20.0 * 2**level, "errors": {"displacement": error, "stress": error and 2 * error},
        "cpu_seconds": seconds, "failure": None,
    } | others  # fmt: skip


@pytest.fixture
def table():
    """One validation scene, three schemes, of which one does not converge and one fails."""
    return {
        "date": "2026-01-02 03:04:05+0000", "machine": "a machine", "commit": "abc",
        "experiments": {"free_bar_riding": {"what": "a bar", "traits": KIND._asdict()}},
        "rows": [
            row("cubic mls", 0, 0.008, 4.0), row("cubic mls", 1, 0.002, 16.0),
            row("quadratic mls", 0, 0.03, 1.0), row("quadratic mls", 1, 0.009, 2.0),
            row("linear flip", 0, 0.009, 0.5), row("linear flip", 1, 0.4, 1.0),
            row("quadratic pic", 0, None, None, errors={}, failure="blew up"),
        ],
    }  # fmt: skip


@pytest.fixture
def riding():
    return load_scene(SCENES / "free_bar_riding.yaml")


def listed(text):
    """(cost, error %, cells across, scheme) of each line of evidence."""
    line = r"^  (\S+) +(\S+) % +(\S+) +(\w.*), f64(.*)$"
    return [
        (float(c), float(e), float(n), s, note)
        for c, e, n, s, note in re.findall(line, text, re.MULTILINE)
    ]


def test_cheapest_first(riding, table):
    """At 1 %: one line a scheme, its cheapest run that is good enough, costs over that of the
    first; 0.5 s, 2 s and 4 s are 1, 4 and 8."""
    found = listed(advise(riding, "displacement", 0.01, table))
    assert [entry[:4] for entry in found] == [
        (1.0, 0.9, 20.0, "linear flip"), (4.0, 0.9, 40.0, "quadratic mls"),
        (8.0, 0.8, 20.0, "cubic mls"),
    ]  # fmt: skip


def test_luck_is_told(riding, table):
    """A scheme that is good on one grid and worse on a finer one is marked, the others are not."""
    notes = {s: note for *_, s, note in listed(advise(riding, "displacement", 0.01, table))}
    assert "got worse with smaller cells" in notes.pop("linear flip")
    assert set(notes.values()) == {""}


def test_what_did_not_reach_it(riding, table):
    text = advise(riding, "displacement", 0.01, table)
    assert "did not reach it: quadratic pic f64 (failed)" in text


def test_another_quantity(riding, table):
    """Stress errors are twice as large: only the finest cubic run is below 0.5 %."""
    found = listed(advise(riding, "stress", 0.005, table))
    assert [(e, s) for _, e, _, s, _ in found] == [(0.4, "cubic mls")]


def test_no_evidence_is_said(riding, table):
    """Below all errors: no line of evidence, the nearest result, and the sentence."""
    text = advise(riding, "displacement", 1e-4, table)
    assert listed(text) == []
    assert "nothing reached it; the least error is 0.2 %, of cubic mls with 40 cells" in text
    assert "no evidence: nothing reached 0.01 % in the displacement on any scene" in text


def test_motion_through_cells_warns_of_the_linear_basis(riding, table):
    """With the errors of the linear basis as evidence; not for the bar at rest with an amplitude
    of 1e-4 cells."""
    words = (
        "the linear basis is not shown to converge there: on free_bar_riding 0.9 % with 20, 40 %"
    )
    assert words in advise(riding, "displacement", 0.01, table)
    still = load_scene(SCENES / "manufactured_1d.yaml")
    assert "not shown to converge" not in advise(still, "displacement", 0.01, table)


def test_what_no_validation_scene_has_is_told(table):
    """Two linear elastic disks that collide: another law, contact, 2D."""
    scene = load_scene(SCENES / "two_disks_lattice.yaml")
    text = advise(scene, "displacement", 0.01, table)
    assert "no validation scene has the law linear_elastic" in text
    assert "no validation scene has bodies that touch" in text
    assert "no validation scene is 2D" in text
    assert "unlike this scene: law linear_elastic" in text


def test_strain_beyond_all(riding, table):
    """The bar is strained by 5 %; a table of 1 % is no evidence for it."""
    table["experiments"]["free_bar_riding"]["traits"]["strain"] = 0.01
    assert "is beyond that of all validation scenes (0.01 at most)" in advise(
        riding, "displacement", 0.01, table
    )


def test_the_likest_scene_comes_first(riding, table):
    """Of two validation scenes, that which differs in fewer respects, wherever it stands."""
    other = copy.deepcopy(table["experiments"]["free_bar_riding"])
    other["traits"] |= {"motion": 0.1, "strain": 1e-4}
    table["experiments"] = {"still": other} | table["experiments"]
    text = advise(riding, "displacement", 0.01, table)
    assert text.index("\nfree_bar_riding:") < text.index("\nstill:")


def test_advice_leaves_the_scene_alone(riding, table):
    before = riding.model_dump()
    advise(riding, "displacement", 0.01, table)
    assert riding.model_dump() == before


def test_traits_of_a_riding_bar(riding):
    """From its exact solution: 3 m/s for 1.05 s over 0.05 m are 63 cells, and the ends swing by up
    to 0.05 / pi m; strain 0.05."""
    kind = traits(riding)
    assert kind.known
    assert 63 < kind.motion < 63 + 2 * 0.05 / np.pi / 0.05
    assert kind.strain == pytest.approx(0.05, rel=0.01)
    assert (kind.dimension, kind.per_axis, kind.bodies) == (1, 2, 1)
    assert kind.across == pytest.approx(20)


def test_traits_of_two_disks():
    """Estimates: sqrt(0.02) m/s for 3.5 s over 0.05 m are 9.9 cells; speed over wave speed,
    c^2 = (lam + 2 mu) / rho = 1346 / 1000 m^2/s^2."""
    kind = traits(load_scene(SCENES / "two_disks_lattice.yaml"))
    assert not kind.known
    assert kind.motion == pytest.approx(np.hypot(0.1, 0.1) * 3.5 / 0.05)
    assert kind.strain == pytest.approx(np.hypot(0.1, 0.1) / 1.346154**0.5, rel=1e-6)
    assert (kind.dimension, kind.laws, kind.bodies) == (2, ("linear_elastic",), 2)


def test_a_fall_is_no_strain_without_walls(tmp_path):
    """g t^2 / 2 in cells; strain g L / c^2 with a floor, to rounding 0 without."""
    falls = [
        "gravity=[0,-10]", "time.end=0.1", "output.every=0.1",
        "bodies[0].velocity=[0,0]", "bodies[1].velocity=[0,0]",
    ]  # fmt: skip
    free = traits(load_scene(SCENES / "two_disks_lattice.yaml", falls))
    assert free.motion == pytest.approx(0.5 * 10 * 0.1**2 / 0.05)
    assert free.strain < 1e-12
    walls = load_scene(SCENES / "two_disks_lattice.yaml", [*falls, "domain.walls=slip"])
    assert traits(walls).strain == pytest.approx(10 * 0.375 / 1.346154, rel=0.1)


def test_an_easier_scene_has_no_differences():
    """Less motion, strain and dimension, no walls, more particles: all evidence holds."""
    easier = KIND._replace(motion=0.0, strain=0.001, per_axis=3.0)
    assert differences(easier, KIND) == []
    assert len(differences(KIND, easier)) == 3


@pytest.mark.parametrize("wrong", ["5", "0", "-1%", "nan", "150%", "a few", "%"])
def test_an_error_that_is_none(wrong, capsys):
    """Exit code 2, with what would be right."""
    with pytest.raises(SystemExit) as found:
        cli.main(["advise", str(SCENES / "free_bar.yaml"), f"--error={wrong}"])
    assert found.value.code == 2
    assert "must be a part such as 1% or 0.01" in capsys.readouterr().err


def test_the_shipped_table(capsys):
    """On the command line, 1% and 0.01 are the same, and the table that is shipped has evidence
    for the bar that rides."""
    said = []
    for error in ("1%", "0.01"):
        arguments = ["advise", str(SCENES / "free_bar_riding.yaml"), "--error", error]
        assert cli.main(arguments) == 0
        said.append(capsys.readouterr().out)
    assert said[0] == said[1]
    assert "quadratic mls" in said[0]
    assert {row["experiment"] for row in shipped()["rows"]} == shipped()["experiments"].keys()


def test_help_and_other_words(capsys):
    """The options may stand before the scene."""
    scene = str(SCENES / "free_bar.yaml")
    assert cli.main(["advise", "--quantity", "stress", "--error", "5%", scene]) == 0
    assert "error of the stress of at most 5 %" in capsys.readouterr().out
