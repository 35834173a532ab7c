"""The browser player in headless Chromium: what is seen, and each control.

Needs Debian's `chromium` and `playwright`; without them these tests are skipped, but not in CI."""

import io
import os
import random
import shutil
from dataclasses import replace

import numpy as np
import pytest
from PIL import Image

from mpm_taichi.player import player
from mpm_taichi.recording import Recording
from mpm_taichi.renderers.camera import DISTANCE, Camera, corners, orientation
from tests.missing import missing
from tests.recorded_run import turning_disk, write_run

FLAGS = (
    "--no-sandbox", "--enable-unsafe-swiftshader", "--disable-quic", "--no-first-run",
    "--disable-background-networking", "--disable-component-update", "--disable-sync",
)  # fmt: skip
LEFT, RIGHT, TOP, BOTTOM = 30, 30, 20, 84
"""Pixels around the domain (mpm_taichi/player/template/camera.js)."""

FRAMES = 21


@pytest.fixture(scope="module")
def browser():
    chromium = shutil.which("chromium") or missing("chromium")
    try:
        from playwright.sync_api import sync_playwright
    except ImportError:
        missing("playwright")
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=chromium, args=list(FLAGS))
        yield browser
        browser.close()


class Shown:
    """A player in a page of the browser, and what was wrong in it."""

    def __init__(self, browser, film, path, **context):
        film.write(path)
        self.faults: list[str] = []
        self.page = browser.new_context(
            viewport={"width": 1000, "height": 700}, **context
        ).new_page()
        self.page.on("console", lambda m: self.faults.append(m.text) if m.type == "error" else None)
        self.page.on("pageerror", lambda error: self.faults.append(str(error)))
        self.page.on("request", lambda request: self.faults.append(f"asks for {request.url}"))
        self.page.goto(f"file://{path}")
        self.faults.remove(f"asks for file://{path}")
        self.ask("player.ready")

    def ask(self, expression: str):
        return self.page.evaluate(f"async () => {expression}")

    def until(self, condition: str):
        """Within ten seconds; Playwright's own way to wait is against the policy of the page."""
        for _ in range(500):
            if self.ask(condition):
                return
            self.page.wait_for_timeout(20)
        pytest.fail(f"not within ten seconds: {condition}")

    @property
    def frame(self) -> int:
        return self.ask("player.page.frame")

    def text(self, selector: str) -> str:
        return self.page.locator(selector).inner_text()

    def slide(self, slider: str, value: float):
        self.page.locator(slider).fill(str(value))

    def picture(self) -> np.ndarray:
        """The stage as it is now [rows, columns, 3]."""
        self.ask("new Promise(done => requestAnimationFrame(() => setTimeout(done, 50)))")
        png = self.page.locator("#stage").screenshot()
        return np.asarray(Image.open(io.BytesIO(png)).convert("RGB")).astype(int)

    def log(self, part="numbers") -> dict[str, str]:
        words = self.page.locator(f"#{part} dt").all_inner_texts()
        return dict(zip(words, self.page.locator(f"#{part} dd").all_inner_texts(), strict=True))


def camera_of(size, picture) -> Camera:
    """Python's camera, fitted to a stage as the page says that it does."""
    box = np.asarray(size, float)
    dim, (height, width) = len(box), picture.shape[:2]
    distance = np.inf if dim == 2 else float(DISTANCE * np.linalg.norm(box) / 2)
    camera = Camera(orientation(dim), box / 2, distance)
    seen = camera.pixel_of(corners(box))
    low, high = seen.min(axis=0), seen.max(axis=0)
    room = np.array([width - LEFT - RIGHT, height - TOP - BOTTOM])
    scale = (room / (high - low)).min()
    # the middle of the pixel in column i is i here, and i + 1/2 in the page
    column, row = [LEFT, TOP] + room / 2 - scale * (low + high) / 2 - 0.5
    return replace(camera, scale=scale, column=column, row=row)


def inner(picture) -> np.ndarray:
    """Without the rim, which shows whether the stage has the focus."""
    return picture[12:-12, 12:-12]


def orange_spot(picture, at) -> np.ndarray:
    """Mean place (column, row) of the orange pixels around a place."""
    column, row = np.rint(at).astype(int)
    left, top = column - 12, row - 12
    part = picture[top : row + 13, left : column + 13]
    rows, columns = np.nonzero(part[..., 0] - part[..., 2] > 60)
    assert len(rows) > 20
    return np.array([left + columns.mean(), top + rows.mean()])


@pytest.fixture(scope="module")
def two_d(browser, tmp_path_factory):
    """A disk of 300 particles in 2D, one of which is deleted on the way; 21 frames in 2 s."""
    seed = int(os.environ.get("MPM_TAICHI_SEED", random.randrange(2**31)))
    print(f"seed {seed}: repeat with MPM_TAICHI_SEED={seed}")
    rng = np.random.default_rng(seed)
    folder = tmp_path_factory.mktemp("player")
    x = turning_disk(FRAMES, 300, rng)
    stress = 100 * np.abs(x).sum(axis=2)
    x[15:, 3] = np.nan
    changes = ["output.images={color_by: stress, grid: 0.5}"]
    run = write_run(folder / "run", "two_disks_lattice", changes, x, {"stress": stress})
    film = player(Recording(run))
    shown = Shown(browser, film, folder / "player.html", has_touch=True)
    yield shown, film, x
    shown.page.context.close()


def test_decoded_frames_are_those_of_python(two_d):
    """The check sum that the page computes of what it has decoded is Python's, and it says so; no
    error, no warning of its policy, no request."""
    shown, film, _ = two_d
    assert shown.ask("player.checksum") == film.checksum
    assert (
        f"{film.checksum}: the frames are as they were written"
        in shown.page.locator("#integrity").text_content()
    )
    assert shown.faults == []
    assert shown.page.title() == "Two elastic disks, lattice particles"


def test_step_reset_and_keys(two_d):
    """Step and the arrows move by a frame, Home and End to the ends, the bar to any; the clock
    shows the frame; beyond the last frame there is none."""
    shown, _, _ = two_d
    page = shown.page
    page.click("#reset")
    page.click("#step")
    page.click("#step")
    assert shown.frame == 2
    shown.slide("#seek", 12)
    assert shown.frame == 12
    shown.picture()
    assert shown.text("#clock").split() == ["1.2", "s", "·", "frame", "13", "of", "21"]
    page.locator("#stage").focus()
    for key, frame in (("ArrowRight", 13), ("ArrowLeft", 12), ("End", 20), ("ArrowRight", 20)):
        page.keyboard.press(key)
        assert shown.frame == frame
    page.keyboard.press("Home")
    assert shown.frame == 0
    page.locator("#seek").focus()
    page.keyboard.press("ArrowRight")
    assert shown.frame == 1
    page.click("#reset")
    assert shown.frame == 0


def test_start_and_stop_follow_the_clock(two_d):
    """2 s of the run at 1 s per second take 2 s of the clock, and at most one more on a busy
    machine; the button says what it does next; the space key does the same; at the end it stops,
    and starts over."""
    shown, _, _ = two_d
    page = shown.page
    page.click("#reset")
    assert shown.text("#speed-text") == "0.2 s per second"
    shown.slide("#speed", 0.7)
    assert shown.text("#speed-text") == "1 s per second"
    assert shown.text("#play") == "Start"
    page.click("#play")
    assert shown.text("#play") == "Stop"
    began = shown.ask("performance.now()")
    shown.until("!player.page.playing")
    assert 1800 < shown.ask("performance.now()") - began < 3000
    assert shown.frame == FRAMES - 1
    page.locator("#stage").focus()
    page.keyboard.press("Space")
    shown.until("player.page.frame > 2 && player.page.frame < 20")
    page.keyboard.press("Space")
    stopped = shown.frame
    assert shown.text("#play") == "Start" and not shown.ask("player.page.playing")
    page.wait_for_timeout(300)
    assert shown.frame == stopped


def test_grid_and_its_opacity(two_d):
    """A line of the grid is seen as much as the opacity says, and not at all when the grid is off;
    so are the numbers of the cells."""
    shown, _, _ = two_d
    page = shown.page
    page.click("#reset")

    def contrast():
        """Of the line between the second and the third row of cells to the left of the disk."""
        picture = shown.picture()
        column, row = camera_of([1, 1], picture).pixel_of([0.12, 0.1])
        part = picture[int(row) - 6 : int(row) + 7, int(column)].sum(axis=-1)
        return part.max() - part.min()

    shown.slide("#opacity", 1)
    full = contrast()
    shown.slide("#opacity", 0.3)
    assert shown.text("#opacity-text") == "30 %"
    assert contrast() == pytest.approx(0.3 * full, abs=6)
    with_grid = shown.picture()
    page.click("#grid")
    assert page.get_attribute("#grid", "aria-pressed") == "false"
    assert contrast() == 0
    page.keyboard.press("g")
    assert (inner(shown.picture()) == inner(with_grid)).all()


def test_picked_particle_and_log(two_d):
    """A click picks the particle that is seen there; the log has its numbers to the precision that
    is recorded, and the sums; Toggle Log hides and shows it."""
    shown, _, x = two_d
    page = shown.page
    page.click("#reset")
    for _ in range(5):
        page.click("#step")
    lone = int(np.linalg.norm(x[5] - 0.5, axis=1).argmax())
    at = camera_of([1, 1], shown.picture()).pixel_of(x[5, lone]) + 0.5
    page.locator("#stage").click(position={"x": float(at[0]), "y": float(at[1])})
    shown.picture()
    log = shown.log()
    assert log["particle"].startswith(f"{lone} (")
    assert log["step"] == "50" and log["time"] == "0.5 s"
    assert log["mass"] == f"{float(f'{1 + lone / 299:.4g}'):g} kg"

    def entries(words):
        return [float(word) for word in words.replace("\u2212", "-").strip("()ms/ ").split(",")]

    assert entries(log["position"].split(")")[0]) == pytest.approx(x[5, lone], rel=6e-4, abs=2e-5)
    v = (x[6, lone] - x[4, lone]) / 0.2
    assert entries(log["velocity"].split(")")[0]) == pytest.approx(v, abs=0.006)
    assert {"von Mises stress", "pressure", "density"} <= log.keys()
    kinetic = 0.5 * (1 + lone / 299) * (v**2).sum()
    number, unit = log["kinetic energy"].split()
    told = float(number) * {"J": 1, "mJ": 1e-3, "\u00b5J": 1e-6}[unit]
    assert told == pytest.approx(kinetic, rel=0.1)
    sums = shown.log("sums")
    assert sums["elastic energy"] == "0.25 J" and sums["gravitational energy"] == "\u22120.5 J"
    assert {"kinetic energy", "total energy"} < sums.keys()
    shown.ask("player.page.pick(3)")
    shown.slide("#seek", 14)
    shown.picture()
    assert shown.log()["particle"].startswith("3 (") and "mass" in shown.log()
    page.click("#step")
    shown.picture()
    assert shown.log()["particle"] == "3, which has left" and "mass" not in shown.log()
    page.click("#log-button")
    assert not page.is_visible("#log")
    page.keyboard.press("l")
    assert page.is_visible("#log") and page.get_attribute("#log-button", "aria-pressed") == "true"
    page.keyboard.press("Escape")
    shown.picture()
    assert shown.log()["particle"] == "click one to see its values"


def test_colors_and_their_legend(two_d):
    """The scene's own quantity comes first; each choice, by the list or the key, changes picture
    and legend."""
    shown, _, _ = two_d
    page = shown.page
    page.click("#reset")
    names = page.locator("#color option").all_inner_texts()
    assert names == ["body", "speed", "von Mises stress", "pressure", "density"]
    assert page.input_value("#color") == "stress"
    assert shown.text("#legend").startswith("von Mises stress [Pa]")
    before = shown.picture()
    page.select_option("#color", "body")
    assert shown.text("#legend").split() == ["lower", "upper"]
    assert (shown.picture() != before).any()
    page.locator("#stage").focus()
    page.keyboard.press("c")
    assert page.input_value("#color") == "speed" and "speed [m/s]" in shown.text("#legend")
    page.select_option("#color", "stress")
    assert (inner(shown.picture()) == inner(before)).all()


def test_energies_with_a_cursor(two_d):
    """The key of the chart has the energies of the frame; pointing at the chart seeks."""
    shown, _, _ = two_d
    shown.slide("#seek", 10)
    shown.picture()
    key = dict(line.split("\n") for line in shown.page.locator(".series").all_inner_texts())
    assert key["elastic"] == "0.5 J" and key["gravitational"] == "\u22121 J"
    assert list(key) == ["kinetic", "elastic", "gravitational", "total"]
    box = shown.page.locator("#chart").bounding_box()
    shown.page.locator("#chart").click(position={"x": 44 + 0.75 * (box["width"] - 52), "y": 60})
    assert shown.frame in (14, 15)


def test_pan_zoom_and_touch(two_d):
    """Dragging moves the picture with the pointer; the wheel and two fingers zoom about where they
    are; a double click and 0 show the whole domain again."""
    shown, _, _ = two_d
    page = shown.page
    stage = page.locator("#stage").bounding_box()
    x, y = stage["x"] + stage["width"] / 2, stage["y"] + stage["height"] / 2
    look = "player.page.camera.look([0.5, 0.5, 0]).slice(0, 2)"
    scale = "player.page.camera.scale"
    home, once = np.array(shown.ask(look)), shown.ask(scale)
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + 40, y - 30, steps=4)
    page.mouse.up()
    assert shown.ask(look) == pytest.approx(home + np.array([40, -30]))
    page.mouse.dblclick(x, y)
    assert shown.ask(look) == pytest.approx(home)
    page.mouse.move(x, y)
    page.mouse.wheel(0, -200)
    shown.until(f"{scale} > 1.01 * {once}")
    factor, at = np.exp(0.5), np.array([x - stage["x"], y - stage["y"]])
    assert shown.ask(scale) == pytest.approx(factor * once)
    assert shown.ask(look) == pytest.approx(at + factor * (home - at), abs=1)
    page.locator("#stage").focus()
    page.keyboard.press("0")
    assert shown.ask(scale) == pytest.approx(once)
    fingers = page.context.new_cdp_session(page)

    def touch(kind, *places):
        points = [{"x": px, "y": py, "id": k} for k, (px, py) in enumerate(places)]
        fingers.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})

    touch("touchStart", (x - 50, y), (x + 50, y))
    for k in range(1, 6):
        touch("touchMove", (x - 50 - 10 * k, y), (x + 50 + 10 * k, y))
    touch("touchEnd")
    assert shown.ask(scale) == pytest.approx(2 * once, rel=0.01)
    page.keyboard.press("0")
    page.keyboard.press("+")
    assert shown.ask(scale) == pytest.approx(1.25 * once)
    page.keyboard.press("-")
    assert shown.ask(look) == pytest.approx(home) and shown.faults == []


@pytest.mark.parametrize("dim", [2, 3])
def test_particles_are_where_python_sees_them(browser, tmp_path, dim, rng):
    """The middle of the spot that a particle leaves on the screen is within a pixel of where
    Python's camera, that of the pictures, sees it; in 3D too, where the shade of a sphere makes the
    edge away from the light a little less visible."""
    changes = ["output.images={color_by: body, grid: 0}"]
    scene, size = ("two_disks_lattice", [1, 1]) if dim == 2 else ("two_balls", [1.2, 0.9, 0.6])
    lattice = np.stack(np.meshgrid(*[np.linspace(0.1, 0.9, 4)] * dim), axis=-1).reshape(-1, dim)
    chosen = rng.choice(len(lattice), 12, replace=False)
    x = ((lattice[chosen] + 0.05 * rng.random((12, dim))) * size)[None]
    run = write_run(tmp_path / "run", scene, changes, np.repeat(x, 2, axis=0))
    shown = Shown(browser, player(Recording(run)), tmp_path / "player.html")
    picture = shown.picture()
    seen = camera_of(size, picture).pixel_of(x[0])
    lonely = [
        p for p in range(1, 12, 2)  # of the second body, which is orange
        if np.sort(np.linalg.norm(seen - seen[p], axis=1))[1] > 30
    ]  # fmt: skip
    assert lonely
    for p in lonely:
        assert orange_spot(picture, seen[p]) == pytest.approx(seen[p], abs=1)
        place = [*x[0, p].tolist(), 0][:3]
        told = shown.ask(f"player.page.camera.look({place}).slice(0, 2)")
        assert told == pytest.approx(seen[p] + 0.5, abs=0.01)
    if dim == 3:
        box = shown.page.locator("#stage").bounding_box()
        at = [box["x"] + 300, box["y"] + 200]
        shown.page.mouse.move(*at)
        shown.page.mouse.down()
        shown.page.mouse.move(at[0] + 90, at[1], steps=3)
        shown.page.mouse.up()
        turned = np.degrees(shown.ask("player.page.camera.view.turn"))
        assert turned == pytest.approx(32 - np.degrees(90 / 180), abs=0.1)
        assert (shown.picture() != picture).any()
    assert shown.faults == []
    shown.page.context.close()


def test_words_of_a_scene_are_never_markup(browser, tmp_path, rng):
    """Tags in title, body names and source are shown as they are written, and run nothing."""
    evil = "<img src=x onerror='window.evil=1'></script><script>window.evil=1</script>"
    changes = [f'title="{evil}"', f'source="{evil}"', f'bodies[0].name="{evil}"']
    changes.append("output.images={color_by: body}")
    run = write_run(tmp_path / "run", "two_disks_lattice", changes, turning_disk(3, 20, rng))
    shown = Shown(browser, player(Recording(run)), tmp_path / "player.html")
    page = shown.page
    page.locator("summary").first.click()
    page.locator("#stage").click(position={"x": 350, "y": 250})
    assert page.title() == shown.text("#title") == evil
    assert evil in shown.text("#legend") and evil in shown.text("#about")
    assert shown.text("#scene").count("onerror") == 3
    assert shown.ask("window.evil") is None and shown.faults == []
    page.context.close()


def test_a_damaged_file_says_so(browser, tmp_path, rng):
    """A changed bit of the frames is told, by the check sum or in the stage; the page stays up."""
    run = write_run(tmp_path / "run", "two_disks_lattice", [], turning_disk(3, 20, rng))
    film = player(Recording(run))
    bad = film.html.replace(f'"checksumWritten":"{film.checksum}"', '"checksumWritten":"00000000"')
    shown = Shown(browser, replace(film, html=bad), tmp_path / "player.html")
    assert "This file is damaged" in shown.page.locator("#integrity").text_content()
    shown.page.context.close()
