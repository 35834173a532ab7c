"""Shapes against independent formulas, and gmsh's solids against the shapes."""

from math import pi

import numpy as np
import pytest
from pydantic import TypeAdapter, ValidationError

from mpm_taichi.gmsh_session import gmsh_session
from mpm_taichi.shapes import SHAPES, Ball, Box, Ring, Shape

EXAMPLES = [
    Ball(type="ball", center=[0.3, -0.2], radius=0.7),
    Ball(type="ball", center=[0.3, -0.2, 1.1], radius=0.7),
    Box(type="box", min=[-0.4, 0.1], max=[0.5, 0.35]),
    Box(type="box", min=[-0.4, 0.1, 2.0], max=[0.5, 0.35, 2.6]),
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
    list(zip(EXAMPLES, [pi * 0.49, 4 / 3 * pi * 0.343, 0.225, 0.135, pi * 0.33], strict=True)),
)
def test_volume(shape, volume):
    """pi r^2, 4/3 pi r^3, products of edges, pi (R^2 - r^2), to the rounding of a few steps."""
    assert shape.volume() == pytest.approx(volume, rel=1e-14)


@every_shape
def test_negative_distance_fills_the_volume(shape, rng):
    """The share of random points below zero is volume / window, to 6 standard deviations."""
    count = 200_000
    inside = (shape.signed_distance(around(shape, rng, count)) < 0).mean()
    low, high = shape.bounds()
    share = shape.volume() / np.prod(2 * (high - low))
    assert abs(inside - share) < 6 * np.sqrt(share * (1 - share) / count)


@every_shape
def test_distance_is_exact(shape, rng):
    """Distance to the surface, |x - y| for the closest of its points y, written out per shape."""
    x = around(shape, rng, 1000)
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
    """No point inside is out of bounds, and each side of the bounds is touched by the shape."""
    low, high = shape.bounds()
    x = around(shape, rng, 20_000)
    inside = x[shape.signed_distance(x) < 0]
    assert (low < inside).all() and (inside < high).all()
    middle = (low + high) / 2
    for axis in range(shape.dimension):
        for side in (low, high):
            touching = np.where(np.arange(shape.dimension) == axis, side, middle)
            assert shape.signed_distance(touching[None])[0] == pytest.approx(0, abs=1e-15)


@every_shape
def test_gmsh_builds_the_same_solid(shape):
    """Volume and center of gravity of gmsh's entity are the shape's: 1e-9, its quadrature."""
    with gmsh_session() as gmsh:
        tag = shape.add_to_gmsh(gmsh)
        volume = gmsh.model.occ.getMass(shape.dimension, tag)
        center = gmsh.model.occ.getCenterOfMass(shape.dimension, tag)[: shape.dimension]
    assert volume == pytest.approx(shape.volume(), rel=1e-9)
    np.testing.assert_allclose(center, np.mean(shape.bounds(), axis=0), atol=1e-9)


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
        ({"type": "blob"}, "ball"),
    ],
)
def test_nonsense_is_refused(given, words):
    """What is no region of positive volume in 2D or 3D is an error that says why."""
    with pytest.raises(ValidationError, match=words):
        TypeAdapter(Shape).validate_python(given)
