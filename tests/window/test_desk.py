"""The window without a window: what buttons, keys and the mouse do to a simulation."""

import contextlib
import re
from types import SimpleNamespace

import numpy as np
import pytest
from PIL import Image

from mpm_taichi import diagnostics
from mpm_taichi.errors import MotionError
from mpm_taichi.recorders import Images
from mpm_taichi.renderers import palette
from mpm_taichi.renderers.camera import corners, fit
from mpm_taichi.scene import Images as Style
from mpm_taichi.window.canvas import draw_canvas
from mpm_taichi.window.gestures import Gestures, keys, particle_at
from mpm_taichi.window.layout import layout_of
from mpm_taichi.window.log import green_strain, log_lines, table
from mpm_taichi.window.looks import COLORS, Looks, looks_of
from mpm_taichi.window.panel import draw_panel
from mpm_taichi.window.playback import Playback
from mpm_taichi.window.scales import Scales
from mpm_taichi.window.sketch import enlargement
from mpm_taichi.window.viewpoint import Viewpoint
from tests.window.desks import desk_in, fields, simulation, stored

END = 0.06
"""Seconds, that is 60 steps."""


@pytest.fixture(scope="module")
def used_desk(tmp_path_factory):
    return desk_in(tmp_path_factory.mktemp("pictures"), f"time.end={END}", "output.every=0.02")


@pytest.fixture
def desk(used_desk):
    """At the start, as it would be in a new window."""
    if used_desk.playback.walk is not None:
        used_desk.playback.toggle_stages()
    used_desk.playback.reset()
    used_desk.playback.steps_per_frame = 5
    used_desk.viewpoint.reset()
    fresh = looks_of(used_desk.playback.simulation.scene)
    for name, value in vars(fresh).items():
        setattr(used_desk.looks, name, value)
    used_desk.notice, used_desk.is_closed = "", False
    return used_desk


class FakeGui:
    """Widgets that the user leaves as they are, but for those named in `answers`."""

    def __init__(self, **answers):
        self.answers, self.labels, self.texts = answers, [], []

    @contextlib.contextmanager
    def sub_window(self, *_):
        yield self

    def _answer(self, label, default):
        self.labels.append(label)
        return self.answers.get(re.sub(r" \(.*|/.*", "", label).replace(" ", "_"), default)

    def button(self, label):
        return self._answer(label, False)

    def checkbox(self, label, value):
        return self._answer(label, value)

    def slider_int(self, label, value, low, high):
        assert low <= value <= high
        return self._answer(label, value)

    slider_float = slider_int

    def text(self, words):
        self.texts.append(words)


def press(desk, **answers) -> FakeGui:
    gui = FakeGui(**answers)
    draw_panel(gui, desk)
    assert all(any(word == re.sub(r" \(.*|/.*", "", label).replace(" ", "_")
                   for label in gui.labels) for word in answers)  # fmt: skip
    return gui


class TestPlayback:
    def test_frames_of_steps(self, desk):
        """Running, a frame takes as many steps as the slider says; stopped, none; Step stops and
        takes one."""
        playback, count = desk.playback, lambda: desk.playback.simulation.step_count
        playback.go_on()
        assert count() == 0
        press(desk, Start=True)
        playback.go_on()
        assert count() == 5 and playback.status() == "running"
        press(desk, Steps=7)
        playback.go_on()
        assert count() == 12
        press(desk, Step=True)
        playback.go_on()
        playback.go_on()
        assert count() == 13 and playback.status() == "stopped"
        press(desk, Start=True)
        press(desk, Stop=True)
        playback.go_on()
        assert count() == 13

    def test_reset_is_the_start(self, desk):
        """To the last bit, and what follows is what followed the first time; a fresh simulation
        without a window takes the same steps: sorts, outputs and looks at stiffness included."""
        playback = desk.playback

        def run():
            playback.start_or_stop()
            while playback.is_running:
                playback.go_on()
            return stored(playback.simulation)

        start, first = stored(playback.simulation), run()
        assert first != start
        playback.reset()
        assert stored(playback.simulation) == start and playback.simulation.time == 0
        assert run() == first

    def test_end(self, desk):
        """The run stops at the end of the scene; Start and Step do no more until Reset."""
        playback = desk.playback
        playback.steps_per_frame = 50
        for _ in range(3):
            playback.start_or_stop()
            playback.go_on()
            playback.go_on()
        assert playback.simulation.time == END and not playback.is_running
        assert playback.status().startswith("done")
        playback.step()
        playback.go_on()
        assert playback.simulation.time == END
        playback.reset()
        playback.step()
        playback.go_on()
        assert playback.simulation.step_count == 1

    @pytest.mark.parametrize("by_stages", [False, True])
    def test_a_run_that_goes_wrong(self, desk, by_stages):
        """Numbers that are none, found by the guard or in the snapshot, amid a step too: the
        particle is named in the picture, the last sound moment stays, and Reset begins again."""
        playback = desk.playback
        before = desk.picture()
        if by_stages:
            desk.toggle_stages()
            playback.step()
            playback.go_on()
        H = playback.simulation.solver.particles.H
        broken = H.to_numpy()
        broken[7] = np.nan
        H.from_numpy(broken)
        for _ in range(10):
            if by_stages:
                playback.step()
            elif not playback.is_running:
                playback.start_or_stop()
            playback.go_on()
            press(desk)
        assert not playback.is_running
        assert re.search(r"particle \d+ \(body lower", playback.fault)
        assert np.isfinite(playback.snapshot.position).all()
        words = desk.picture()
        assert (words != before).any()
        playback.reset()
        if by_stages:
            desk.toggle_stages()
            desk.viewpoint.reset()
        assert playback.fault is None
        assert (desk.picture() == before).all()

    def test_shorter_steps_are_pointed_at(self, desk, monkeypatch):
        """What `run` would do about a motion that went wrong, the window says."""

        def blow_up(_most):
            raise MotionError("particle 3 has left")

        monkeypatch.setattr(desk.playback.simulation, "advance", blow_up)
        desk.playback.step()
        desk.playback.go_on()
        assert desk.playback.fault.startswith("particle 3 has left\nReset")
        assert "shorter steps" in desk.playback.fault


class TestPanel:
    def test_every_widget(self, desk):
        """Each does what its label says; none is left out here."""
        looks, viewpoint = desk.looks, desk.viewpoint
        labels = press(desk).labels
        assert [label for label in labels if label.endswith(")")] == [
            "Start (space)", "Step (s)", "Reset (r)", "Step by stages (t)", "Toggle Grid (g)",
            "Toggle Log (l)", "Zoom in (up)", "Zoom out (down)", "Whole domain (v)",
            "Save picture (p)",
        ]  # fmt: skip
        assert [label for label in labels if not label.endswith(")")] == [
            "Steps/frame", "Grid opacity", *(name.replace("_", " ") for name in COLORS)
        ]  # fmt: skip
        press(desk, Toggle_Grid=False, Grid_opacity=0.75)
        assert not looks.shows_grid and looks.grid_opacity == 0.75
        for name in COLORS:
            press(desk, **{name: True})
            assert looks.color_by == name
        press(desk, Zoom_in=True)
        press(desk, Zoom_in=True)
        press(desk, Zoom_out=True)
        assert viewpoint.zoom == pytest.approx(1.25)
        press(desk, Whole_domain=True)
        assert viewpoint.zoom == 1
        desk.playback.step()
        desk.playback.go_on()
        press(desk, Reset=True)
        assert desk.playback.simulation.step_count == 0
        assert "First particle" not in press(desk, Toggle_Log=True).labels[:7]
        assert looks.shows_log
        press(desk, First_particle=30)
        assert looks.first == 30

    def test_keys(self, desk):
        """The keys that labels name, and the others, do the same as the buttons."""
        acts, looks, playback = keys(desk), desk.looks, desk.playback
        named = re.findall(r"\((\w+)\)", " ".join(press(desk).labels + press(desk).texts))
        names = {"space": " ", "up": "Up", "down": "Down"}
        assert {names.get(name, name) for name in named} <= acts.keys()
        for key in ("g", "l", "Up"):
            acts[key]()
        assert (looks.shows_grid, looks.shows_log, desk.viewpoint.zoom) == (False, True, 1.25)
        for key in ("Down", "Up", "Up", "v"):
            acts[key]()
        assert desk.viewpoint.zoom == 1
        seen = []
        for _ in COLORS:
            acts["c"]()
            seen.append(looks.color_by)
        assert set(seen) == set(COLORS)
        looks.pick(3)
        acts["Escape"]()
        assert looks.picked is None
        acts[" "]()
        assert playback.is_running
        acts["s"]()
        playback.go_on()
        assert playback.simulation.step_count == 1
        acts["r"]()
        assert playback.simulation.step_count == 0
        acts["q"]()
        assert desk.is_closed

    def test_pictures_are_saved_beside_each_other(self, desk):
        """The canvas as it is shown; never over a file that is there; words where it fails."""
        press(desk, Save_picture=True)
        keys(desk)["p"]()
        first, second = sorted(desk.album.folder.glob("disks-view-00*.png"))
        canvas = desk.layout.canvas
        expected = draw_canvas(
            desk.playback, desk.looks, desk.viewpoint, canvas.width, canvas.height
        )
        with Image.open(second) as read:
            assert np.array_equal(np.asarray(read), expected)
        assert first.read_bytes() == second.read_bytes()
        assert any("disks-view-002.png" in text for text in press(desk).texts)
        second.unlink()
        first.unlink()
        desk.album.folder.rmdir()
        desk.save_picture()
        assert desk.notice.startswith("not saved: ")
        desk.album.folder.mkdir()


def assert_same(found, expected):
    """Up to 1e-12 of the largest value of each field."""
    assert found.keys() == expected.keys()
    for name, values in expected.items():
        assert np.abs(found[name] - values).max() <= 1e-12 * np.abs(values).max(), name


class TestStages:
    """Step takes the stages of a step, in their order, as the source slides did."""

    def step(self, desk):
        desk.playback.step()
        desk.playback.go_on()
        return desk.playback.stage_of(desk.looks.watched)

    def test_the_order(self, desk):
        """Four of them are the step that Step takes otherwise, up to round-off (a whole step is
        another kernel); the numbers and formulas of each are told, and the weights of the picked
        particle's nodes add up."""
        playback = desk.playback
        press(desk, Step=True)
        playback.go_on()
        expected = fields(playback.simulation)
        playback.reset()
        assert "Step takes the first stage of a step." in press(desk, Step_by_stages=True).texts
        desk.looks.pick(100)
        seen = []
        for number in range(1, 5):
            stage = self.step(desk)
            seen.append(stage.name)
            assert playback.simulation.step_count == (number == 4)
            texts = press(desk).texts
            assert any(text.startswith(f"{stage.name}; t = 0 s, dt = 0.001 s") for text in texts)
            assert all(f"  {line}" in texts for line in stage.formula)
            assert "  v_p = (0.1, 0.1) m/s" in texts
            weights = [line.split() for line in texts if line.startswith("      sum ")]
            assert weights == [["sum", "1.0000"]]
        assert seen == ["particles to nodes", "grid update", "nodes to particles", "reset"]
        assert_same(fields(playback.simulation), expected)
        assert self.step(desk).name == seen[0]

    @pytest.mark.parametrize("end", ["start", "toggle", "reset"])
    def test_out_of_the_middle_of_a_step(self, desk, end):
        """Start and the box finish the step and go on as if it had been taken whole; Reset takes it
        back."""
        playback = desk.playback
        start = stored(playback.simulation)
        desk.toggle_stages()
        for _ in range(2):
            self.step(desk)
        assert playback.simulation.is_amid_step and playback.status() == "amid a step"
        if end == "reset":
            playback.reset()
            assert stored(playback.simulation) == start and playback.simulation.step_count == 0
            assert playback.stage_of(0) is None and self.step(desk).name == "particles to nodes"
            return
        if end == "start":
            playback.start_or_stop()
            playback.go_on()
        else:
            desk.toggle_stages()
            playback.start_or_stop()
            playback.go_on()
        count = playback.simulation.step_count
        assert count == 6 and playback.stage_of(0) is None
        walked = fields(playback.simulation)
        if playback.walk is not None:
            desk.toggle_stages()
        playback.reset()
        for _ in range(count):
            self.step(desk)
        assert_same(fields(playback.simulation), walked)

    def test_what_is_drawn(self, desk):
        """The picked particle's nodes are white where they are, and after the grid update where
        their velocity has taken them, enlarged; their weights stand beside them, and the name of
        the stage below the title."""
        desk.looks.pick(100)
        desk.toggle_stages()
        plain, white = desk.picture().astype(int), palette.eight_bit(palette.INK)
        stage = self.step(desk)
        image, camera = desk.picture(), desk.camera
        for i in stage.nodes:
            column, row = np.rint(camera.pixel_of(stage.node_position[i])).astype(int)
            assert np.abs(image[row - 3, column - 3] - np.array(white)).max() <= 1
        dx = desk.playback.simulation.scene.cell_size
        stage = self.step(desk)
        larger = enlargement(stage, dx)
        assert 0.1 < larger * stage.dt * 0.1 * np.sqrt(2) / dx <= 0.4
        moved = stage.node_position + larger * (stage.moved_node - stage.node_position)
        image = desk.picture()
        for i in stage.nodes:  # beside the arrow to the upper right
            column, row = np.rint(camera.pixel_of(moved[i])).astype(int) + 6
            assert np.abs(image[row, column] - np.array(white)).max() <= 1
        title = (slice(35, 54), slice(30, 150))
        assert (image[title] == palette.eight_bit(palette.BODIES[1])).all(-1).any()
        assert not (plain[title] == palette.eight_bit(palette.BODIES[1])).all(-1).any()


class TestMouse:
    def at(self, desk, x):
        return tuple(desk.camera.pixel_of(x))

    def test_click_picks(self, desk, rng):
        """The particle that is seen there, whose row the log then begins with; beside all of them
        none; after pan and zoom too."""
        gestures, position = Gestures(desk), desk.playback.snapshot.position
        for factor in (1.0, 3.0):
            particle = int(rng.integers(len(position)))
            desk.viewpoint.zoom_by(desk.camera, factor, self.at(desk, position[particle]))
            at = self.at(desk, position[particle])
            gestures.follow(["LMB"], {"LMB"}, at)
            gestures.follow([], set(), (at[0] + 1, at[1]))
            assert desk.looks.picked == desk.looks.first == particle
        desk.viewpoint.reset()
        gestures.follow(["LMB"], set(), self.at(desk, [0.95, 0.05]))  # shorter than a frame
        assert desk.looks.picked is None
        assert particle_at(desk, *self.at(desk, [0.2, 0.2])) is not None

    def test_drag_pans_and_zooms(self, desk):
        """What was under the mouse stays under it, and a drag picks nothing; the right button zooms
        by two in 120 pixels upward, about the place where it was pressed."""
        gestures, x = Gestures(desk), np.array([0.4, 0.45])
        at = self.at(desk, x)
        gestures.follow(["LMB"], {"LMB"}, at)
        for k in range(1, 9):
            gestures.follow([], {"LMB"}, (at[0] + 8 * k, at[1] - 5 * k))
        gestures.follow([], set(), (at[0] + 64, at[1] - 40))
        assert self.at(desk, x) == pytest.approx((at[0] + 64, at[1] - 40))
        assert desk.looks.picked is None
        at = self.at(desk, x)
        gestures.follow(["RMB"], {"RMB"}, at)
        gestures.follow([], {"RMB"}, (at[0], at[1] - 60))
        gestures.follow([], {"RMB"}, (at[0], at[1] - 120))
        assert desk.viewpoint.zoom == pytest.approx(2)
        assert self.at(desk, x) == pytest.approx(at)

    def test_widgets_are_no_stage(self, desk):
        """What begins on the panel moves nothing."""
        gestures, before = Gestures(desk), desk.viewpoint.key()
        for k in range(20):
            gestures.follow(["LMB"] * (k == 0), {"LMB"}, (1100 - 40 * k, 300))
        gestures.follow([], set(), (300, 300))
        assert desk.viewpoint.key() == before and desk.looks.picked is None


class TestViewpoint:
    @pytest.mark.parametrize("size", [(1, 1), (20, 1), (1.2, 0.9, 0.6), (1, 1, 20)])
    def test_begins_as_the_pictures_do(self, rng, size):
        """In a window of any shape all of the domain is within the margins, and points lie as in a
        PNG, but for one scale and one shift."""
        width, height = rng.integers(400, 2000, 2)
        seen = Viewpoint(size).camera(width, height)
        at = seen.pixel_of(corners(np.array(size)))
        assert (at >= (29, 59)).all() and (at <= (width - 29, height - 104)).all()
        plain = fit(size, 800)
        x = rng.uniform(0, 1, (20, len(size))) * size
        moved = (plain.pixel_of(x) - plain.pixel_of(x[0])) * seen.scale / plain.scale
        assert seen.pixel_of(x) - seen.pixel_of(x[0]) == pytest.approx(moved, abs=1e-6)

    def test_zoom_and_orbit(self, rng):
        """What is seen at a pixel stays there; the view never goes below the floor, and in no
        direction is a corner of the domain behind the camera."""
        view, at = Viewpoint((1, 1)), rng.uniform(300, 500, 2)
        camera = view.camera(800, 800)
        x = camera.center + (at - (camera.column, camera.row)) * (1, -1) / camera.scale
        for factor in rng.uniform(0.9, 1.4, 10):
            view.zoom_by(view.camera(800, 800), factor, at)
        assert view.camera(800, 800).pixel_of(x) == pytest.approx(at)
        view = Viewpoint((1.2, 0.9, 0.6))
        for _ in range(50):
            view.orbit(*rng.uniform(-200, 200, 2))
            view.pan(view.camera(800, 800), *rng.uniform(-500, 500, 2))
            camera = view.camera(800, 800)
            assert camera.axes @ camera.axes.T == pytest.approx(np.eye(3))
            assert camera.axes[1, 1] >= -1e-12 and camera.axes[2, 1] >= 0
            assert np.isfinite(camera.pixel_of(corners(view.size))).all()


def test_looks_begin_as_the_pictures():
    """Color and grid of `output.images`; where those have no grid it is off, and to be seen once it
    is on."""

    def begin(**images):
        return looks_of(SimpleNamespace(output=SimpleNamespace(images=Style(**images))))

    assert begin(color_by="density", grid=0.7) == Looks("density", True, 0.7)
    assert begin(grid=0) == Looks("speed", False, 0.5)
    assert looks_of(SimpleNamespace(output=SimpleNamespace(images="none"))) == Looks()


def test_layout_of_any_size(rng):
    """Each box has room for something, and canvas and chart lie within the window."""
    for width, height in [(1, 1), (200, 100), (5000, 3000), *rng.integers(1, 3000, (50, 2))]:
        layout = layout_of(width, height, has_notes=True)
        for box in (layout.canvas, layout.chart):
            assert box.width >= 64 and box.height >= 64
            assert box.left + box.width <= layout.width and box.top + box.height <= layout.height


def centroid(image, color, last_row):
    """Of the pixels of exactly this color [column, row]."""
    mask = (image == np.array(palette.eight_bit(color))).all(-1)
    mask[last_row:] = False
    row, column = np.argwhere(mask).mean(0)
    return np.array([column, row])


def test_the_stage_shows_what_a_picture_shows(desk, tmp_path):
    """The disks in their colors are where the PNG of a run has them, each by its own camera, to
    half a pixel of the coarser one."""
    desk.playback.steps_per_frame = 30
    desk.playback.start_or_stop()
    desk.playback.go_on()
    press(desk, body=True, Grid_opacity=1.0)
    recorder = Images(tmp_path, desk.playback.simulation, Style(color_by="body", size=600))
    recorder.record(desk.playback.simulation, is_output=True)
    with Image.open(tmp_path / "frame_0000.png") as read:
        file = np.asarray(read)
    shown, camera, plain = desk.picture(), desk.camera, fit((1, 1), 600)
    for body in (0, 1):
        bottoms = [round(one.pixel_of([0, 0])[1]) + 1 for one in (camera, plain)]
        places = []
        for image, one, bottom in ((shown, camera, bottoms[0]), (file, plain, bottoms[1])):
            at = centroid(image, palette.BODIES[body], bottom)
            places.append((at - one.pixel_of([0, 0])) / one.scale)
        assert np.abs(places[0] - places[1]).max() * plain.scale < 0.5


@pytest.mark.parametrize("color_by", ["stress", "density", "pressure"])
def test_the_ranges_of_the_colors_are_those_of_pictures(desk, tmp_path, color_by):
    """With pictures of the same moments: the widest so far, or what the scene says."""
    simulation = desk.playback.simulation
    recorder = Images(tmp_path, simulation, Style(color_by=color_by, size=64))
    simulation.solver.particles.H.fill(1e-3)
    desk.playback.step()
    recorder.record(simulation, is_output=True)
    for _ in range(3):
        desk.playback.go_on()
        desk.playback.step()
        recorder.record(simulation, is_output=True)
    assert desk.playback.scales.of(color_by) == (recorder.low, recorder.high)
    assert recorder.high > recorder.low
    given = SimpleNamespace(output=SimpleNamespace(images=Style(color_by="stress", range=[1, 2])))
    assert Scales(given).of("stress") == (1, 2) and Scales(given).of("body") == (0, 1)


def test_grid_numbers_and_ring_are_seen(desk):
    """Each changes the picture of the canvas where it is: off, the picture is that without it."""

    def picture(**answers):
        press(desk, **answers)
        return desk.picture().astype(int)

    with_grid = picture(body=True, Grid_opacity=0.5)
    without = picture(Toggle_Grid=False)
    corner, low = np.rint(desk.camera.pixel_of([[0.5, 0.9], [0.025, 0]])).astype(int)
    around = slice(corner[1] - 40, corner[1] + 40), slice(corner[0] - 40, corner[0] + 40)
    below = slice(low[1] + 5, low[1] + 25), slice(low[0] - 10, low[0] + 10)
    for part in (around, below):
        assert (with_grid[part] != without[part]).any()
    desk.looks.pick(5)
    column, row = np.rint(desk.camera.pixel_of(desk.playback.snapshot.position[5])).astype(int)
    changed = np.argwhere((desk.picture() != without).any(-1))
    assert len(changed) and np.abs(changed - (row, column)).max() < 30


class TestNumbers:
    def test_log(self, desk):
        """Step, particle, mass, velocity, stress, strain, kinetic energy; the row of all has their
        sum.  The picked particle has all components."""
        desk.playback.start_or_stop()
        desk.playback.go_on()
        snapshot = desk.playback.snapshot
        desk.looks.pick(30)
        lines = log_lines(desk.playback, desk.looks)
        assert lines[0] == "step 5, t = 0.005 s, dt = 0.001 s"
        assert lines[1].startswith("energy [J]: kinetic 2.6")
        everything = next(line.split() for line in lines if line.split()[0] == "all")
        assert float(everything[1]) == pytest.approx(snapshot.mass.sum(), rel=1e-3)
        kinetic = diagnostics.kinetic_energy(snapshot)
        assert float(everything[2]) == pytest.approx(kinetic, rel=1e-3)
        row = next(line.split() for line in lines if line.split()[0] == ">30")
        numbers = [float(word.strip("(),")) for word in row[1:]]
        m, v = snapshot.mass[30], snapshot.velocity[30]
        E = np.linalg.norm(green_strain(snapshot.deformation_gradient[30]))
        expected = [m, *v, snapshot.von_mises_stress[30], E, 0.5 * m * v @ v]
        assert numbers == pytest.approx(expected, rel=1e-3)
        assert lines[2].startswith("particle 30 (body lower") and "xy" in lines[5]
        assert len(table(snapshot, len(snapshot.mass) - 2, None)) == 3 + 2

    def test_strain_is_blind_to_turning(self, rng):
        """E of a rotation is 0, that of a stretch (s^2 - 1) / 2."""
        a = rng.uniform(0, 7)
        turn = np.array([[np.cos(a), -np.sin(a)], [np.sin(a), np.cos(a)]])
        assert green_strain(turn @ np.diag([1.1, 1])) == pytest.approx(np.diag([0.105, 0]))

    def test_energies_stay_few(self, desk, monkeypatch):
        """The curve keeps its beginning and end, and forgets every second moment where it has
        too many; the total is the sum."""
        monkeypatch.setattr("mpm_taichi.window.energies.MOST", 8)
        desk.playback.steps_per_frame = 2
        desk.playback.start_or_stop()
        while desk.playback.is_running:
            desk.playback.go_on()
        energies = desk.playback.energies
        assert len(energies.times) <= 8
        assert energies.times[0] == 0 and energies.times[-1] == END
        rows = np.array(energies.rows)
        assert rows[:, 4] == pytest.approx(rows[:, :4].sum(axis=1))
        assert list(energies.curves()) == ["kinetic", "total"]  # the disks fly freely


def test_the_window_runs_as_a_run_does(desk):
    """A simulation that nobody watches is in the same state at the end, to the last bit.  The
    last test of this file: it ends the simulation of the others."""
    desk.playback.start_or_stop()
    while desk.playback.is_running:
        desk.playback.go_on()
    watched = stored(desk.playback.simulation)
    alone = simulation(f"time.end={END}", "output.every=0.02")
    alone.run()
    assert stored(alone) == watched
    assert Playback(alone).simulation is alone
