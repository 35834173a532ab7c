"""Scenes that are wrong: each fault with its place, its key and a sentence, and never a traceback.

In the tables a passage of a valid scene is replaced; the lines that follow are all that the reader
says, without the name of the file."""

import pytest

from mpm_taichi.errors import InputError
from mpm_taichi.scene import load_scene

from .scene_text import TEXT, changed

BOX = "    shape: {type: box, min: [0.5, 1], max: [1, 2]}\n"
KEYS = (
    "version, title, source, domain, method, time, definitions, gravity, body_force, materials, "
    "bodies, exact, output"
)
BASES = "linear, gimp, quadratic, cubic, quadratic_boundary, cubic_boundary"


def faults(path, text: str | bytes, *overrides: str) -> list[str]:
    """What the reader says about a text, one entry for each line, without the name of the file."""
    path.write_bytes(text if isinstance(text, bytes) else text.encode("utf-8", "surrogatepass"))
    with pytest.raises(InputError) as caught:
        load_scene(path, overrides)
    return [line.removeprefix(f"{path}:") for line in str(caught.value).splitlines()]


SECTIONS = [
    ("version: 1", "version: 2", "1:1: version: must be 1 (got 2)"),
    ("version: 1\n", "", "1:1: version: is required: 1"),
    ("title: Two disks", "title:", "2:1: title: must be text (got nothing)"),
    ("title: Two", "titel: Two", "2:1: titel: unknown key; did you mean 'title'?"),
    ("title: Two disks", "colour: red", f"2:1: colour: unknown key; known keys: {KEYS}"),
    (
        "size: [1.0, 2.0]",
        "size: [-1, 2.0]",
        "3:17: domain.size[0]: must be greater than 0 (got -1)",
    ),
    (
        "[1.0, 2.0]",
        "[1.0]",
        "3:10: domain.size: must be a list of 2 or 3 numbers, each greater than 0 (got [1.0])",
    ),
    (
        "[20, 40]",
        "[20, 40.0]",
        "3:40: domain.cells[1]: must be a whole number of at least 1 (got 40.0)",
    ),
    (
        "[20, 40]",
        "[true, 40]",
        "3:36: domain.cells[0]: must be a whole number of at least 1 (got true)",
    ),
    (
        "left: slip",
        "left: clamped",
        "3:53: domain.walls.left: must be one of none, sticky, slip, separate, periodic "
        "(got 'clamped')",
    ),
    (
        "left: slip",
        "lef: slip",
        "3:53: domain.walls.lef: unknown key; did you mean 'left'?",
    ),
    (
        "{left: slip, top: sticky}",
        "closed",
        "3:45: domain.walls: must be none, sticky, slip, separate, periodic or a mapping with the "
        "keys left, right, bottom, top, back, front (got 'closed')",
    ),
    (
        "basis: linear",
        "basis: hat",
        f"5:3: method.basis: must be one of {BASES} (got 'hat')",
    ),
    (
        "type: flip",
        "type: flp",
        "6:14: method.transfer.type: must be one of apic, flip, pic, tpic, xpic (got 'flp'); "
        "did you mean 'flip'?",
    ),
    (
        "type: flip",
        "type: flip, force: mls",
        "6:26: method.transfer.force: unknown key; known keys: type, relaxation_time, ratio",
    ),
    (
        "{type: flip}",
        "flip",
        "6:3: method.transfer: must be a mapping with type apic or flip or pic or tpic or xpic "
        "(got 'flip')",
    ),
    (
        "basis: linear",
        "stress_update: last",
        "5:3: method.stress_update: must be one of usl, musl, usf (got 'last')",
    ),
    (
        "step: 1.0e-3",
        "step: fast",
        "7:18: time.step: must be a number greater than 0 or auto (got 'fast')",
    ),
    (
        "step: 1.0e-3",
        "step: atuo",
        "7:18: time.step: must be a number greater than 0 or auto (got 'atuo'); "
        "did you mean 'auto'?",
    ),
    (
        "step: 1.0e-3",
        "step: -1",
        "7:18: time.step: must be a number greater than 0 or auto (got -1)",
    ),
    (
        "step: 1.0e-3",
        "step: {dt: 1}",
        "7:18: time.step: must be a number greater than 0 or auto (got a mapping)",
    ),
    ("end: 3.5", "end: '3.5'", "7:8: time.end: must be a number greater than 0 (got '3.5')"),
    ("end: 3.5, ", "", "7:1: time.end: is required: a number greater than 0"),
    (
        "step: 1.0e-3",
        "safety: 1.5",
        "7:18: time.safety: must be greater than 0 and at most 1 (got 1.5)",
    ),
    (
        "gravity: [0, -9.81]",
        "gravity: -9.81",
        "8:1: gravity: must be a list of 2 or 3 numbers (got -9.81)",
    ),
    (
        "color_by: speed",
        "color_by: sped",
        "26:32: output.images.color_by: must be one of body, speed, pressure, stress, density, "
        "plastic_strain (got 'sped'); did you mean 'speed'?",
    ),
    (
        "color_by: speed",
        "range: [2, 1]",
        "26:32: output.images.range: must increase (got [2.0, 1.0])",
    ),
    (
        "color_by: speed",
        "color_by: pressure, range: [0, 5]",
        "26:52: output.images.range: must have 0 in its middle for pressure: [-5, 5] (got [0.0, "
        "5.0])",
    ),
    (
        "color_by: speed",
        "size: 9",
        "26:32: output.images.size: must be at least 64 and at most 8192 (got 9)",
    ),
    (
        "{color_by: speed}",
        "no",
        "26:23: output.images: must be a mapping with the keys color_by, grid, size, range, view "
        "or none (got 'no'); did you mean 'none'?",
    ),
    (
        "color_by: speed",
        "view: {turn: 90}",
        "26:39: output.images.view.turn: a 2D domain is seen straight on: only a 3D one can be "
        "turned",
    ),
    (
        "color_by: speed",
        "view: {center: [1, 1, 1]}",
        "26:39: output.images.view.center: must have 2 entries, one for each axis of domain.size "
        "(got 3)",
    ),
    (
        "{color_by: speed}",
        "none, paraview: {gird: true}",
        "26:48: output.paraview.gird: unknown key; did you mean 'grid'?",
    ),
    (
        "{color_by: speed}",
        "none, paraview: 1",
        "26:37: output.paraview: must be true or false or a mapping with the keys grid (got 1)",
    ),
    (
        "{color_by: speed}",
        "none, snapshots: maybe",
        "26:37: output.snapshots: must be true or false (got 'maybe')",
    ),
]

MATERIALS_AND_BODIES = [
    (
        "youngs_modulus: 1E6",
        "youngs_modulus: -3",
        "10:49: materials.rubber.youngs_modulus: must be greater than 0 (got -3)",
    ),
    (
        "    youngs_modulus: 1000\n    poissons_ratio: 0.3\n",
        "    youngs_modulus: 1000\n    poissons_ratio: 0.6\n",
        "15:5: materials.soft.poissons_ratio: must be greater than -1 and less than 0.5 (got 0.6)",
    ),
    (
        "type: neo_hookean",
        "type: neohookean",
        "12:5: materials.soft.type: must be one of drucker_prager, fixed_corotated, fluid, gas, "
        "hencky, hypoelastic, linear_elastic, neo_hookean, snow, von_mises (got 'neohookean'); did "
        "you mean 'neo_hookean'?",
    ),
    (
        "    type: neo_hookean\n",
        "",
        "11:3: materials.soft.type: is required where there is no preset: drucker_prager or "
        "fixed_corotated or fluid or gas or hencky or hypoelastic or linear_elastic or neo_hookean "
        "or snow or von_mises",
    ),
    (
        "    density: 1e3\n",
        "    densty: 1e3\n",
        "11:3: materials.soft.density: is required: a number greater than 0",
        "13:5: materials.soft.densty: unknown key; did you mean 'density'?",
    ),
    (
        "    material: soft\n",
        "",
        "22:5: bodies[1].material: is required: text",
    ),
    (
        "name: lower",
        "name: ''",
        "17:5: bodies[0].name: must be text that is not empty (got '')",
    ),
    (
        "material: rubber",
        "material: ruber",
        "18:5: bodies[0].material: no material is named 'ruber'; did you mean 'rubber'?",
    ),
    (
        "material: rubber",
        "material: steel",
        "18:5: bodies[0].material: no material is named 'steel'; the materials are rubber, soft",
    ),
    ("name: upper", "name: lower", "22:5: bodies[1].name: 'lower' is also the name of bodies[0]"),
    (
        "name: upper",
        'name: "up\\nper"',
        "22:5: bodies[1].name: must be on one line, of characters that show",
    ),
    (
        "type: ball,",
        "type: bal,",
        "19:13: bodies[0].shape.type: must be one of ball, box, cylinder, ring (got 'bal'); did "
        "you mean 'ball'?",
    ),
    (
        "type: ball, ",
        "",
        "19:5: bodies[0].shape.type: is required: ball or box or cylinder or ring",
    ),
    (
        ", radius: 0.2}",
        ", radus: 0.2}",
        "19:5: bodies[0].shape.radius: is required: a number greater than 0",
        "19:45: bodies[0].shape.radus: unknown key; did you mean 'radius'?",
    ),
    (
        "center: [0.2, 0.2]",
        "center: [0.2, '0.2']",
        "19:39: bodies[0].shape.center[1]: must be a number (got '0.2')",
    ),
    (
        "max: [1, 2]",
        "max: [0.1, 2]",
        "24:5: bodies[1].shape: min must be below max along x (got 0.5 and 0.1)",
    ),
    (
        "per_cell: 2",
        "per_cell: 2, spacing: 0.1",
        "20:5: bodies[0].particles: a lattice needs one of spacing and per_cell (got both)",
    ),
    (
        "velocity: [0.1, 0.1]",
        "velocty: [0.1, 0.1]",
        "21:5: bodies[0].velocty: unknown key; did you mean 'velocity'?",
    ),
    (BOX, "", "22:5: bodies[1].shape: is required by particles of type gmsh"),
    (
        BOX,
        "    shape: null\n",
        "24:5: bodies[1].shape: is required by particles of type gmsh",
    ),
    (
        BOX + "    particles: {type: gmsh, size: 0.03}",
        "    particles: {type: mesh, file: /no/such.msh}",
        "24:29: bodies[1].particles.file: there is no file '/no/such.msh'",
    ),
    (
        "{type: gmsh, size: 0.03}",
        "{type: mesh, file: /}",
        "24:5: bodies[1].shape: must not be given with particles of type mesh, which bring their "
        "own",
        "25:29: bodies[1].particles.file: '/' is a folder",
    ),
]

ACROSS_SECTIONS = [
    (
        "cells: [20, 40]",
        "cells: [20, 40, 3]",
        "3:28: domain.cells: must have 2 entries, one for each axis of domain.size (got 3)",
    ),
    (
        "cells: [20, 40]",
        "cells: [20, 30]",
        "3:28: domain.cells: must make square cells, but size / cells is [0.05, 0.0666666666667]; "
        "cells [20, 40] or cells [15, 30] or size [1, 1.5] would fit",
    ),
    (
        "cells: [20, 40]",
        "cells: [1, 2]",
        "3:36: domain.cells[0]: must be at least 2, the nodes per axis that the linear basis "
        "touches (got 1)",
    ),
    (
        "cells: [20, 40]",
        "cells: [100000, 200000]",
        "3:28: domain.cells: makes 2e+10 cells; at most 2.15e+09 are possible",
    ),
    (
        "[1.0, 2.0], cells: [20, 40]",
        "[1.0e-307, 2.0e-307], cells: [20, 40]",
        "3:10: domain.size: is too small for floating-point numbers",
        "19:5: bodies[0].shape: leaves the domain: 0.4 m beyond x = 1e-307 and 0.4 m beyond "
        "y = 2e-307",
        "24:5: bodies[1].shape: leaves the domain: 1 m beyond x = 1e-307 and 2 m beyond y = 2e-307",
    ),
    (
        "top: sticky",
        "front: sticky",
        "3:65: domain.walls.front: a 2D domain has no front: only a 3D one has",
    ),
    (
        "  transfer: {type: flip}\n",
        "",
        "4:1: method.transfer: apic divides by the moment of the weights, and that of the linear "
        "basis has zeros: take transfer tpic, flip, xpic or pic, or basis gimp, quadratic, cubic",
    ),
    (
        "basis: linear\n  transfer: {type: flip}",
        "basis: gimp",
        "4:1: method.transfer: the force in its mls form needs a basis whose moment is constant, "
        "and that of the gimp basis is not: take force: gradient, or basis quadratic or cubic",
    ),
    (
        "basis: linear\n  transfer: {type: flip}",
        "stress_update: musl",
        "5:3: method.stress_update: musl needs the force along grad w: take transfer {type: apic, "
        "force: gradient} or another, or stress_update: usl",
    ),
    (
        "{type: flip}",
        "{type: flip, ratio: 0.9, relaxation_time: 0.1}",
        "6:26: method.transfer.ratio: must not be given with relaxation_time: each says how much "
        "PIC is blended in",
    ),
    (
        "left: slip",
        "left: periodic",
        "3:45: domain.walls.right: must be periodic too, as left is: both are sides of one axis",
    ),
    (
        "gravity: [0, -9.81]",
        'body_force: [sin(X), "R*2"]',
        "8:22: body_force[1]: unknown name 'R'; there are X, Y, pi, t, x, y",
    ),
    (
        "gravity: [0, -9.81]",
        "definitions: {R: x^2, S: R}",
        "8:15: definitions.R: the character '^' has no meaning in a formula: use ** for powers",
    ),
    (
        "velocity: [0.1, 0.1]",
        "velocity: [t, 0.1]",
        "21:16: bodies[0].velocity[0]: must not use t: it is a field of X, Y",
    ),
    (
        "output: {every",
        "exact: {}\noutput: {every",
        "26:1: exact: must have at least one of displacement, velocity, stress",
    ),
    ("step: 1.0e-3", "step: 4", "7:18: time.step: must not exceed time.end, 3.5 (got 4)"),
    ("every: 0.05", "every: 4", "26:10: output.every: must not exceed time.end, 3.5 (got 4)"),
    (
        "[0, -9.81]",
        "[0, 0, -9.81]",
        "8:1: gravity: must have 2 entries, one for each axis of domain.size (got 3)",
    ),
    (
        "velocity: [0.1, 0.1]",
        "velocity: [0.1, 0.1, 0]",
        "21:5: bodies[0].velocity: must have 2 entries, one for each axis of domain.size (got 3)",
    ),
    (
        "center: [0.2, 0.2]",
        "center: [0.2, 0.2, 0]",
        "19:25: bodies[0].shape.center: must have 2 entries, one for each axis of domain.size "
        "(got 3)",
    ),
    (
        "center: [0.2, 0.2]",
        "center: [0.15, 1.9]",
        "19:5: bodies[0].shape: leaves the domain: 0.05 m below x = 0 and 0.1 m beyond y = 2",
    ),
]

YAML = [
    (
        "gravity: [0, -9.81]",
        "gravity: [0, .nan]",
        "8:14: gravity[1]: must be a finite number (got .nan)",
    ),
    ("end: 3.5", "end: .inf", "7:13: time.end: must be a finite number (got .inf)"),
    (
        "end: 3.5",
        "end: 1e999",
        "7:13: time.end: is too large for a floating-point number (got 1e999)",
    ),
    (
        "[20, 40]",
        "[20, 99999999999999999999]",
        "3:40: domain.cells[1]: has more than 18 digits (got 99999999999999999999)",
    ),
    (
        "[20, 40]",
        f"[20, {'9' * 5000}]",
        f"3:40: domain.cells[1]: has more than 18 digits (got {'9' * 40})",
    ),
    (
        "title: Two disks",
        "version: 2",
        "2:1: version: the key 'version' is there twice, first at {path}:1:1",
    ),
    (
        "gravity: [0, -9.81]",
        "gravity: &g [0, -9.81]",
        "8:10: gravity: anchor &g: values cannot be shared",
    ),
    (
        "velocity: [0.1, 0.1]",
        "velocity: *g",
        "21:15: bodies[0].velocity: alias *g: write the value itself",
    ),
    (
        "title: Two disks",
        "<<: {title: Two disks}",
        "2:1: merge key <<: write the entries themselves",
    ),
    (
        "title: Two disks",
        "title: !!python/object/apply:os.system [ls]",
        "2:8: title: tag tag:yaml.org,2002:python/object/apply:os.system: values have no tags",
    ),
    (
        "version: 1",
        "version: !!int 1",
        "1:10: version: tag tag:yaml.org,2002:int: values have no tags",
    ),
    ("title: Two", "3: Two", "2:1: 3: a key must be a word; in quotes, '3' is one"),
    (
        "title: Two disks",
        "[a, b]: 1",
        "2:1: a key must be a word, not a list, a mapping or an alias",
    ),
    (
        "version: 1",
        "%YAML 1.2\n---\nversion: 1",
        "2:1: directives (%YAML, %TAG) have no place here",
    ),
    ("version: 1\n", "version: 1\n---\n", "2:1: a second document: one file holds one scene"),
    ("  soft:", "\tsoft:", "11:1: a tab: YAML wants spaces here"),
    ("  soft:", " soft:", "11:2: not in line with the entries before it"),
    (
        "title: Two",
        "title: a: Two",
        "2:9: a second ':' in one entry: is it indented as the lines around?",
    ),
    ("[20, 40]", "[20, 40", "3:76: a list or mapping that is not closed, or without a comma"),
    ("title: Two disks", "title: 'Two", "27:1: the text ends within quotes"),
    ("Two disks", "Two\x07", "2:11: the character 7 is not text"),
    (
        "title: Two disks",
        'title: "\\ud800"',
        "2:8: title: an escape such as \\ud800 is no character",
    ),
    ("title: Two", f"title: {'[' * 40}", "2:40: nested deeper than 32 levels"),
]


@pytest.mark.parametrize(
    "old, new, expected",
    [
        (old, new, expected)
        for old, new, *expected in SECTIONS + MATERIALS_AND_BODIES + ACROSS_SECTIONS + YAML
    ],
)
def test_fault(tmp_path, old, new, expected):
    """Exactly the expected lines: each fault once, no fault that follows from another."""
    path = tmp_path / "scene.yaml"
    said = faults(path, changed(old, new))
    assert said == [line.replace("{path}", str(path)) for line in expected]


def test_all_faults_at_once_in_file_order(tmp_path):
    """Faults of the YAML, of one key and between keys, in one go and in the order of the file,
    also where one body has faults of several kinds."""
    text = changed("basis: linear", "basis: liner")
    text = text.replace("end: 3.5", "end: .nan").replace("density: 1000", "density: 0")
    text = text.replace("material: rubber", "material: ruber").replace("[0.1, 0.1]", "[0.1, x]")
    text = text.replace("every: 0.05", "evry: 0.05")
    assert faults(tmp_path / "scene.yaml", text) == [
        f"5:3: method.basis: must be one of {BASES} (got 'liner'); did you mean 'linear'?",
        "7:13: time.end: must be a finite number (got .nan)",
        "10:34: materials.rubber.density: must be greater than 0 (got 0)",
        "18:5: bodies[0].material: no material is named 'ruber'; did you mean 'rubber'?",
        "21:21: bodies[0].velocity[1]: must not use x: it is a field of X, Y",
        "26:10: output.evry: unknown key; did you mean 'every'?",
    ]


@pytest.mark.parametrize(
    "override, expected",
    [
        ("time.end=-1", "--set time.end: must be greater than 0 (got -1)"),
        (
            "bodies[0].velocity=[0, 1, 2]",
            "--set bodies[0].velocity: must have 2 entries, one for each axis of domain.size "
            "(got 3)",
        ),
        (
            "bodies[0].shape={type: ball, center: [0.2, 0.2], radius: -1}",
            "--set bodies[0].shape: bodies[0].shape.radius: must be greater than 0 (got -1)",
        ),
        (
            "output.hstory.x=1",
            "--set output.hstory.x: output.hstory: unknown key; did you mean 'history'?",
        ),
        ("time.stp=1", "--set time.stp: unknown key; did you mean 'step'?"),
        ("time.end=.nan", "--set time.end: must be a finite number (got .nan)"),
        (
            "gravity=*g",
            "--set gravity: alias *g: write the value itself",
        ),
        ("bodies[2].name=x", "--set bodies[2].name: bodies has 2 entries, counted from [0]"),
        ("bodies.name=x", "--set bodies.name: bodies is no mapping, so it has no 'name'"),
        (
            "output.images.range[0]=1",
            "--set output.images.range[0]: output.images.range is no list, so it has no [0]",
        ),
        ("time[0]=1", "--set time[0]: time is no list, so it has no [0]"),
        ("title.x=1", "--set title.x: title is no mapping, so it has no 'x'"),
        (
            "time.end=[1",
            "--set time.end:1:3: a list or mapping that is not closed, or without a comma",
        ),
        (
            "time.end",
            "--set time.end: must be KEY=VALUE, with a key such as time.end or bodies[0].velocity",
        ),
        (
            "time..end=1",
            "--set time..end=1: must be KEY=VALUE, with a key such as time.end or "
            "bodies[0].velocity",
        ),
    ],
)
def test_fault_in_an_override(tmp_path, override, expected):
    """The place of a fault in an overridden value is `--set KEY`."""
    assert faults(tmp_path / "scene.yaml", TEXT, override) == [expected]


def test_faults_of_the_file_come_before_those_of_overrides(tmp_path):
    """In the order in which they were said."""
    text = changed("every: 0.05", "every: 0")
    assert faults(tmp_path / "scene.yaml", text, "time.end=0", "x", "gravity=1") == [
        "26:10: output.every: must be greater than 0 (got 0)",
        "--set time.end: must be greater than 0 (got 0)",
        "--set gravity: must be a list of 2 or 3 numbers (got 1)",
        "--set x: must be KEY=VALUE, with a key such as time.end or bodies[0].velocity",
    ]


def test_byte_order_mark_shifts_no_column(tmp_path):
    """The mark is no character of the first line."""
    said = faults(tmp_path / "scene.yaml", "\ufeff{version: &a 1}")
    assert "1:11: version: anchor &a: values cannot be shared" in said


@pytest.mark.parametrize(
    "content, expected",
    [
        (b"", "1:1: is empty: a scene is a mapping that begins with version: 1"),
        (b"# only words\n", "1:1: is empty: a scene is a mapping that begins with version: 1"),
        (b"- 1\n", "1:1: is [1], no mapping: a scene is a mapping that begins with version: 1"),
        (b"hello", "1:1: is 'hello', no mapping: a scene is a mapping that begins with version: 1"),
        (b"version: 1\ntitle: \xe9t\xe9\n", "2: is not UTF-8 text; save it with that encoding"),
        (TEXT.encode("utf-16"), "1: is not UTF-8 text; save it with that encoding"),
        (b"#" * 1_000_001, " is larger than 1000000 bytes, so it is no scene file"),
    ],
)
def test_files_that_hold_no_scene(tmp_path, content, expected):
    """Each is named for what it is."""
    assert faults(tmp_path / "scene.yaml", content) == [expected]


def test_files_that_cannot_be_read(tmp_path):
    """A folder, and a name that nothing has: with the name that was probably meant."""
    with pytest.raises(InputError, match="is a folder, not a scene file"):
        load_scene(tmp_path)
    (tmp_path / "disks.yaml").write_text(TEXT)
    with pytest.raises(InputError, match=r"there is no such file; did you mean '.*/disks.yaml'"):
        load_scene(tmp_path / "disk.yaml")
    with pytest.raises(InputError, match="cannot be read: Not a directory"):
        load_scene(tmp_path / "disks.yaml" / "x.yaml")
    with pytest.raises(InputError, match="cannot be read: File name too long"):
        load_scene(tmp_path / ("x" * 1000))


def test_messages_are_lines_that_any_terminal_shows(tmp_path):
    """Control characters and unassigned code points of the file are escaped."""
    text = changed("material: rubber", 'material: "a\\e[31m\\n\\U0010FFFF"')
    assert faults(tmp_path / "scene.yaml", text) == [
        "18:5: bodies[0].material: no material is named 'a\\x1b[31m\\n\\U0010ffff'; "
        "the materials are rubber, soft"
    ]
