"""Scenes made in Python, of the same models as those of files."""

from typing import Any

import numpy as np
import pytest
from pydantic import TypeAdapter

from mpm_taichi import scene
from mpm_taichi.errors import InputError
from mpm_taichi.scene import (
    Ball,
    Body,
    Domain,
    FLIPChoice,
    Lattice,
    LinearElastic,
    Method,
    Output,
    Scene,
    Time,
    dump_scene,
    load_scene,
    scene_schema,
)
from mpm_taichi.shapes import Shape
from tests.command_line import SCENES

ANY: Any = scene
"""The same models, given what a type checker would not have."""

RUBBER = LinearElastic(density=1000, youngs_modulus=1000, poissons_ratio=0.3)


def disk(name: str, at: float, **others) -> Body:
    parts: dict[str, Any] = {
        "velocity": [0.1, 0.1] if at < 0.5 else [-0.1, -0.1],
        "shape": Ball(center=[at, at], radius=0.2), "particles": Lattice(spacing=0.025),
    }  # fmt: skip
    return Body(name=name, material="rubber", **(parts | others))


def two_disks(**others) -> Scene:
    parts: dict[str, Any] = {
        "version": 1,
        "domain": Domain(size=[1.0, 1.0], cells=[20, 20]),
        "method": Method(basis="linear", transfer=FLIPChoice()),
        "time": Time(end=3.5, step=1e-3),
        "materials": {"rubber": RUBBER},
        "bodies": [disk("lower", 0.2), disk("upper", 0.8)],
    }
    return Scene(**(parts | others))


def test_the_published_scene_in_python():
    """Two disks as in scenes/two_disks_lattice.yaml: an equal Scene, and written out it is read
    back as one.  Words of the file (`type`) are the classes here."""
    file = load_scene(SCENES / "two_disks_lattice.yaml")
    output = Output.model_validate(file.output.model_dump())
    made = two_disks(title=file.title, source=file.source, output=output)
    assert made == file
    assert Ball(center=[0, 0], radius=1).type == "ball"
    assert Ball(center=[0, 0], radius=1) == TypeAdapter(Shape).validate_python(
        {"type": "ball", "center": [0, 0], "radius": 1}
    )
    assert "type" in scene_schema()["$defs"]["Ball"]["required"]  # a file has to say it
    assert "default" not in scene_schema()["$defs"]["Ball"]["properties"]["type"]


def test_made_scenes_are_read_back(tmp_path):
    """Also one with a preset and with mappings in place of models."""
    made = two_disks(
        materials={"rubber": {"preset": "rubber", "youngs_modulus": 2000}},
        method={"transfer": {"type": "flip", "ratio": 0.9}},
    )
    (tmp_path / "x.yaml").write_text(dump_scene(made))
    assert load_scene(tmp_path / "x.yaml") == made


def test_tuples_arrays_and_their_numbers_serve(rng):
    """Anything that holds numbers: lists, tuples, arrays, NumPy's floats and integers."""
    x, radius = rng.uniform(0.3, 0.7, 2), rng.uniform(0.1, 0.2)
    expected = Ball(center=x.tolist(), radius=float(radius))
    assert ANY.Ball(center=tuple(x), radius=np.float64(radius)) == expected
    assert ANY.Ball(center=x, radius=np.array(radius)) == expected
    assert ANY.Domain(size=np.ones(2), cells=np.array([4, 4])).cells == [4, 4]
    assert ANY.Lattice(per_cell=np.int64(2)).per_cell == 2


@pytest.mark.parametrize(
    "make, said",
    [
        (lambda: ANY.Ball(center=[0, 0], radius=-1), "radius: must be greater than 0 (got -1)"),
        (
            lambda: ANY.Ball(center=[0], radus=1),
            "Ball: center: must be a list of 2 or 3 numbers (got [0])\n"
            "Ball: radius: is required: a number greater than 0\n"
            "Ball: radus: unknown key; did you mean 'radius'?",
        ),
        (lambda: ANY.Lattice(), "Lattice: a lattice needs one of spacing and per_cell (got n"),
        (
            lambda: ANY.NeoHookean(density=1, youngs_modulus=1, poissons_ratio=0.5),
            "NeoHookean: poissons_ratio: must be greater than -1 and less than 0.5 (got 0.5)",
        ),
        (
            lambda: disk("a", 0.2, shape=RUBBER),
            "Body: shape.type: must be one of ball, box, cylinder, ring (got 'linear_elastic')",
        ),
        (lambda: ANY.Method(basis="quadratc"), "did you mean 'quadratic'?"),
        (
            lambda: two_disks(gravity=(0, 0, 1), time=Time(end=1e-4, step=1e-3)),
            "Scene: time.step: must not exceed time.end, 0.0001 (got 0.001)\n"
            "Scene: gravity: must have 2 entries, one for each axis of domain.size (got 3)",
        ),
        (
            lambda: two_disks(bodies=[disk("a", 0.2), disk("a", 0.8)]),
            "Scene: bodies[1].name: 'a' is also the name of bodies[0]",
        ),
        (
            lambda: two_disks(
                bodies=[disk("a", 0.2, shape=ANY.Box(min=(0.5, 0.5), max=(1.5, 0.7)))]
            ),
            "Scene: bodies[0].shape: leaves the domain: 0.5 m beyond x = 1",
        ),
    ],
)  # fmt: skip
def test_what_is_wrong_is_said_in_words(make, said):
    """An InputError, all faults at once, each with its place and in the words of scene files."""
    with pytest.raises(InputError) as caught:
        make()
    assert said in str(caught.value)
