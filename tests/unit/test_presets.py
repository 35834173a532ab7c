"""Presets: materials by name, what a scene may change of them, and what it is told if it errs."""

import pytest

from mpm_taichi.errors import InputError
from mpm_taichi.materials import MATERIALS, DruckerPrager, Snow, VonMises
from mpm_taichi.materials.presets import PRESETS
from mpm_taichi.scene import Scene, dump_scene, load_scene, scene_schema
from mpm_taichi.scene.document import parse

from .scene_text import changed

RUBBER = "{type: linear_elastic, density: 1000, youngs_modulus: 1E6, poissons_ratio: 0.3}"
NAMES = (
    "steel, mild_steel, aluminium_6061_t6, copper, copper_ofhc, rubber, jelly, snow, dry_sand, "
    "aluminium_bars, water, water_reduced_stiffness, air"
)
LAWS = (
    "drucker_prager or fixed_corotated or fluid or gas or hencky or hypoelastic or linear_elastic "
    "or neo_hookean or snow or von_mises"
)


def text_with(material: str) -> str:
    """A scene whose material `rubber` on line 10, from column 11 on, is this."""
    return changed(RUBBER, material)


@pytest.fixture
def load(tmp_path):
    """Writes a text to a file and loads it."""

    def load(text: str, *overrides: str) -> Scene:
        path = tmp_path / "scene.yaml"
        path.write_text(text)
        return load_scene(path, overrides)

    return load


@pytest.mark.parametrize("name", PRESETS)
def test_a_preset_is_a_material(load, name):
    """A scene that names a preset has its material, as if all values were written; how they are
    written out does not name it.  Each is cited, and moves waves of 1 m/s to 10 km/s: a prefix that
    is off by 1000 would not."""
    material, source, remark = PRESETS[name]
    scene = load(text_with(f"{{preset: {name}}}"))
    assert scene.materials["rubber"] == material
    assert "preset" not in dump_scene(scene)
    assert load(dump_scene(scene)) == scene
    assert isinstance(material, MATERIALS) and 1 < material.wave_speed() < 10_000
    assert len(source) > 10 and len(remark) > 10


def test_published_constants():
    """Those that a benchmark rests on, as published: Taylor bar, snow, and the column of Bui."""
    copper, snow, bars = (PRESETS[n].material for n in ("copper", "snow", "aluminium_bars"))
    assert isinstance(copper, VonMises)
    assert isinstance(snow, Snow)
    assert isinstance(bars, DruckerPrager)
    assert (copper.yield_stress, copper.hardening, copper.density) == (400e6, 100e6, 8930)
    assert (snow.critical_compression, snow.critical_stretch) == (2.5e-2, 7.5e-3)
    K = bars.youngs_modulus / (3 * (1 - 2 * bars.poissons_ratio))
    assert pytest.approx(0.7e6) == K  # as Bui et al. give it


def test_each_value_can_be_changed(load):
    """A key beside `preset` replaces the value of the preset; `type` may say what holds anyway."""
    text = text_with("{preset: aluminium_6061_t6, yield_stress: 3.5e8, type: von_mises}")
    preset = PRESETS["aluminium_6061_t6"].material
    assert load(text).materials["rubber"] == preset.model_copy(update={"yield_stress": 3.5e8})
    for name, (material, _, _) in PRESETS.items():
        for key, value in material:
            if isinstance(value, float):
                other = material.model_copy(update={key: 0.875 * value})
                scene = load(text_with(f"{{preset: {name}, {key}: {0.875 * value!r}}}"))
                if other != material:
                    assert scene.materials["rubber"] == other, key


@pytest.mark.parametrize(
    "overrides",
    [
        ["materials.rubber={preset: snow, density: 300}"],
        ["materials.rubber={preset: snow}", "materials.rubber.density=300"],
    ],
)
def test_command_line(load, overrides):
    """--set reaches a preset, and the values over it."""
    snow = PRESETS["snow"].material
    scene = load(text_with("{preset: rubber}"), *overrides)
    assert scene.materials["rubber"] == snow.model_copy(update={"density": 300.0})


def test_in_python():
    """A Scene made in Python reads presets too, leaves what it was given as it was, and takes a
    material as it is."""
    data = parse(text_with("{preset: snow, density: 300}"), "text").value
    scene = Scene.model_validate(data)
    assert scene.materials["rubber"] == PRESETS["snow"].material.model_copy(
        update={"density": 300.0}
    )
    assert data["materials"]["rubber"] == {"preset": "snow", "density": 300}
    data["materials"]["rubber"] = PRESETS["snow"].material
    assert Scene.model_validate(data).materials["rubber"] == PRESETS["snow"].material
    data["materials"]["rubber"] = {"preset": "snw"}
    with pytest.raises(ValueError, match=r"materials\.rubber\.preset(?s:.*)did you mean 'snow'?"):
        Scene.model_validate(data)


WRONG = [
    (
        "{preset: aluminium_6061_t, density: 1}",
        f"10:12: materials.rubber.preset: must be one of {NAMES} (got 'aluminium_6061_t'); did you "
        "mean 'aluminium_6061_t6'?",
    ),
    ("{preset: 3}", f"10:12: materials.rubber.preset: must be one of {NAMES} (got 3)"),
    ("{preset: }", f"10:12: materials.rubber.preset: must be one of {NAMES} (got nothing)"),
    ("{preset: [snow]}", f"10:12: materials.rubber.preset: must be one of {NAMES} (got ['snow']); "
     "did you mean 'snow'?"),
    (
        "{preset: snow, type: fluid, hardness: 3}",
        "10:26: materials.rubber.type: must be snow, the law of preset snow (got 'fluid')",
    ),
    (
        "{type: , preset: snow}",
        "10:12: materials.rubber.type: must be snow, the law of preset snow (got nothing)",
    ),
    (
        "{preset: aluminium_6061_t6, yield_stress: -3}",
        "10:39: materials.rubber.yield_stress: must be greater than 0 (got -3)",
    ),
    (
        "{preset: aluminium_6061_t6, yield_stres: 3e8, poissons_ratio: 0.5}",
        "10:39: materials.rubber.yield_stres: unknown key; did you mean 'yield_stress'?",
        "10:57: materials.rubber.poissons_ratio: must be greater than -1 and less than 0.5 "
        "(got 0.5)",
    ),
    (
        "{preset: aluminium_bars, cone: plane}",
        "10:36: materials.rubber.cone: must be one of compression, plane_strain (got 'plane')",
    ),
    ("{preset: air, density: }", "10:25: materials.rubber.density: must be a number greater than 0 "
     "(got nothing)"),
    (
        "{preset: dry_sand, volume_correction: 1}",
        "10:30: materials.rubber.volume_correction: must be true or false (got 1)",
    ),
    (
        "{presett: snow}",
        f"10:3: materials.rubber.type: is required where there is no preset: {LAWS}",
    ),
    (
        "snow",
        f"10:3: materials.rubber: must be a mapping with type {LAWS} (got 'snow')",
    ),
]  # fmt: skip


@pytest.mark.parametrize("material, expected", [(wrong, said) for wrong, *said in WRONG])
def test_what_is_wrong_is_told_at_its_place(load, tmp_path, material, expected):
    """Each fault once, in the words of every other key, at its own line and column."""
    with pytest.raises(InputError) as caught:
        load(text_with(material))
    lines = str(caught.value).splitlines()
    assert [line.removeprefix(f"{tmp_path / 'scene.yaml'}:") for line in lines] == expected


@pytest.mark.parametrize(
    "override, expected",
    [
        (
            "materials.rubber.yield_stress=-3",
            "--set materials.rubber.yield_stress: must be greater than 0 (got -3)",
        ),
        (
            "materials.rubber={preset: snow, youngs_modulus: 0}",
            "--set materials.rubber: materials.rubber.youngs_modulus: must be greater than 0 "
            "(got 0)",
        ),
    ],
)
def test_what_is_wrong_on_the_command_line(load, override, expected):
    """The place is the option that said it."""
    with pytest.raises(InputError) as caught:
        load(text_with("{preset: aluminium_6061_t6}"), override)
    assert str(caught.value) == expected


@pytest.mark.parametrize(
    "material",
    [wrong for wrong, *_ in WRONG]
    + [f"{{preset: {name}}}" for name in PRESETS]
    + ["{preset: snow, type: snow, hardening: 5}", "{type: snow, density: 400}", RUBBER],
)
def test_the_schema_agrees(load, material):
    """An editor with the JSON Schema accepts what the reader accepts, and nothing else."""
    jsonschema = pytest.importorskip("jsonschema")
    text = text_with(material)
    faults = list(
        jsonschema.Draft202012Validator(scene_schema()).iter_errors(parse(text, "text").value)
    )
    try:
        load(text)
    except InputError:
        assert faults
    else:
        assert not faults
