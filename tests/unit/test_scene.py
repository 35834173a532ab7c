"""Scenes that are right: what the reader makes of them, and what the writer and schema say."""

import re
import subprocess
import sys

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mpm_taichi.boundaries import Separate, Slip, Sticky, Wall
from mpm_taichi.errors import InputError
from mpm_taichi.model import Model
from mpm_taichi.scene import Scene, Walls, dump_scene, load_scene, scene_schema
from mpm_taichi.scene.document import parse

from .scene_text import TEXT, changed


@pytest.fixture
def load(tmp_path):
    """Writes a text to a file and loads it."""

    def load(text: str, *overrides: str) -> Scene:
        path = tmp_path / "scene.yaml"
        path.write_bytes(text.encode())
        return load_scene(path, overrides)

    return load


def plain_types(value) -> set[type]:
    if isinstance(value, dict):
        return set().union(*(plain_types(part) for part in [*value, *value.values()]))
    if isinstance(value, list):
        return set().union(*map(plain_types, value))
    return {type(value)}


def test_valid_scene(load):
    """The scene holds what the file says, and its properties follow from it."""
    scene = load(TEXT)
    assert (scene.dimension, scene.cell_size, scene.output_interval) == (2, 0.05, 0.05)
    assert scene.gravity_vector == [0, -9.81]
    assert (scene.method.basis_class.name, scene.method.transfer_class.__name__) == (
        "linear",
        "FLIP",
    )
    assert scene.domain.rules == (Wall(0, False, Slip), Wall(1, True, Sticky))
    assert [body.name for body in scene.bodies] == ["lower", "upper"]
    assert scene.bodies[1].velocity is None


def test_defaults(load):
    """What a file leaves out: MLS-MPM on quadratic B-splines, auto step, no gravity, output at
    hundredths of the end, no walls."""
    text = re.sub(r"(?s)method:.*?(?=time:)", "", TEXT)
    text = re.sub(r"(?m)^(gravity|output|title):.*\n", "", text).replace(", step: 1.0e-3", "")
    text = text.replace(", walls: {left: slip, top: sticky}", "")
    scene = load(text)
    assert (scene.method.basis, scene.method.transfer_class.__name__) == ("quadratic", "MLS")
    assert (scene.time.step, scene.time.safety) == ("auto", 0.5)
    assert scene.gravity_vector == [0.0, 0.0]
    assert scene.output_interval == scene.time.end / 100
    assert scene.domain.rules == ()
    assert scene.output.images != "none" and scene.output.images.size == 900


def test_one_rule_for_all_walls(load):
    """A word in place of the mapping holds for each side."""
    scene = load(changed("{left: slip, top: sticky}", "separate"))
    sides = [(axis, upper) for axis in (0, 1) for upper in (False, True)]
    assert scene.domain.rules == tuple(Wall(*side, Separate) for side in sides)


def test_three_dimensions(load):
    """Vectors of three entries make a 3D scene, with walls at the back and in front."""
    text = TEXT.replace("[1.0, 2.0], cells: [20, 40]", "[1, 2, 0.5], cells: [20, 40, 10]")
    text = text.replace("top: sticky", "front: sticky").replace("-9.81]", "-9.81, 0]")
    text = text.replace("[0.2, 0.2]", "[0.2, 0.2, 0.25]").replace("[0.1, 0.1]", "[0, 0, 1]")
    text = text.replace("[0.5, 1]", "[0.5, 1, 0]").replace("max: [1, 2]", "max: [1, 2, 0.5]")
    scene = load(text)
    assert scene.dimension == 3
    assert scene.domain.rules == (Wall(0, False, Slip), Wall(2, True, Sticky))


@pytest.mark.parametrize(
    "text, value",
    [
        ("3.5", 3.5),
        ("1e-3", 1e-3),
        ("1E6", 1e6),
        ("+.5", 0.5),
        ("1.", 1.0),
        ("7", 7),
        ("010", 10),
        ("0x1F", 31),
        ("0o17", 15),
        ("-0", 0),
        ("'3'", "3"),
        ("1_000", "1_000"),
        ("1:30", "1:30"),
        ("yes", "yes"),
        ("none", "none"),
        ("True", True),
        ("~", None),
        ("2001-01-01", "2001-01-01"),
    ],
)
def test_scalars_of_yaml_1_2(text, value):
    """The core schema of YAML 1.2: exponents need no point, and `yes`, 1_000 and 1:30 are words."""
    read = parse(f"key: {text}", "text").value["key"]
    assert read == value and type(read) is type(value)


def test_numbers_of_the_scene_are_plain(load):
    """Python's own floats, also where the file has integers: no type of a YAML library."""
    scene = load(TEXT)
    assert plain_types(scene.model_dump()) <= {float, int, bool, str, type(None)}
    assert type(scene.materials["rubber"].youngs_modulus) is float
    assert type(scene.bodies[1].shape.max[0]) is float


@pytest.mark.parametrize("before, newline", [("", "\r\n"), ("\ufeff", "\n"), ("# é\n\n", "\n")])
def test_texts_of_other_editors(load, before, newline):
    """Windows line ends, a byte order mark and comments say nothing."""
    assert load(before + TEXT.replace("\n", newline)) == load(TEXT)


@pytest.mark.parametrize(
    "override, value",
    [
        ("bodies[0].velocity=[0, 1]", lambda scene: scene.bodies[0].velocity == [0, 1]),
        ("bodies[1].velocity=[0, 1]", lambda scene: scene.bodies[1].velocity == [0, 1]),
        ("time.step=auto", lambda scene: scene.time.step == "auto"),
        ("time.end = 1e1", lambda scene: scene.time.end == 10),
        ("domain.cells[0]=20", lambda scene: scene.domain.cells == [20, 40]),
        ("output.history.every_steps=3", lambda scene: scene.output.history.every_steps == 3),
        ("output.snapshots=true", lambda scene: scene.output.snapshots is True),
        ("output.paraview={grid: true}", lambda scene: scene.output.paraview.grid is True),
        ("output.images=none", lambda scene: scene.output.images == "none"),
        ("title=a=b", lambda scene: scene.title == "a=b"),
        ("domain={size: [1, 2], cells: [10, 20]}", lambda scene: scene.cell_size == 0.1),
        ("gravity=", lambda scene: scene.gravity is None),
    ],
)
def test_overrides(load, override, value):
    """KEY=VALUE replaces one value, or adds a key that the file leaves out."""
    assert value(load(TEXT, override))


def test_last_override_wins(load):
    """They are applied in their order."""
    assert load(TEXT, "time={end: 1}", "time.end=2", "time.step=0.5").time.step == 0.5


def test_mesh_file_beside_the_scene(load, tmp_path):
    """A relative mesh file is looked up from the folder of the scene, whatever the folder of the
    process is, and the scene holds its absolute path."""
    (tmp_path / "meshes").mkdir()
    mesh = tmp_path / "meshes" / "disk.msh"
    mesh.write_text("")
    text = changed("    shape: {type: box, min: [0.5, 1], max: [1, 2]}\n", "").replace(
        "{type: gmsh, size: 0.03}", "{type: mesh, file: meshes/disk.msh, move: [0.5, 1]}"
    )
    scene = load(text)
    assert scene.bodies[1].particles.file == str(mesh)
    assert load(dump_scene(scene)) == scene


def test_round_trip(load):
    """What the writer writes, the reader turns into an equal scene, and so on.  The type of a
    choice comes first, as people write it."""
    scene = load(TEXT)
    assert "  rubber: {type: linear_elastic, density: 1000.0," in dump_scene(scene)
    assert load(dump_scene(scene)) == scene
    assert dump_scene(load(dump_scene(scene))) == dump_scene(scene)


@settings(max_examples=60, deadline=None)
@given(
    text=st.one_of(
        st.text(),
        st.from_regex(r"[-+.0-9eExo_:#, ~a-z{}&*!|>'\"%@`\[\]-]{0,12}", fullmatch=True),
        st.sampled_from(["null", "~", "yes", "1e3", ".5e3", ".nan", "<<", "---", "...", "9" * 400]),
    ),
    number=st.floats(min_value=1e-300, max_value=1e300),
)
def test_round_trip_of_any_text_and_number(tmp_path_factory, text, number):
    """Texts that look like something else come back as texts, numbers to the last bit; names are on
    one line, of characters that show."""
    scene = Scene.model_validate(parse(TEXT, "text").value)
    in_line = "".join(filter(str.isprintable, text))
    materials = {text: scene.materials["rubber"].model_copy(update={"density": number})}
    bodies = [
        body.model_copy(update={"name": f"{in_line}{n}", "material": text})
        for n, body in enumerate(scene.bodies)
    ]
    update = {"title": text, "source": 60 * text, "materials": materials, "bodies": bodies}
    scene = scene.model_copy(update=update)
    path = tmp_path_factory.getbasetemp() / "any.yaml"
    path.write_text(dump_scene(scene), encoding="utf-8")
    assert load_scene(path) == scene


def test_scene_checks_itself():
    """A Scene made in Python passes the same checks, so that a Scene that exists is right."""
    data = parse(TEXT, "text").value
    data["bodies"][0]["material"] = "steel"
    data["gravity"] = [0, 0, -9.81]
    with pytest.raises(ValueError, match=r"bodies.0.material(?s:.*)no material is named 'steel'"):
        Scene.model_validate(data)
    with pytest.raises(ValueError, match=r"gravity\n.*must have 2 entries"):
        Scene.model_validate(data)


def test_scene_is_frozen(load):
    """Nothing changes a scene once it is checked."""
    with pytest.raises(ValueError, match="frozen"):
        load(TEXT).title = "other"


def objects(schema: dict):
    return [rule for rule in schema["$defs"].values() if rule.get("type") == "object"] + [schema]


def test_schema_describes_every_key():
    """Each key of the sections has a description, unknown keys are refused, references resolve."""
    schema = scene_schema()
    assert schema["$schema"] == "https://json-schema.org/draft/2020-12/schema"
    for reference in re.findall(r"'\$ref': '#/\$defs/(\w+)'", str(schema)):
        assert reference in schema["$defs"]
    for rule in objects(schema):
        assert rule["additionalProperties"] is False
    named = {model.__name__ for model in Model.__subclasses__() if "scene" in model.__module__}
    assert named >= {"Domain", "Walls", "Method", "Time", "Body", "Images", "History", "Output"}
    for rule in [schema["$defs"][name] for name in named - {"Scene"}] + [schema]:
        for key, value in rule["properties"].items():
            assert value.get("description"), key


def test_schema_accepts_the_scene(load):
    """The JSON Schema accepts what the reader accepts, and flags a wrong key, by jsonschema."""
    jsonschema = pytest.importorskip("jsonschema")
    validator = jsonschema.Draft202012Validator(scene_schema())
    assert not list(validator.iter_errors(parse(TEXT, "text").value))
    assert not list(validator.iter_errors(parse(dump_scene(load(TEXT)), "text").value))
    assert list(validator.iter_errors(parse(TEXT.replace("title", "titel"), "text").value))


def test_loading_starts_nothing(tmp_path):
    """A scene with a mesh to be made is checked without gmsh, meshio or a running Taichi."""
    path = tmp_path / "scene.yaml"
    path.write_text(TEXT)
    program = f"""
import sys
from mpm_taichi.scene import load_scene
load_scene({str(path)!r})
assert not {{"gmsh", "meshio", "matplotlib"}} & set(sys.modules)
if "taichi" in sys.modules:
    assert sys.modules["taichi"].lang.impl.get_runtime().prog is None
"""
    subprocess.run([sys.executable, "-c", program], check=True)


def test_walls_of_one_word_and_each(load):
    """`walls: slip` and a mapping that says slip six times are the same walls."""
    sides = ", ".join(f"{side}: slip" for side in ("left", "right", "bottom", "top"))
    word = load(changed("{left: slip, top: sticky}", "slip"))
    each = load(changed("{left: slip, top: sticky}", f"{{{sides}}}"))
    assert isinstance(each.domain.walls, Walls)
    assert word.domain.rules == each.domain.rules


def test_faults_are_input_errors(load):
    """The command line turns InputError into exit code 2."""
    with pytest.raises(InputError):
        load("")
