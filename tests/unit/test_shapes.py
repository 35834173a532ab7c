"""Shapes against independent formulas, and gmsh's solids against the shapes."""

from itertools import product
from math import pi

import numpy as np
import pytest
from pydantic import TypeAdapter, ValidationError

from mpm_taichi.gmsh_session import gmsh_session
from mpm_taichi.sampling import GmshMesh, Lattice
from mpm_taichi.shapes import SHAPES, Ball, Box, Cylinder, Ring, Shape

CYLINDER = {"type": "cylinder", "center": [0.3, -0.2, 1.1], "radius": 0.7, "length": 1.6}
EXAMPLES = [
    Ball(type="ball", center=[0.3, -0.2], radius=0.7),
    Ball(type="ball", center=[0.3, -0.2, 1.1], radius=0.7),
    Box(type="box", min=[-0.4, 0.1], max=[0.5, 0.35]),
    Box(type="box", min=[-0.4, 0.1, 2.0], max=[0.5, 0.35, 2.6]),
    Cylinder(**CYLINDER, axis="y"),
    Cylinder(**CYLINDER, axis="x", from_angle=180, to_angle=270),
    Ring(type="ring", center=[0.3, -0.2], inner_radius=0.4, outer_radius=0.7),
]
every_shape = pytest.mark.parametrize("shape", EXAMPLES, ids=repr)


def around(shape, rng, count):
    """Points in the bounds, widened by half their extent on each side."""
    low, high = shape.bounds()
    margin = (high - low) / 2
    return rng.uniform(low - margin, high + margin, (count, shape.dimension))


def test_every_shape_has_an_example():
    """The properties below hold for each shape of the catalogue."""
    assert {type(shape) for shape in EXAMPLES} == set(SHAPES)


@pytest.mark.parametrize(
    "shape, volume",
    list(
        zip(
            EXAMPLES,
            [
                *(pi * 0.49, 4 / 3 * pi * 0.343, 0.225, 0.135),
                *(pi * 0.784, pi * 0.196, pi * 0.33),
            ],
            strict=True,
        )
    ),
)
def test_volume(shape, volume):
    """pi r^2, 4/3 pi r^3, products of edges, pi r^2 l and a quarter of it, pi (R^2 - r^2), to the
    rounding of a few steps."""
    assert shape.volume() == pytest.approx(volume, rel=1e-14)


@every_shape
def test_negative_distance_fills_the_volume(shape, rng):
    """The share of random points below zero is volume / window, to 6 standard deviations."""
    count = 200_000
    inside = (shape.signed_distance(around(shape, rng, count)) < 0).mean()
    low, high = shape.bounds()
    share = shape.volume() / np.prod(2 * (high - low))
    assert abs(inside - share) < 6 * np.sqrt(share * (1 - share) / count)


def distance_to_cylinder(shape, x):
    """Of x [n, 3] from the surface, and whether inside: in its plane the nearest of the arc, where
    the angle of x is on it, and of points of the two cuts; then that of the side, which lies at
    heights up to half the length, and that of the ends, which fill the plane's part."""
    along = "xyz".index(shape.axis)
    a, b, height = np.roll(x - shape.center, -along - 1, axis=1).T
    r, beyond = np.hypot(a, b), np.abs(height) - shape.length / 2
    width = shape.to_angle - shape.from_angle
    is_between = np.degrees(np.arctan2(b, a)) % 360
    is_between = (is_between - shape.from_angle) % 360 < width
    rim = np.where(is_between, np.abs(r - shape.radius), np.inf)
    for angle in np.radians([shape.from_angle, shape.to_angle] if width < 360 else []):
        way = np.clip(a * np.cos(angle) + b * np.sin(angle), 0, shape.radius)
        rim = np.minimum(rim, np.hypot(a - way * np.cos(angle), b - way * np.sin(angle)))
    in_plane = is_between & (r < shape.radius)
    side = np.hypot(rim, np.maximum(beyond, 0))
    ends = np.hypot(np.where(in_plane, 0, rim), beyond)
    return np.minimum(side, ends), in_plane & (beyond < 0)


@every_shape
def test_distance_is_exact(shape, rng):
    """Distance to the surface, |x - y| for the closest of its points y, written out per shape."""
    x = around(shape, rng, 1000)
    if isinstance(shape, Cylinder):
        distance, inside = distance_to_cylinder(shape, x)
        signed = np.where(inside, -distance, distance)
        np.testing.assert_allclose(shape.signed_distance(x), signed, atol=1e-15)
        return
    if isinstance(shape, Ball):
        offset = x - shape.center
        direction = offset / np.sqrt((offset**2).sum(axis=1, keepdims=True))
        closest = shape.center + shape.radius * direction
        inside = (offset**2).sum(axis=1) < shape.radius**2
    elif isinstance(shape, Ring):
        offset = x - shape.center
        distance = np.sqrt((offset**2).sum(axis=1))
        inside = (distance > shape.inner_radius) & (distance < shape.outer_radius)
        middle = 0.5 * (shape.inner_radius + shape.outer_radius)
        nearest = np.where(distance < middle, shape.inner_radius, shape.outer_radius)
        closest = shape.center + offset * (nearest / distance)[:, None]
    else:
        closest = np.clip(x, shape.min, shape.max)
        inside = (closest == x).all(axis=1)
        for p, point in enumerate(x):
            if inside[p]:
                gaps = [*(point - shape.min), *(shape.max - point)]
                side, axis = divmod(int(np.argmin(gaps)), shape.dimension)
                closest[p, axis] = (shape.min, shape.max)[side][axis]
    distance = np.sqrt(((x - closest) ** 2).sum(axis=1))
    signed = np.where(inside, -distance, distance)
    np.testing.assert_allclose(shape.signed_distance(x), signed, atol=1e-15)


@every_shape
def test_bounds_are_tight(shape, rng):
    """No point inside is out of bounds, and each side of the bounds is touched by the shape, in its
    middle or, by a sector, at an edge."""
    low, high = shape.bounds()
    x = around(shape, rng, 20_000)
    inside = x[shape.signed_distance(x) < 0]
    assert (low < inside).all() and (inside < high).all()
    places = np.array([low, (low + high) / 2, high])
    points = np.array(list(product(*places.T)))
    touching = np.abs(shape.signed_distance(points)) < 1e-15
    for axis in range(shape.dimension):
        for side in (low, high):
            assert touching[points[:, axis] == side[axis]].any()


@every_shape
def test_gmsh_builds_the_same_solid(shape):
    """Volume and center of gravity of gmsh's entity are the shape's: 1e-9, its quadrature."""
    middle = np.mean(shape.bounds(), axis=0)
    if getattr(shape, "to_angle", 360) == 270:  # about x: that of a quarter disk, 4 r / 3 pi off
        middle = np.array(shape.center) - [0, *2 * [4 * shape.radius / (3 * pi)]]
    with gmsh_session() as gmsh:
        tag = shape.add_to_gmsh(gmsh)
        volume = gmsh.model.occ.getMass(shape.dimension, tag)
        center = gmsh.model.occ.getCenterOfMass(shape.dimension, tag)[: shape.dimension]
    assert volume == pytest.approx(shape.volume(), rel=1e-9)
    np.testing.assert_allclose(center, middle, atol=1e-9)


@pytest.mark.parametrize("axis", "xyz")
def test_sectors_of_any_angles(axis, rng):
    """Angles drawn at random, also beyond a full turn: the distance is exact, to the rounding of
    angles of 20 rad; the bounds are those of the center and of 20,001 points of the arc, which miss
    an extreme by (2 pi / 20,000)^2 / 2 of the radius at most; and gmsh turns its solid to the same
    place: center of gravity at 2/3 r sin w / w along the bisector, w being half the width."""
    start, width = rng.uniform(-720, 720), rng.uniform(5, 355)
    shape = Cylinder(**CYLINDER, axis=axis, from_angle=start, to_angle=start + width)
    x = around(shape, rng, 1000)
    distance, inside = distance_to_cylinder(shape, x)
    signed = np.where(inside, -distance, distance)
    np.testing.assert_allclose(shape.signed_distance(x), signed, atol=1e-13)

    turned = [(step + 1 + "xyz".index(axis)) % 3 for step in range(3)]
    phi = np.radians(start + width * np.linspace(0, 1, 20_001))
    rim = np.concatenate([np.stack([np.cos(phi), np.sin(phi)], axis=1), np.zeros((1, 2))])
    low, high = (np.array(side)[turned][:2] for side in np.array(shape.bounds()) - shape.center)
    np.testing.assert_allclose(low, shape.radius * rim.min(axis=0), atol=1e-7)
    np.testing.assert_allclose(high, shape.radius * rim.max(axis=0), atol=1e-7)

    w, bisector = np.radians(width / 2), np.radians(start + width / 2)
    off = 2 / 3 * shape.radius * np.sin(w) / w * np.array([np.cos(bisector), np.sin(bisector), 0])
    with gmsh_session() as gmsh:
        center = gmsh.model.occ.getCenterOfMass(3, shape.add_to_gmsh(gmsh))
    np.testing.assert_allclose((np.array(center) - shape.center)[turned], off, atol=1e-9)


def test_cylinder_as_lattice_and_as_mesh():
    """Both fill it: a lattice of 14 points along the radius to the scatter of its cubes at the rim,
    2 %; tetrahedra of a sixth of the radius to the sagitta of theirs, (1/6)^2 / 8 of the radius,
    1 % of the volume.  Every point is inside."""
    shape = Cylinder(**CYLINDER, axis="y", from_angle=180, to_angle=270)
    for sampling, tolerance in (
        (Lattice(type="lattice", spacing=0.05, per_cell=None), 0.02),
        (GmshMesh(type="gmsh", size=0.7 / 6), 0.01),
    ):
        points = sampling.points(shape, 0.1, 3)
        assert points.V0.sum() == pytest.approx(shape.volume(), rel=tolerance)
        assert (shape.signed_distance(points.x) < 0).all()


@pytest.mark.parametrize(
    "given, words",
    [
        ({"type": "ball", "center": [0, 0], "radius": 0}, "greater than 0"),
        ({"type": "ball", "center": [0, 0], "radius": "1"}, "valid number"),
        ({"type": "ball", "center": [0], "radius": 1}, "at least 2"),
        ({"type": "ball", "center": [0, 0, 0, 0], "radius": 1}, "at most 3"),
        ({"type": "ball", "center": [0, float("nan")], "radius": 1}, "finite"),
        ({"type": "ball", "center": [0, 0], "radius": 1, "color": 1}, "not permitted"),
        ({"type": "box", "min": [0, 0], "max": [1, 1, 1]}, "equally many.* 2 and 3"),
        ({"type": "box", "min": [0, 0.5], "max": [1, 0.2]}, r"along y \(got 0.5 and 0.2\)"),
        ({"type": "box", "min": [0, 0, 1], "max": [1, 1, 1]}, "along z"),
        (
            {"type": "ring", "center": [0, 0], "inner_radius": 2, "outer_radius": 1},
            r"less than outer_radius, 1 \(got 2\)",
        ),
        ({**CYLINDER, "axis": "w"}, "'x', 'y' or 'z'"),
        ({**CYLINDER, "axis": "x", "center": [0, 0]}, "at least 3"),
        ({**CYLINDER, "axis": "x", "from_angle": 90, "to_angle": 45}, r"\(got 90 and 45\)"),
        ({**CYLINDER, "axis": "x", "from_angle": -1}, r"by 360 degrees at most \(got -1 and 360\)"),
        ({"type": "blob"}, "ball"),
    ],
)
def test_nonsense_is_refused(given, words):
    """What is no region of positive volume in 2D or 3D is an error that says why."""
    with pytest.raises(ValidationError, match=words):
        TypeAdapter(Shape).validate_python(given)
