"""The lattice against brute force and exact counts; the seeding report against hand counts."""

import json
from dataclasses import asdict
from itertools import product
from math import pi

import numpy as np
import pytest

from mpm_taichi import sampling
from mpm_taichi.errors import InputError
from mpm_taichi.sampling import SAMPLERS, Lattice, Points
from mpm_taichi.seeding import seeding_report
from mpm_taichi.shapes import Ball, Box


def lattice(**given):
    return Lattice(type="lattice", **given)


def ball(center, radius):
    return Ball(type="ball", center=list(map(float, center)), radius=float(radius))


def box(low, high):
    return Box(type="box", min=list(map(float, low)), max=list(map(float, high)))


def test_the_published_disk_has_208_particles():
    """Sulsky's disk: the points 0.0125 (odd, odd) with |x - c| < 0.2, found here in integers."""
    points = lattice(spacing=0.025).points(ball([0.2, 0.2], 0.2), 0.05, 2)
    pairs = [(i, j) for i, j in product(range(1, 32, 2), repeat=2)]
    exact = [(i, j) for i, j in pairs if (i - 16) ** 2 + (j - 16) ** 2 < 16**2]
    assert len(exact) == 208
    np.testing.assert_allclose(points.x, 0.0125 * np.array(exact), rtol=1e-15)
    assert (points.V0 == 0.025**2).all()


@pytest.mark.parametrize("dim", [2, 3])
def test_lattice_finds_every_point_inside(dim, rng):
    """All (k + 1/2) h of a large window that are inside, in order: the same set by brute force."""
    h = rng.uniform(0.05, 0.11)
    k = np.array(list(product(range(-18, 18), repeat=dim)))
    window = (k + 0.5) * h
    low = rng.uniform(-0.7, 0.0, dim)
    shapes = [ball(rng.uniform(-0.3, 0.3, dim), 0.35), box(low, low + rng.uniform(0.2, 0.7, dim))]
    for shape in shapes:
        x = lattice(spacing=h).points(shape, 1.0, dim).x
        np.testing.assert_array_equal(x, window[shape.signed_distance(window) < 0])


@pytest.mark.parametrize("dim", [2, 3])
def test_lattice_fills_boxes_of_whole_cells_exactly(dim, rng):
    """A box from n h to m h holds prod(m - n) points, its volume to the rounding of the sum."""
    for _ in range(20):
        h = rng.uniform(1e-3, 1)
        first = rng.integers(-8, 8, dim)
        count = rng.integers(1, 9, dim)
        shape = box(first * h, (first + count) * h)
        points = lattice(spacing=h).points(shape, 1.0, dim)
        assert len(points.x) == len(points.V0) == count.prod()
        assert points.V0.sum() == pytest.approx(shape.volume(), rel=1e-12)


@pytest.mark.parametrize("dim", [2, 3])
def test_points_on_the_surface_are_outside(dim, rng):
    """Faces through lattice points, off by rounding, leave count - 1 points per axis."""
    for _ in range(20):
        h = rng.uniform(1e-3, 1)
        first = rng.integers(-8, 8, dim) + 0.5
        count = rng.integers(2, 6, dim)
        off = rng.uniform(-1e-14, 1e-14, (2, dim)) * h
        shape = box(first * h + off[0], (first + count) * h + off[1])
        x = lattice(spacing=h).points(shape, 1.0, dim).x
        assert len(x) == (count - 1).prod()


@pytest.mark.parametrize("dim, unit", [(2, pi), (3, 4 / 3 * pi)])
def test_volume_error_is_bounded_by_the_surface(dim, unit, rng):
    """Whole cells differ from the ball only within half a cell diagonal of its surface."""
    for h in (0.1, 0.03):
        shape = ball(rng.uniform(-1, 1, dim), 0.5)
        volume = lattice(spacing=h).points(shape, 1.0, dim).V0.sum()
        reach = h * np.sqrt(dim) / 2
        assert unit * (0.5 - reach) ** dim < volume < unit * (0.5 + reach) ** dim


def test_per_cell_counts_along_each_axis():
    """Three per cell and axis: h = dx / 3, and nine points in each cell of a body of cells."""
    shape = box([0.1, 0.2], [0.5, 0.4])
    x = lattice(per_cell=3).points(shape, 0.1, 2).x
    np.testing.assert_array_equal(x, lattice(spacing=0.1 / 3).points(shape, 0.1, 2).x)
    _, counts = np.unique(np.floor(x / 0.1), axis=0, return_counts=True)
    assert len(counts) == 8 and (counts == 9).all()


def test_blocks_do_not_show(monkeypatch):
    """Candidates come in blocks to bound memory; their length changes nothing."""
    shape = ball([0.1, 0.2, 0.3], 0.2)
    whole = lattice(spacing=0.03).points(shape, 1.0, 3).x
    monkeypatch.setattr(sampling, "BLOCK", 7)
    np.testing.assert_array_equal(lattice(spacing=0.03).points(shape, 1.0, 3).x, whole)


@pytest.mark.parametrize(
    "given, shape, words",
    [
        ({"spacing": 1.0}, ball([0, 0], 0.1), "no point inside the ball.*smaller"),
        ({"per_cell": 1}, box([0.01, 0.01], [0.02, 0.02]), "no point inside the box"),
        ({"spacing": 1.0}, ball([1e20, 0], 1), "no point inside the ball"),
        ({"spacing": 1e-6}, ball([0, 0], 1), r"4e\+12 points around the ball.*larger"),
        ({"spacing": 1e-320}, ball([0, 0, 0], 1), "larger spacing"),
        ({"spacing": 1e-4}, box([0, 0, 0], [1e-9, 1e6, 1e6]), "larger spacing"),
    ],
)
def test_impossible_lattices_are_refused(given, shape, words):
    """Nothing inside, or more than can be counted: said before memory is asked for."""
    with pytest.raises(InputError, match=words):
        lattice(**given).points(shape, 0.05, shape.dimension)


@pytest.mark.parametrize(
    "given, words",
    [
        ({}, r"one of spacing and per_cell \(got neither\)"),
        ({"spacing": 0.1, "per_cell": 2}, r"\(got both\)"),
        ({"spacing": -0.1}, "greater than 0"),
        ({"per_cell": 0}, "must be at least 1"),
        ({"per_cell": 2.0}, "must be a whole number"),
        ({"per_cell": True}, "must be a whole number"),
    ],
)
def test_a_lattice_needs_one_spacing(given, words):
    """Exactly one of spacing and per_cell, each a positive number."""
    with pytest.raises(InputError, match=words):
        lattice(**given)


def test_samplers_say_whether_they_need_a_shape():
    """The scene's checks read it: a mesh file is the shape, the others fill one."""
    assert {sampler.__name__: sampler.needs_shape for sampler in SAMPLERS} == {
        "Lattice": True,
        "GmshMesh": True,
        "MeshFile": False,
    }


def test_seeding_report_counts():
    """Five particles in cells (0, 0), (0, 0), (0, 0), (2, 1), (-1, 0): 5 / 3 per cell, least 1."""
    x = np.array([[0.1, 0.1], [0.4, 0.2], [0.2, 0.3], [1.2, 0.6], [-0.1, 0.1]])
    points = Points(x, np.array([0.01, 0.02, 0.03, 0.01, 0.02]))
    report = seeding_report("lower", points, 0.5, 0.1)
    assert report.particles == 5
    assert report.volume == pytest.approx(0.09, rel=1e-14)
    assert report.volume_error == pytest.approx(-0.1, rel=1e-13)
    assert (report.smallest_volume, report.largest_volume) == (0.01, 0.03)
    assert report.particles_per_cell == pytest.approx(5 / 3, rel=1e-15)
    assert report.fewest_per_cell == 1
    assert json.loads(json.dumps(asdict(report))) == asdict(report)
    assert report.describe() == (
        "lower: 5 particles, volume 0.09 of 0.1 (-10.00 %), smallest 0.01, "
        "1.7 particles per cell (least 1)"
    )


def test_seeding_report_without_an_exact_volume():
    """A mesh file has no exact volume to compare with."""
    points = Points(np.array([[0.1, 0.1, 0.1]]), np.array([0.001]))
    report = seeding_report("part", points, 0.2, None)
    assert report.exact_volume is None and report.volume_error is None
    assert report.describe() == (
        "part: 1 particle, volume 0.001, smallest 0.001, 1.0 particles per cell (least 1)"
    )


def test_seeding_report_of_the_published_disk():
    """208 V0 = 0.13 against pi 0.04: +3.45 %; 2 x 2 per cell where a cell is full."""
    shape = ball([0.2, 0.2], 0.2)
    report = seeding_report(
        "disk", lattice(per_cell=2).points(shape, 0.05, 2), 0.05, shape.volume()
    )
    assert report.volume_error == pytest.approx(0.13 / (pi * 0.04) - 1, rel=1e-12)
    assert 1 <= report.fewest_per_cell <= report.particles_per_cell <= 4
