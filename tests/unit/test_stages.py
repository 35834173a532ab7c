"""The stages of steps: recorded, in the page, and clicked through in headless Chromium."""

import base64
import shutil
import struct
import zlib
from itertools import pairwise
from types import SimpleNamespace

import numpy as np
import pytest

from mpm_taichi import cli, load_scene
from mpm_taichi.arrays_file import write_arrays
from mpm_taichi.errors import InputError
from mpm_taichi.player import player
from mpm_taichi.player.page import template
from mpm_taichi.recorders.stages import stages_bytes
from mpm_taichi.recording import Recording
from mpm_taichi.reference import bases
from mpm_taichi.reference.kernels.stencil import stencil
from mpm_taichi.stage_formulas import stage_names
from tests.command_line import SCENES
from tests.recorded_run import turning_disk, write_run

from .test_player import decoded, text_of
from .test_player_in_browser import Shown, browser

__all__ = ["browser"]
LATTICE = SCENES / "two_disks_lattice.yaml"
DX = 0.05
CHANGES = [
    "output.stages=true", "output.every=0.05", "time.end=0.1", "output.images=none",
    'bodies[0].velocity=["0.1 + Y", "X"]',
]  # fmt: skip
NAMES = ["particles to nodes", "grid update", "nodes to particles", "reset"]


@pytest.fixture(scope="module")
def recording(tmp_path_factory):
    """Three outputs of two disks, of which one shears and turns."""
    folder = tmp_path_factory.mktemp("stages") / "run"
    words = [word for change in CHANGES for word in ("--set", change)]
    assert cli.main([str(LATTICE), "-q", "--threads", "1", "-o", str(folder), *words]) == 0
    return Recording(folder)


@pytest.fixture(scope="module")
def shown(browser, recording, tmp_path_factory):
    film = player(recording)
    shown = Shown(browser, film, tmp_path_factory.mktemp("page") / "player.html", has_touch=True)
    yield shown
    assert shown.faults == []
    shown.page.context.close()


def nodes_of(name, x, domain, half_width):
    """By the twin: place (x / dx), x_i - x, weight and gradient of the nodes of a particle at x."""
    basis = getattr(bases, name)
    dx = domain["size"][0] / domain["cells"][0]
    walled = tuple(
        (axis, upper)
        for axis, rules in enumerate(domain["walls"])
        for upper, rule in enumerate(rules)
        if rule not in ("none", "periodic")
    )
    grid = SimpleNamespace(
        dim=2, cells=domain["cells"], dx=dx, ghost=basis.support, walled=walled
    )  # fmt: skip
    particles = SimpleNamespace(x=np.array([x], float), half_width=[half_width])
    for place, r, w, dw in stencil(0, particles, grid, basis):
        yield tuple(int(i) - grid.ghost for i in place), r, w, dw


def test_recorded_nodes_carry_all_particles(recording):
    """In each output, the last one too, the nodes have the mass and the momentum of all particles,
    and the gain is that of the nodes by FLIP, for each particle, to the 6e-8 of float32; the disk
    space that was foreseen is enough, and no more than ten times what it takes."""
    assert len(recording) == 3
    for k, frame in enumerate(recording):
        stages = recording.stages(k)
        assert stages.dt == pytest.approx(1e-3)
        assert stages.node_mass.sum() == pytest.approx(recording.mass.sum(), rel=1e-6)
        momentum = (frame.mass[:, None] * frame.velocity).sum(axis=0)
        given = (stages.node_mass[:, None] * stages.node_velocity[0]).sum(axis=0)
        assert given == pytest.approx(momentum, rel=1e-6)
        old, new = (
            dict(zip(map(tuple, stages.place.tolist()), velocities, strict=True))
            for velocities in stages.node_velocity.astype(float)
        )
        domain = {"size": [1, 1], "cells": [20, 20], "walls": [["none"] * 2] * 2}
        for p in range(0, len(recording.body), 40):
            stencil = list(nodes_of("Linear", frame.position[p], domain, 0.25))
            gain = sum(w * (new[place] - old[place]) for place, _, w, _ in stencil)
            assert stages.velocity_gain[p] == pytest.approx(gain, abs=1e-6)
    folder = recording.folder / "stages"
    largest = max(path.stat().st_size for path in folder.iterdir())
    assert largest < stages_bytes(recording.scene, len(recording.body)) < 10 * largest
    assert recording.report["disk"]["stages"] > 3 * largest


def test_the_page_has_what_was_recorded(recording):
    """Numbers of particles to 2^-11, half precision, or 2^-40 of the largest of their kind; those
    of nodes exactly; the check sum goes on over the blocks of nodes."""
    film = player(recording)
    header, channels = decoded(film.html)
    walk, halves = header["walk"], [channel.view(np.float16) for channel in channels[-11:]]
    assert walk["lengths"] == pytest.approx([1e-3] * 3)
    assert [stage["name"] for stage in walk["stages"]] == NAMES
    text = "".join(text_of(film.html, f"data-nodes-{k}") for k in range(header["nodeBlocks"]))
    nodes, at = zlib.decompress(base64.b64decode(text)), 0
    for k, frame in enumerate(recording):
        stages = recording.stages(k)
        kinds = {
            "velocity": frame.velocity, "gain": stages.velocity_gain,
            "stress": stages.cauchy_stress, "gradient": stages.displacement_gradient.reshape(-1, 4),
        }  # fmt: skip
        column = 0
        for name, values in kinds.items():
            scale = walk["scales"][name]
            for told in values.T.astype(float):
                page = halves[column][k].astype(float) * scale
                assert page == pytest.approx(told, rel=2**-11, abs=2**-25 * scale)
                column += 1
        (count,) = struct.unpack_from("<I", nodes, at)
        parts = (stages.place, "<i4"), (stages.node_mass, "<f4"), (stages.node_velocity, "<f4")
        at += 4
        for values, kind in parts:
            page = np.frombuffer(nodes, kind, values.size, at).reshape(values.shape)
            assert len(stages.place) == count and (page == values).all()
            at += page.nbytes
    assert at == len(nodes)
    crc = 0
    for k in range(3):
        for channel in channels:
            crc = zlib.crc32(channel[k].astype(channel.dtype.newbyteorder("<")).tobytes(), crc)
    assert f"{zlib.crc32(nodes, crc):08x}" == film.checksum == header["checksumWritten"]


def test_a_run_that_was_cut_off_has_a_page(recording, tmp_path):
    """The stages of the last frame may be missing, as of a run that goes on: it has no step.  A
    file of another run is refused."""
    folder = tmp_path / "run"
    shutil.copytree(recording.folder, folder)
    last = folder / "stages" / "stage_0002.npz"
    last.unlink()
    film = player(Recording(folder))
    assert decoded(film.html)[0]["walk"]["lengths"] == pytest.approx([1e-3, 1e-3, 0])
    arrays = dict(np.load(folder / "stages" / "stage_0001.npz"))
    write_arrays(last, **arrays | {"velocity_gain": np.zeros((7, 2), np.float32)})
    with pytest.raises(InputError, match=r"stage_0002\.npz: the recording is damaged"):
        player(Recording(folder))


def numbers(text: str) -> list[float]:
    """The numbers in a text of the page."""
    for sign, plain in (("\u2212", "-"), ("< 0.001", "0"), (",", " ")):
        text = text.replace(sign, plain)
    return [float(word) for word in text.split() if word[-1].isdigit()]


def entries(value) -> list[float]:
    """Of a matrix."""
    cells = value.locator(".matrix span").all_inner_texts()
    return [float(cell.replace("\u2212", "-")) for cell in cells]


def table(shown) -> dict[tuple[int, ...], list[float]]:
    """Weight, mass and velocity by the place of a node."""
    rows = shown.page.locator("#walk-nodes tr").all_inner_texts()[1:-1]
    return {tuple(map(int, found[:2])): found[2:] for found in map(numbers, rows)}


def test_stages_are_walked(shown, recording):
    """Stages shows the first stage of the particle in the middle; Step walks the stages, then goes
    on to the next frame; the arrow keys go both ways, a key and the button end it, the view is as
    before; a click picks another particle.  What is told are the numbers of the run: weights to
    their three digits and the 1 / 65534 of the domain to which places are known, the rest to three
    digits."""
    page = shown.page
    assert shown.ask("player.checksum") == player(recording).checksum
    shown.slide("#seek", 1)
    view = shown.ask("player.page.camera.view")
    shown.picture()
    page.click("#walk-button")
    assert page.get_attribute("#walk-button", "aria-pressed") == "true"
    shown.ask("player.page.pick(60)")
    frame, stages, p = recording[1], recording.stages(1), 60
    place = dict(zip(map(tuple, stages.place.tolist()), range(len(stages.place)), strict=True))
    domain = {"size": [1, 1], "cells": [20, 20], "walls": [["none"] * 2] * 2}
    mine = list(nodes_of("Linear", frame.position[p], domain, 0.25))
    titles, pictures = [], []
    for number, name in enumerate(NAMES):
        pictures.append(shown.picture())
        titles.append(shown.text("#walk-title"))
        assert titles[-1] == f"Stage {number + 1} of 4: {name}"
        told = table(shown) if number < 3 else {}
        if number < 3:
            assert set(told) == {node for node, _, _, _ in mine}
            assert shown.text("#walk-nodes tr:last-child").split()[-1] == "1.000"
        factor = 1e-3 if "[mm/s]" in shown.text("#walk-nodes") else 1.0
        for node, _, w, _ in mine if told else ():
            i, (weight, mass, *v) = place[node], told[node]
            assert weight == pytest.approx(w, abs=0.0012)
            assert mass == pytest.approx(stages.node_mass[i], rel=6e-3)
            velocity = stages.node_velocity[min(number, 1)][i]
            assert np.array(v) * factor == pytest.approx(velocity, rel=6e-3, abs=1e-6)
        symbols = page.locator("#walk-numbers dt").all_inner_texts()
        values = dict(zip(symbols, page.locator("#walk-numbers dd").all(), strict=True))
        if number == 0:
            assert symbols == ["mp", "xp", "vp", "\u03c3p", "Fp"]
            F = np.eye(2) + stages.displacement_gradient[p]
            assert entries(values["Fp"]) == pytest.approx(F.ravel(), rel=1e-3, abs=1e-5)
        if number == 2:
            L = np.sum(
                [np.outer(stages.node_velocity[1][place[i]], dw) for i, _, _, dw in mine], axis=0
            )
            assert entries(values["Lp"]) == pytest.approx(L.ravel(), abs=2e-3 * np.abs(L).max())
            v = frame.velocity[p] + stages.velocity_gain[p]
            told = shown.ask(f"player.page.walk.moment(1, {p}).v")
            assert told == pytest.approx(v, rel=1e-3)
        page.click("#step")
    assert all((a != b).any() for a, b in pairwise(pictures))
    assert shown.frame == 2
    shown.picture()
    assert shown.text("#walk-title") == titles[0]
    page.locator("#stage").focus()
    page.keyboard.press("ArrowLeft")
    shown.picture()
    assert shown.frame == 1 and shown.text("#walk-title") == titles[3]
    page.keyboard.press("ArrowRight")
    assert shown.frame == 2
    box = page.locator("#stage").bounding_box()
    page.locator("#stage").click(position={"x": 0.5 * box["width"] + 60, "y": 0.4 * box["height"]})
    shown.picture()
    assert shown.ask("player.page.picked") != p and not page.is_visible("#log")
    page.keyboard.press("s")
    shown.picture()
    assert not page.is_visible("#walk") and shown.ask("player.page.camera.view") == view
    page.keyboard.press("ArrowLeft")
    assert shown.frame == 1


def test_start_and_reset_amid_stages(shown):
    """Reset goes to the first stage of the first frame; playing goes by frames, without a drawing,
    and Escape ends the walk."""
    page = shown.page
    page.click("#walk-button")
    page.click("#step")
    page.click("#reset")
    shown.picture()
    assert shown.frame == 0 and shown.text("#walk-title").startswith("Stage 1 of 4")
    faint = "document.getElementById('particles').classList.contains('faint')"
    assert shown.ask(faint)
    shown.slide("#speed", 1)
    page.click("#play")
    shown.until(f"player.page.playing && !{faint}")
    shown.until("!player.page.playing")
    assert shown.frame == 2
    page.locator("#stage").focus()
    page.keyboard.press("Escape")
    shown.picture()
    assert not page.is_visible("#walk")


@pytest.mark.parametrize(
    "name",
    ["Linear", "GIMP", "QuadraticBSpline", "CubicBSpline", "QuadraticBoundary", "CubicBoundary"],
)
def test_weights_of_the_page_are_those_of_the_twin(shown, rng, name):
    """Anywhere in a domain with walls on some sides: nodes, weights and gradients, to rounding."""
    domain = {"size": [1.0, 0.75], "cells": [8, 6], "walls": [["slip", "none"], ["none", "sticky"]]}
    dx, half = 0.125, float(rng.uniform(0.1, 0.5))
    points = rng.random((40, 2)) * domain["size"]
    word = getattr(bases, name).name
    script = template("bases.js")
    found = shown.page.evaluate(
        f"([domain, points]) => {{ {script} return points.map("
        f"x => stencilOf('{word}', x, {half * dx}, domain)); }}",
        [domain, points.tolist()],
    )
    for x, its in zip(points, found, strict=True):
        twins = list(nodes_of(name, x, domain, half))
        assert [tuple(node["place"]) for node in its] == [place for place, _, _, _ in twins]
        for node, (_, _, w, dw) in zip(its, twins, strict=True):
            assert node["w"] == pytest.approx(w, abs=1e-13)
            assert node["dw"] == pytest.approx(dw, abs=1e-11)


def test_a_page_without_stages_says_how_to_get_them(browser, tmp_path, rng):
    """In 2D the button tells; in 3D, where there are none, it is not there."""
    run = write_run(tmp_path / "flat", "two_disks_lattice", [], turning_disk(2, 10, rng))
    shown = Shown(browser, player(Recording(run)), tmp_path / "flat.html")
    shown.page.click("#walk-button")
    shown.picture()
    assert "--set output.stages=true" in shown.text("#walk-note")
    shown.page.click("#step")
    assert shown.frame == 1
    shown.page.context.close()
    x = rng.random((2, 10, 3)) * 0.5
    run = write_run(tmp_path / "solid", "two_balls", [], x)
    shown = Shown(browser, player(Recording(run)), tmp_path / "solid.html")
    assert not shown.page.is_visible("#walk-button")
    shown.page.context.close()


def test_scenes_that_cannot_have_stages():
    """3D scenes, and runs without the snapshots to which the stages belong."""
    with pytest.raises(InputError, match=r"output\.stages: is for 2D scenes"):
        load_scene(SCENES / "two_balls.yaml", ["output.stages=true"])
    with pytest.raises(InputError, match=r"output\.stages: needs the snapshots"):
        load_scene(LATTICE, ["output.stages=true", "output.snapshots=false"])
    assert stage_names(load_scene(LATTICE)) == tuple(NAMES)
