"""Files that were damaged, or made to harm."""

import time

import meshio
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mpm_taichi.errors import InputError
from mpm_taichi.memory import refuse_too_much
from mpm_taichi.meshes import MeshFile
from mpm_taichi.scene import load_scene
from mpm_taichi.seeding import expected_counts, seed
from tests.unit.scene_text import TEXT
from tests.unit.test_scene_fuzz import KEYS, VALUES, in_yaml

FORMS = {
    "ascii.msh": {"file_format": "gmsh22", "binary": False},
    "binary.msh": {"file_format": "gmsh", "binary": True},
    "binary.vtu": {"file_format": "vtu", "binary": True},
    "ascii.vtk": {"file_format": "vtk", "binary": False},
}
SECONDS = 20.0
"""For one file, on a loaded machine; whole ones take some milliseconds."""


@pytest.fixture(scope="module")
def meshes(tmp_path_factory):
    """A square of 18 triangles in each form, as bytes."""
    folder = tmp_path_factory.mktemp("meshes")
    n = 4
    x, y = np.meshgrid(np.linspace(0, 1, n), np.linspace(0, 1, n))
    points = np.column_stack([x.ravel(), y.ravel(), np.zeros(n * n)])
    corners = [i * n + j for i in range(n - 1) for j in range(n - 1)]
    cells = [t for c in corners for t in ((c, c + 1, c + n), (c + 1, c + n + 1, c + n))]
    for name, form in FORMS.items():
        meshio.Mesh(points, [("triangle", np.array(cells))]).write(folder / name, **form)
    return {name: (folder / name).read_bytes() for name in FORMS}


def damaged(content: bytes, rng) -> bytes:
    """Bits flipped, parts cut out, doubled, filled with noise, or digits changed."""
    spoiled = bytearray(content)
    for _ in range(rng.integers(1, 4)):
        at, length = int(rng.integers(len(spoiled))), int(rng.integers(1, 40))
        kind = rng.integers(5)
        if kind == 0:
            spoiled[at] ^= 1 << int(rng.integers(8))
        elif kind == 1:
            del spoiled[at : at + length * int(rng.integers(1, 30))]
        elif kind == 2:
            spoiled[at:at] = spoiled[at : at + length]
        elif kind == 3:
            spoiled[at : at + length] = rng.bytes(length)
        else:
            digits = [k for k, byte in enumerate(spoiled) if chr(byte).isdigit()]
            for k in rng.choice(digits, min(3, len(digits))) if digits else ():
                spoiled[k] = ord("0") + int(rng.integers(10))
        if not spoiled:
            break
    return bytes(spoiled)


def reads_or_refuses(path) -> bool:
    began = time.monotonic()
    try:
        MeshFile(type="mesh", file=str(path), move=None).points(None, 0.1, 2)
        fine = True
    except InputError as error:
        assert str(error).startswith(str(path))
        fine = False
    assert time.monotonic() - began < SECONDS
    return fine


@pytest.mark.parametrize("count", [50, pytest.param(2000, marks=pytest.mark.campaign)])
def test_damaged_meshes_are_read_or_refused(meshes, tmp_path, rng, count):
    """Each form, damaged at random: points of positive volume, or an InputError that begins with
    the name of the file; nothing else, and soon."""
    refused = 0
    for _ in range(count):
        for name, content in meshes.items():
            path = tmp_path / name
            path.write_bytes(damaged(content, rng))
            refused += not reads_or_refuses(path)
    print(f"{refused} of {count * len(meshes)} refused")
    assert refused > count
    for name, content in meshes.items():
        (tmp_path / name).write_bytes(content)
        assert reads_or_refuses(tmp_path / name)


@pytest.mark.campaign
@settings(max_examples=5000, deadline=None)
@given(st.lists(st.tuples(KEYS, VALUES), min_size=1, max_size=3))
def test_five_thousand_scenes_are_seeded_or_refused(tmp_path_factory, changes):
    """Whatever stands at keys of a valid scene: it is loaded, its memory predicted and its bodies
    seeded, or an InputError says what is wrong."""
    path = tmp_path_factory.getbasetemp() / "values.yaml"
    path.write_text(TEXT)
    try:
        scene = load_scene(path, [f"{key}={in_yaml(value)}" for key, value in changes])
        counts = expected_counts(scene)
        refuse_too_much(scene, counts, "cpu", "f64")
        if sum(counts) < 100_000:
            seed(scene)
    except InputError:
        pass
