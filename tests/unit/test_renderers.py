"""The pictures: what is where in them, in which color, and that their bytes can be relied on."""

import zlib
from types import SimpleNamespace
from typing import get_args

import numpy as np
import pytest
from PIL import Image

from mpm_taichi import runtime
from mpm_taichi.recorders import Images
from mpm_taichi.renderers import Frame, draw, legend, palette, png, write_png
from mpm_taichi.renderers.camera import View, corners, fit
from mpm_taichi.renderers.quantities import QUANTITIES, shown_range
from mpm_taichi.renderers.rasterizer import draw_discs, draw_lines
from mpm_taichi.renderers.spheres import draw_spheres
from mpm_taichi.renderers.units import prefix, round_length, tick_labels, with_unit
from mpm_taichi.scene import Images as Style
from mpm_taichi.scene import View as SceneView
from mpm_taichi.scene import load_scene
from mpm_taichi.snapshot import Snapshot
from tests.command_line import SCENES

pytestmark = pytest.mark.filterwarnings("error::RuntimeWarning")


@pytest.fixture(scope="module", autouse=True)
def started():
    """Once for all tests: drawing allocates no fields, and any run will do."""
    runtime.start("cpu", "f64", threads=2)


def frame_of(position, radius=0.02, size=(1.0, 1.0), **changes) -> Frame:
    """A frame of one body with particles of one radius."""
    position = np.asarray(position, float)
    count = len(position)
    plain = {
        "position": position,
        "radius": np.full(count, radius),
        "body": np.zeros(count, int),
        "body_names": ["only"],
        "time": 0.5,
        "domain_size": size,
        "cells": tuple(20 for _ in size),
    }
    return Frame(**{**plain, **changes})


def bytes_of(color) -> np.ndarray:
    return np.array(palette.eight_bit(color))


def mask_of(image, color) -> np.ndarray:
    """The pixels [height, width] of exactly this color."""
    return (image == bytes_of(color)).all(-1)


def blank(height, width) -> np.ndarray:
    return np.zeros((height, width, 3), np.float32)


def disc(image, column, row, radius, color=(1.0, 1.0, 1.0)):
    one = np.ones(1)
    draw_discs(image, column * one, row * one, radius * one, np.array([color]))


def spheres(image, *each, color=(1.0, 1.0, 1.0)):
    """Each: (column, row, toward, radius)."""
    column, row, toward, radius = np.array(each, float).T
    draw_spheres(image, column, row, toward, radius, np.tile(color, (len(each), 1)))


def oklab(rgb) -> np.ndarray:
    """Ottosson (2020): sRGB [n, 3] -> OKLab [n, 3]."""
    linear = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
    to_cones = np.array(
        [
            [0.4122214708, 0.5363325363, 0.0514459929],
            [0.2119034982, 0.6806995451, 0.1073969566],
            [0.0883024619, 0.2817188376, 0.6299787005],
        ]
    )
    to_lab = np.array(
        [
            [0.2104542553, 0.7936177850, -0.0040720468],
            [1.9779984951, -2.4285922050, 0.4505937099],
            [0.0259040371, 0.7827717662, -0.8086757660],
        ]
    )
    return np.cbrt(linear @ to_cones.T) @ to_lab.T


class TestPng:
    @pytest.mark.parametrize("channels", [1, 3, 4])
    def test_reads_back_equal(self, tmp_path, rng, channels):
        """Another reader (Pillow) finds the same pixels and the same texts: PNG loses nothing."""
        image = rng.integers(0, 256, (37, 51, channels), dtype=np.uint8)
        write_png(tmp_path / "a.png", image, {"scene": "two disks", "t": "0.5 s"})
        with Image.open(tmp_path / "a.png") as read:
            assert read.info == {"scene": "two disks", "t": "0.5 s"}
            assert np.array_equal(np.asarray(read).reshape(image.shape), image)

    def test_complete_or_not_at_all(self, tmp_path, monkeypatch):
        """A picture that fails half-way leaves the old file as it was; one that succeeds leaves
        nothing else in the folder."""
        path = tmp_path / "a.png"
        write_png(path, np.zeros((4, 4, 3), np.uint8))
        assert [file.name for file in tmp_path.iterdir()] == ["a.png"]
        before = path.read_bytes()

        def no_memory(*_):
            raise MemoryError

        monkeypatch.setattr(zlib, "compressobj", no_memory)
        with pytest.raises(MemoryError):
            write_png(path, np.ones((4, 4, 3), np.uint8), {"t": "1"})
        assert path.read_bytes() == before

    def test_bands(self, tmp_path, rng):
        """A picture of more than a band, deflated by several threads, reads back equal."""
        image = rng.integers(0, 256, (500, 900, 3), dtype=np.uint8)
        assert image.size > png.BAND
        write_png(tmp_path / "a.png", image)
        with Image.open(tmp_path / "a.png") as read:
            assert np.array_equal(np.asarray(read), image)

    def test_text_outside_latin_1(self, tmp_path):
        """A Greek letter cannot be stored in tEXt; it becomes "?" and the picture is written."""
        write_png(tmp_path / "a.png", np.zeros((2, 2, 3), np.uint8), {"title": "caf\xe9 \u03c3"})
        with Image.open(tmp_path / "a.png") as read:
            assert read.info == {"title": "caf\xe9 ?"}


class TestPalette:
    def test_sequential_is_even(self):
        """Equal steps of the value look equal: in OKLab the 50 steps differ by less than 1.3 (the
        limit of the sRGB gamut), and the lightness grows in each of them."""
        lab = oklab(palette.sequential(np.linspace(0, 1, 51)))
        steps = np.linalg.norm(np.diff(lab, axis=0), axis=1)
        assert steps.max() / steps.min() < 1.3
        assert (np.diff(lab[:, 0]) > 0).all()

    def test_diverging_is_symmetric(self):
        """A value and its negative look equally strong: OKLab lightness equal to 0.01 (8 bits and
        the gamut allow no better), highest and without color at zero."""
        lightness, green_red, blue_yellow = oklab(palette.diverging(np.linspace(0, 1, 101))).T
        assert np.abs(lightness - lightness[::-1]).max() < 0.01
        assert lightness.argmax() == 50
        assert np.hypot(green_red, blue_yellow)[50] < 0.01

    def test_ends_and_nan(self):
        """Values beyond the range have the color of its end; NaN is gray, in neither map."""
        for colors in (palette.sequential, palette.diverging):
            low, high, below, above, missing = colors(np.array([0, 1, -np.inf, 7, np.nan]))
            assert np.array_equal(below, low) and np.array_equal(above, high)
            assert np.array_equal(missing, palette.MISSING)

    def test_bodies_for_the_color_blind(self):
        """Any two body colors stay 0.14 apart in OKLab with full color blindness of each kind
        (matrices of Machado, Oliveira and Fernandes 2009); 0.02 is just noticeable."""
        kinds = [
            np.eye(3),
            [
                [0.152286, 1.052583, -0.204868],
                [0.114503, 0.786281, 0.099216],
                [-0.003882, -0.048116, 1.051998],
            ],
            [
                [0.367322, 0.860646, -0.227968],
                [0.280085, 0.672501, 0.047413],
                [-0.011820, 0.042940, 0.968881],
            ],
            [
                [1.255528, -0.076749, -0.178779],
                [-0.078411, 0.930809, 0.147602],
                [0.004733, 0.691367, 0.303900],
            ],
        ]
        colors = palette.body(np.arange(7))
        linear = np.where(colors <= 0.04045, colors / 12.92, ((colors + 0.055) / 1.055) ** 2.4)
        for kind in kinds:
            seen = np.clip(linear @ np.array(kind).T, 0, 1)
            seen = np.where(seen <= 0.0031308, 12.92 * seen, 1.055 * seen ** (1 / 2.4) - 0.055)
            lab = oklab(seen)
            apart = np.linalg.norm(lab[:, None] - lab[None], axis=-1)
            assert apart[np.triu_indices(7, 1)].min() > 0.14

    def test_eighth_body(self):
        """The seven colors repeat: body 7 has the color of body 0."""
        assert np.array_equal(palette.body(np.array([7])), palette.body(np.array([0])))


class TestUnits:
    def test_handy_numbers(self):
        """0.2 m stays in meters; what is smaller than 0.1 or from 1000 gets a prefix."""
        cases = {0.2: "0.2 m", 0.02: "20 mm", 3000: "3 km", 5e-6: "5 um", 100: "100 m", 0: "0 m"}
        assert {value: with_unit(value, "m") for value in cases} == cases

    def test_prefix_ends(self):
        """Beyond pico and tera the last prefix stays."""
        assert prefix(1e-15) == (1e-12, "p")
        assert prefix(1e18) == (1e12, "T")

    def test_round_length(self, rng):
        """The bar has 1, 2 or 5 times a power of ten, fits, and fills at least 2 / 5 of the room
        (the widest step is from 2 to 5)."""
        for longest in 10 ** rng.uniform(-9, 9, 1000):
            bar = round_length(longest)
            assert 0.4 * longest * (1 - 1e-12) <= bar <= longest
            assert f"{bar:.12e}"[0] in "125" and float(f"{bar:.0e}") == pytest.approx(bar, 1e-12)

    def test_tick_labels(self):
        """One unit for all labels, and as many digits as tell them apart."""
        assert tick_labels([0, 0.5, 1], "m/s") == (["0", "0.5", "1"], "m/s")
        assert tick_labels([-2e5, 0, 2e5], "Pa") == (["-200", "0", "200"], "kPa")
        assert tick_labels([100.0, 100.05, 100.1], "Pa") == (["100", "100.05", "100.1"], "Pa")
        assert tick_labels([0, 4e3, 8e3], "kg/m^3", False) == (["0", "4000", "8000"], "kg/m^3")

    def test_ranges(self, rng):
        """The range of a legend is never empty, and has zero in the middle for a signed one."""
        plain, signed = QUANTITIES["speed"], QUANTITIES["pressure"]
        assert shown_range(plain, 2.0, 3.0) == (2.0, 3.0)
        assert shown_range(plain, 0.0, 0.0) == (0.0, 1.0)
        assert shown_range(plain, np.nan, np.nan) == (0.0, 1.0)
        assert shown_range(signed, -1.0, 3.0) == (-3.0, 3.0)
        assert shown_range(signed, 0.0, 0.0) == (-1.0, 1.0)
        for value in rng.normal(size=100) * 10 ** rng.uniform(-9, 9, 100):
            low, high = shown_range(plain, value, value)
            assert low <= value <= high and low < high
            tick_labels([low, (low + high) / 2, high], "Pa")


class TestRasterizer:
    def test_disc_covers_its_area(self, rng):
        """Coverage falls linearly over one pixel about the rim, so a disc covers
        pi (r^2 + 1/12) pixels, centered on its center.  The sum over pixels is a midpoint rule for
        a function with kinks: for r = 4 the area was off by 0.84 % and the center by 0.03 pixels
        at most in 400 discs, and less for larger ones."""
        for radius in rng.uniform(4, 30, 20):
            image = blank(80, 90)
            column, row = rng.uniform(35, 45, 2)
            disc(image, column, row, radius)
            cover = image[..., 0].astype(float)
            assert cover.sum() == pytest.approx(np.pi * (radius**2 + 1 / 12), rel=0.015)
            rows, columns = np.mgrid[:80, :90]
            assert (cover * columns).sum() / cover.sum() == pytest.approx(column, abs=0.05)
            assert (cover * rows).sum() / cover.sum() == pytest.approx(row, abs=0.05)

    def test_painters_order(self):
        """Of two discs at one place the later one is seen, whole where it covers whole pixels."""
        image = blank(20, 20)
        white, red = (1.0, 1.0, 1.0), (1.0, 0.0, 0.0)
        both = np.array([white, red])
        draw_discs(image, np.full(2, 10.0), np.full(2, 10.0), np.array([8.0, 4.0]), both)
        assert image[10, 10].tolist() == [1, 0, 0]
        assert image[10, 16].tolist() == [1, 1, 1]

    def test_nothing_outside_the_image(self, rng):
        """Discs and lines at, around and far outside the image leave the same pixels as on a large
        image that is cut out, and write nothing before or after it in memory."""
        height, width, far = 40, 50, 60
        count = 300
        column, row = rng.uniform(-50, 100, count), rng.uniform(-50, 90, count)
        radius = 10 ** rng.uniform(-1, 1.5, count)
        color = rng.uniform(size=(count, 3))
        large = blank(height + 2 * far, width + 2 * far)
        memory = np.full((3 * height, width, 3), 0.25, np.float32)
        image = memory[height : 2 * height]
        image[:] = 0
        draw_discs(large, column + far, row + far, radius, color)
        draw_discs(image, column, row, radius, color)
        start, end = np.stack([column, row], -1)[:50], np.stack([column, row], -1)[50:100]
        draw_lines(large, start + far, end + far, np.ones(3), 1.5, 0.7)
        draw_lines(image, start, end, np.ones(3), 1.5, 0.7)
        # the position in the large image is rounded at 2^-17 pixels
        assert np.abs(image - large[far:-far, far:-far]).max() < 1e-3
        draw_spheres(image, column, row, rng.uniform(-50, 50, count), radius, color)
        assert (memory[:height] == 0.25).all() and (memory[2 * height :] == 0.25).all()

    def test_wild_numbers(self):
        """NaN, infinity and numbers beyond f32 are skipped without a warning; a disc larger than
        the image covers it."""
        memory = np.full((30, 10, 3), 0.25, np.float32)
        image = memory[10:20]
        wild = [np.nan, np.inf, -np.inf, 1e300, -1e300, 3e9, -3e9, 5.0]
        each = [axis.ravel() for axis in np.meshgrid(wild, wild, [*wild[:5], 5.0])]
        column, row, radius = np.array(each)[:, np.abs(each).max(0) != 5]
        draw_discs(image, column, row, radius, np.ones((len(radius), 3)))
        assert (memory == 0.25).all()
        disc(image, 5, 5, 1e6)
        assert (image == 1).all() and (memory[:10] == 0.25).all() and (memory[20:] == 0.25).all()

    def test_lines(self, rng):
        """A line covers length times thickness (2 % and the two round ends, at most a pixel each);
        it is the same from its other end, and mirrored at the diagonal it is the transposed.
        Thinner lines have no plateau between their soft rims: sampling errs by 5 % there."""
        for _ in range(20):
            a, b = rng.uniform(20, 80, (2, 2))
            thickness = rng.uniform(1.5, 4)

            def line(start, end, thickness=thickness):
                image = blank(100, 100)
                draw_lines(image, start[None], end[None], np.ones(3), thickness)
                return image[..., 0].astype(float)

            there = line(a, b)
            area = np.linalg.norm(a - b) * thickness
            assert there.sum() - area == pytest.approx(thickness**2, abs=thickness**2 + 0.02 * area)
            assert np.abs(there - line(b, a)).max() < 1e-4
            assert np.abs(there - line(a[::-1], b[::-1]).T).max() < 1e-6


class TestSpheres:
    def test_lit_from_above_left(self):
        """The light comes from above, left and front: of a white sphere the upper left is brighter
        than the lower right, and no channel leaves [0, 1].  Nothing hides its sky: in the middle it
        is 0.52 + 0.62 x 0.61 bright."""
        image = blank(60, 60)
        spheres(image, (30, 30, 0, 25))
        assert image[18, 20, 0] > image[30, 30, 0] > image[42, 40, 0] > 0.2
        assert image[30, 30, 0] == pytest.approx(0.52 + 0.62 * 0.61, abs=1e-5)
        assert image.min() >= 0 and image.max() <= 1

    def test_the_nearer_one_hides_the_farther_one(self):
        """Whatever their order: where both cover a pixel it has the color of the nearer one, and
        beside it that of the other."""
        at, red, blue = np.full(2, 30.0), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)
        for order in ([0, 1], [1, 0]):
            image = blank(60, 60)
            each = np.array([-5.0, 20.0]), np.array([20.0, 6.0]), np.array([red, blue])
            toward, radius, color = (values[order] for values in each)
            draw_spheres(image, at, at, toward, radius, color)
            assert image[30, 30, 2] > 0.5 and image[30, 30, 0] == 0
            assert image[30, 14, 0] > 0.2 and image[30, 14, 2] == 0

    def test_covers_its_disc(self, rng):
        """The layer lets through what spheres leave open: one of color 0 over white takes away the
        area of its disc, pi (r^2 + 1/12), as a disc does (1.5 %)."""
        for radius in rng.uniform(4, 30, 5):
            image = blank(80, 90) + 1
            column, row = rng.uniform(35, 45, 2)
            spheres(image, (column, row, 0, radius), color=(0, 0, 0))
            taken = (1 - image[..., 0]).sum(dtype=float)
            assert taken == pytest.approx(np.pi * (radius**2 + 1 / 12), rel=0.015)

    def test_dark_in_a_pit(self):
        """A sphere that lies a radius deeper than the six around it sees half of its sky, and is
        darker than alone by a quarter or more; the others look out, and lose nothing at the rim."""
        alone, both = blank(120, 120), blank(120, 120)
        turns = np.arange(6) * np.pi / 3
        around = [(60 + 28 * np.cos(a), 60 + 28 * np.sin(a), 20, 14) for a in turns]
        spheres(alone, (60, 60, 0, 14))
        spheres(both, (60, 60, 0, 14), *around)
        assert both[60, 60, 0] < 0.75 * alone[60, 60, 0]
        ring = blank(120, 120)
        spheres(ring, around[0])
        assert both[60, 99, 0] == pytest.approx(ring[60, 99, 0], abs=1e-6)

    def test_wild_numbers(self):
        """What is not finite is skipped."""
        image = blank(20, 20)
        wild = (np.nan, np.inf, -np.inf, 1e300)
        for number in wild:
            for place in range(4):
                one = [10.0, 10.0, 0.0, 5.0]
                one[place] = number
                spheres(image, tuple(one))
        assert (image == 0).all()


class TestPicture:
    @pytest.mark.parametrize("domain", [(1, 1), (20, 1), (1, 20), (3e-6, 2e-6), (4e6, 5e6)])
    def test_pixel_of_a_point(self, rng, domain):
        """A lone particle is seen where `pixel_of` says: its disc has the centroid there, to 0.05
        pixels (midpoint rule, 8 bits).  The domain's longer side has `size` pixels."""
        size, box = 400, np.array(domain, float)
        camera = fit(box, size)
        corner = camera.pixel_of(corners(box))
        assert np.ptp(corner, axis=0).max() == pytest.approx(size, rel=1e-9)
        x = box * rng.uniform(0.3, 0.7, 2)
        frame = frame_of([x], radius=6 / camera.scale, size=domain)
        empty = frame_of(np.zeros((0, 2)), size=domain)
        cover = np.abs(draw(frame, 0, size).astype(float) - draw(empty, 0, size)).sum(-1)
        rows, columns = np.mgrid[: camera.height, : camera.width]
        found = [(cover * columns).sum() / cover.sum(), (cover * rows).sum() / cover.sum()]
        assert found == pytest.approx(camera.pixel_of(x), abs=0.05)

    def test_bodies_by_color(self, rng):
        """A body's particles have exactly its color inside, so that a picture by body can be
        measured: the centroid of each disk's color within 0.02 of a cell (0.8 pixels; 400
        particles of a random lattice, dark gaps and rims left out)."""
        centers = rng.uniform(0.25, 0.3, (2, 2)) + np.array([[0, 0], [0.42, 0.42]])
        spacing = np.sqrt(np.pi * 0.2**2 / 400)
        lattice = (np.arange(-20, 20) + rng.uniform()) * spacing
        points = np.stack(np.meshgrid(lattice, lattice), -1).reshape(-1, 2)
        points = points[np.linalg.norm(points, axis=1) < 0.2]
        position = np.concatenate([center + points for center in centers])
        body = np.repeat([0, 1], len(points))
        frame = frame_of(position, spacing / 2, body=body, body_names=["lower", "upper"])
        image, camera = draw(frame, 0.5, 800), fit((1, 1), 800)
        top, bottom = camera.pixel_of([[0, 1], [0, 0]])[:, 1]
        for index, center in enumerate(centers):
            mask = mask_of(image, palette.BODIES[index])
            mask[int(bottom) + 1 :] = False  # the legend
            assert mask.any() and not mask[: int(top)].any()
            row, column = np.argwhere(mask).mean(0)
            cell = camera.scale / 20
            expected = camera.pixel_of(center + points.mean(0))
            assert [column, row] == pytest.approx(expected, abs=0.02 * cell)

    @pytest.mark.parametrize("dim", [2, 3])
    def test_same_bytes(self, rng, dim):
        """The picture of a frame depends neither on the precision nor on the threads of the run:
        equal to the last bit, since all is f32 and serial."""
        count = 2000
        frame = frame_of(
            rng.uniform(-0.1, 1.1, (count, dim)),
            size=(1.0,) * dim,
            quantity="speed",
            value=rng.uniform(size=count),
        )
        pictures = []
        for precision, threads in [("f64", 1), ("f64", 2), ("f32", 2), ("f32", 1)]:
            runtime.start("cpu", precision, threads=threads)
            pictures.append(draw(frame, 0.7, 300).tobytes())
        assert len(set(pictures)) == 1

    def test_nan_particles_are_skipped(self, rng):
        """A picture with diverged particles is that of the others."""
        for dim in (2, 3):
            position = rng.uniform(0.2, 0.8, (300, dim))
            spoiled = np.concatenate([position, np.full((3, dim), np.nan)])
            spoiled[300, 0] = 0.5
            spoiled[302] = np.inf
            size = (1.0,) * dim
            seen = draw(frame_of(position, size=size), size=200)
            assert np.array_equal(draw(frame_of(spoiled, size=size), size=200), seen)

    @pytest.mark.parametrize("size", [64, 501])
    @pytest.mark.parametrize(
        "domain", [(1, 1), (20, 1), (1, 20), (1, 1, 1), (20, 1, 1), (1, 20, 1), (1, 1, 20)]
    )
    def test_all_is_within_the_picture(self, rng, domain, size):
        """Whatever its shape, the domain lies within the picture, apart from the texts; the sides
        are even (video codecs want that), and the outer rim is background: nothing is cut off.
        In 3D perspective shortens, but the longer side of the seen box has `size` pixels."""
        box = np.array(domain, float)
        camera = fit(box, size)
        names = [f"body number {index} of many" for index in range(30)]
        frame = frame_of(
            box * rng.uniform(0.2, 0.8, (10, len(box))),
            0.01,
            domain,
            title=90 * "W",
            body_names=names,
        )
        for changes in ({}, {"quantity": "stress", "value": np.full(10, -123456.7)}):
            image = draw(Frame(**{**vars(frame), **changes}), 1, size)
            height, width, _ = image.shape
            assert (height, width) == (camera.height, camera.width)
            assert height % 2 == 0 and width % 2 == 0
            at = camera.pixel_of(corners(box))
            assert np.ptp(at, axis=0).max() == pytest.approx(size, rel=1e-9)
            assert (at > 4).all() and (at < np.array([width, height]) - 5).all()
            rim = np.ones((height, width), bool)
            rim[3:-3, 3:-3] = False
            assert mask_of(image, palette.BACKGROUND)[rim].all()

    def test_grid_opacity(self):
        """Line over panel by the opacity: at 0 the panel, at 1 the line, at 0.5 half-way (to 1 of
        256); 800 pixels for 20 cells put the lines on the centers of pixels."""
        nothing = frame_of(np.zeros((0, 2)))
        column, row = np.rint(fit((1, 1), 800).pixel_of([0.25, 0.475])).astype(int)
        for opacity in (0, 0.5, 1):
            expected = palette.PANEL + opacity * (palette.LINE - palette.PANEL)
            at = draw(nothing, opacity, 800)[row, column].astype(int)
            assert np.abs(at - bytes_of(expected)).max() <= 1

    def test_grid_too_fine(self):
        """Cells below 4 pixels would make the grid a gray veil: it is left out."""
        nothing = frame_of(np.zeros((0, 2)), cells=(250, 250))
        assert np.array_equal(draw(nothing, 1, 800), draw(nothing, 0, 800))

    def test_near_hides_far(self):
        """In 3D the particle nearer to the viewer is in front, whatever the order of the two, and
        larger: a length at the distance d - 0.2 is seen d / (d - 0.2) times as long as at d."""
        camera = fit((1, 1, 1), 400)
        toward = camera.axes[2]
        pair = 0.5 + np.array([-0.2, 0.2])[:, None] * toward
        away = camera.distance - np.array([-0.2, 0.2])
        assert camera.look(pair).scale == pytest.approx(camera.scale * camera.distance / away)
        seen = []
        for order in ([0, 1], [1, 0]):
            body = np.array([0, 1])[order]
            frame = frame_of(pair[order], 0.1, (1, 1, 1), body=body, body_names=["far", "near"])
            column, row = np.rint(camera.pixel_of(pair[1])).astype(int)
            seen.append(draw(frame, 0, 400)[row, column].astype(float))
        assert np.array_equal(*seen)
        direction = seen[0] / np.linalg.norm(seen[0])
        near = palette.BODIES[1] / np.linalg.norm(palette.BODIES[1])
        assert direction @ near > 0.99

    @pytest.mark.parametrize("turn", [0, 90])
    def test_perspective_by_hand(self, turn):
        """A domain of 2 x 1 x 1 m seen straight from the front, or from its right: half its
        diagonal is sqrt(6) / 2, the camera is four times as far away, and the near face, 2 m (1 m)
        wide and 0.5 m (1 m) before the middle, takes 400 pixels.  A sphere is seen where similar
        triangles put it: `pixel_of` to a pixel's half, since the stage has whole pixels, and its
        disc there to the pixel that the rim may or may not touch."""
        away = 2 * np.sqrt(6)
        wide, before = (2.0, 0.5) if turn == 0 else (1.0, 1.0)
        scale = 400 / wide * (1 - before / away)
        x = np.array([1.5, 0.75, 0.3])
        right, toward = (0.5, -0.2) if turn == 0 else (0.2, 0.5)
        view = View(turn=turn, tilt=0)
        camera = fit((2, 1, 1), 400, view)
        left, _, top, bottom = camera.stage
        tall = 400 / wide  # the domain is 1 m high
        middle = left + 200.0, (top + bottom - 1) / 2
        assert bottom - top == pytest.approx(tall + 1, abs=1)
        shrink = scale / (1 - toward / away)
        expected = np.array([middle[0] + right * shrink, middle[1] - 0.25 * shrink])
        assert camera.pixel_of(x) == pytest.approx(expected, abs=0.51)  # a whole number of pixels
        frame, empty = (frame_of(at, 0.02, (2.0, 1.0, 1.0)) for at in ([x], np.zeros((0, 3))))
        cover = draw(frame, 0, 400, view).astype(float) - draw(empty, 0, 400, view)
        rows, columns = np.nonzero(np.abs(cover).sum(-1))
        found = [(columns.min() + columns.max()) / 2, (rows.min() + rows.max()) / 2]
        assert found == pytest.approx(camera.pixel_of(x), abs=0.6)

    def test_floor_and_shadow(self):
        """The floor is brighter than what is beside it, but for the places straight below a body,
        which are darker than both; a body above it takes nothing from the floor elsewhere."""
        lattice = np.stack(np.meshgrid(*[np.linspace(0.4, 0.6, 11)] * 3), -1).reshape(-1, 3)
        camera = fit((1, 1, 1), 400)
        image = draw(frame_of(lattice, 0.01, (1.0, 1.0, 1.0)), 0, 400)
        below, elsewhere = camera.pixel_of([[0.5, 0, 0.5], [0.8, 0, 0.8]]).round().astype(int)
        assert tuple(image[below[1], below[0]]) == palette.eight_bit(palette.SHADOW)
        assert tuple(image[elsewhere[1], elsewhere[0]]) == palette.eight_bit(palette.PANEL)
        assert palette.SHADOW.sum() < palette.BACKGROUND.sum() < palette.PANEL.sum()

    @pytest.mark.parametrize("dim", [2, 3])
    def test_view(self, rng, dim):
        """With a center and a zoom the picture is as large as without; the center is in the middle
        of the stage, a length there `zoom` times as long, and nothing is drawn beyond the stage."""
        box, plain = np.ones(dim), fit(np.ones(dim), 400)
        center = tuple(rng.uniform(0.3, 0.7, dim))
        view = View(zoom=3.0, center=center)
        camera = fit(box, 400, view)
        left, right, top, bottom = camera.stage
        assert (camera.width, camera.height) == (plain.width, plain.height)
        assert camera.pixel_of(center) == pytest.approx(
            [(left + right - 1) / 2, (top + bottom - 1) / 2]
        )
        assert camera.scale == pytest.approx(3 * plain.scale)
        frame = frame_of(rng.uniform(0, 1, (400, dim)), 0.02, (1.0,) * dim)
        image, rim = draw(frame, 1, 400, view), camera.em
        strip = image[top - rim : top - rim // 2 - 1]
        assert mask_of(strip, palette.BACKGROUND).all()
        assert not mask_of(image[top:bottom, left:right], palette.BACKGROUND).all()

    def test_scale_bar(self):
        """In 2D a length on the picture; in 3D one on an edge of the box, which is as long there;
        in a view that shows no such edge, one in the middle, which the words say."""
        flat = fit((1, 1), 400)
        assert [text.words for text in legend.scale_bar(blank(900, 900), flat, np.ones(2))] == [
            "0.1 m"
        ]
        box = np.array([2.0, 1.0, 1.0])
        camera, image = fit(box, 400), blank(600, 600)
        [text] = legend.scale_bar(image, camera, box)
        assert text.words == "0.5 m"
        start, end = camera.pixel_of([[0, 0, 1], [0.5, 0, 1]])
        rows, columns = np.nonzero(image[..., 0] > 0.2)
        assert [columns.min(), columns.max()] == pytest.approx([start[0], end[0]], abs=2)
        assert [rows.min(), rows.max()] == pytest.approx([start[1], end[1]], abs=2)
        close = fit(box, 400, View(zoom=4.0))
        assert legend.scale_bar(image, close, box)[0].words.endswith("m in the middle")

    def test_one_far_off(self):
        """A particle that has flown a million domains away leaves the order of the others."""
        toward = fit((1, 1, 1), 400).axes[2]
        pair = 0.5 + np.array([-0.1, 0.1])[:, None] * toward
        seen = []
        for others in (np.zeros((0, 3)), 0.5 + -1e6 * toward[None]):
            position = np.concatenate([pair, others])
            body = np.array([0, 1, 0])[: len(position)]
            frame = frame_of(position, 0.1, (1.0, 1.0, 1.0), body=body, body_names=["far", "near"])
            seen.append(draw(frame, 0, 400))
        assert np.array_equal(*seen)

    def test_up_is_y(self):
        """Both views have y upward and x to the right, and in 3D the corner `size` is nearest."""
        for size in ((1, 1), (1, 1, 1)):
            camera = fit(size, 400)
            origin, right, up = camera.pixel_of(np.eye(3, len(size))[[2, 0, 1]] * [[0], [1], [1]])
            assert right[0] > origin[0] and up[1] < origin[1]
            assert abs(up[0] - origin[0]) < 0.1 * abs(up[1] - origin[1])
        assert camera.look(corners(np.ones(3))).toward.argmax() == 7

    def test_value_colors(self):
        """A particle has the color that the legend gives its value; beyond the range, its end's."""
        value = np.array([0.0, 5.0, 10.0, 99.0])
        position = np.array([[0.2, 0.5], [0.4, 0.5], [0.6, 0.5], [0.8, 0.5]])
        frame = frame_of(position, 0.05, quantity="speed", value=value, value_range=(0, 10))
        at = np.rint(fit((1, 1), 400).pixel_of(position)).astype(int)
        image = draw(frame, 0, 400)
        expected = palette.sequential(np.array([0, 0.5, 1, 1]))
        assert [tuple(image[row, column]) for column, row in at] == [
            palette.eight_bit(color) for color in expected
        ]

    def test_any_title(self):
        """Line breaks, accents and letters that the font lacks are no reason for a failed run."""
        assert legend.printable("Sto\xdf \u2013 caf\xe9\n\u03c3") == "Sto? - cafe ?"
        draw(frame_of([[0.5, 0.5]], title="a\nb\t\u03c3" * 30, body_names=["\xe4\n"]), size=64)

    def test_clock(self):
        """The unit of the time is that of the whole run, so that it does not change in a video."""
        camera = fit((1, 1), 800)
        clock = lambda time, end: legend.heading(camera, "", time, end)[1].words  # noqa: E731
        assert clock(0.5, 3.5) == "t = 0.500 s"
        assert clock(0.0, 3.5) == "t = 0.000 s"
        assert clock(2e-5, 1e-3) == "t = 0.020 ms"
        assert clock(12345.0, 2e4) == "t = 12345.000 s"


def test_recorder_takes_the_view_of_the_scene(tmp_path):
    """What is not said is as it is without a view."""
    view = SceneView(turn=10, zoom=2, center=[0.5, 0.2, 0.1])
    simulation = SimpleNamespace()
    recorder = Images(tmp_path / "frames", simulation, Style(view=view))
    assert recorder.view == View(turn=10.0, tilt=View().tilt, zoom=2.0, center=[0.5, 0.2, 0.1])
    assert Images(tmp_path / "others", simulation, Style()).view == View()


COLOR_BY = get_args(Style.model_fields["color_by"].annotation)


@pytest.mark.parametrize("color_by", COLOR_BY)
def test_recorder_shows_every_quantity(tmp_path, rng, color_by):
    """Each value of output.images.color_by is drawn, and the scale of the colors is that of the
    values so far: with 0, but for density, where 990 to 1010 kg/m^3 would be one color."""
    scene = load_scene(SCENES / "two_disks_lattice.yaml")
    density, strain = rng.uniform(990, 1010, 5), rng.uniform(0, 2, 5)
    snapshot = Snapshot(
        time=0.0,
        step=0,
        position=rng.random((5, 2)),
        velocity=rng.random((5, 2)),
        mass=np.full(5, 1e-3),
        initial_volume=np.full(5, 2e-6),
        deformation_gradient=np.tile(np.eye(2), (5, 1, 1)),
        cauchy_stress=rng.random((5, 3, 3)),
        energy_density=np.zeros(5),
        volume_ratio=500 / density,
        plastic_strain=strain,
        spin=np.zeros((5, 2, 2)),
    )
    simulation = SimpleNamespace(
        scene=scene, snapshot=snapshot, end=1.0, body_of_particle=np.zeros(5, int)
    )
    recorder = Images(tmp_path / "frames", simulation, Style(color_by=color_by, size=64))
    recorder.record(simulation, is_output=True)
    assert len(list(recorder.folder.iterdir())) == recorder.count == 1
    if color_by == "density":
        assert [recorder.low, recorder.high] == pytest.approx([density.min(), density.max()])
    elif color_by == "plastic_strain":
        assert (recorder.low, recorder.high) == (0, strain.max())
    assert color_by in QUANTITIES or color_by == "body"
