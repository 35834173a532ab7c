"""`python -m mpm_taichi materials`: all laws and presets, as the models have them."""

import pytest

from mpm_taichi import cli
from mpm_taichi.catalogue import LAWS, catalogue, entry
from mpm_taichi.materials import MATERIALS
from mpm_taichi.materials.presets import PRESETS


def paragraphs(text: str) -> dict[str, str]:
    """The paragraphs of the list by what comes before their first colon, each in one line."""
    found = (" ".join(part.split()) for part in text.split("\n\n"))
    return {part.split(":")[0]: part for part in found}


def test_list(capfd):
    """Exit code 0; plain text of at most 100 columns on stdout.  Each law with what it is, its
    parameters, units and defaults; each preset with its law, values, source and remark."""
    assert cli.main(["materials"]) == 0
    out, err = capfd.readouterr()
    assert err == ""
    assert out == catalogue() + "\n"
    assert out.isascii() and max(map(len, out.splitlines())) <= 100
    laws, presets = map(paragraphs, out.split("presets (preset)"))
    assert laws.keys() >= LAWS.keys()
    assert presets.keys() >= PRESETS.keys()
    assert len(LAWS) == len(MATERIALS)
    assert laws["von_mises"].startswith("von_mises: Metal: von Mises plasticity")
    assert laws["von_mises"].endswith(
        "density [kg/m^3], youngs_modulus [Pa], poissons_ratio, yield_stress [Pa], "
        "hardening [Pa] = 0"
    )
    for name, law in LAWS.items():
        assert all(f" {key}" in laws[name] for key in law.model_fields if key != "type")
    for name, preset in PRESETS.items():
        said = presets[name]
        assert said.startswith(f"{name}: preset of the law {preset.material.type} density ")
        assert said.endswith(f"source: {preset.source} remark: {preset.remark}")
    assert "youngs_modulus 7.82e+10 Pa, poissons_ratio 0.3," in presets["aluminium_6061_t6"]


@pytest.mark.parametrize("name", [*LAWS, *PRESETS])
def test_one_in_full(name):
    """A law: source, equations, and each parameter with its meaning, unit, bounds and default; a
    preset: how a scene says it; `snow`, which is both: both."""
    text = entry(name)
    assert text.isascii() and max(map(len, text.splitlines())) <= 100
    if name in LAWS:
        words = " ".join(text.split())
        for key, field in LAWS[name].model_fields.items():
            assert key == "type" or f"{key}: {field.description}; " in words
        assert "[kg/m^3]; a number greater than 0; required" in words
        assert " ".join((LAWS[name].__doc__ or "").split()) in words
    if name in PRESETS:
        assert PRESETS[name].source in " ".join(text.split())
        assert f"{{preset: {name}}}" in text


def test_presets_of_a_law():
    """A law names its presets."""
    assert entry("hencky").endswith("presets: none")
    assert entry("drucker_prager").endswith("presets: dry_sand, aluminium_bars")


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("von_mise", "no law or preset is named 'von_mise'; did you mean 'von_mises'?"),
        ("dry_snad", "no law or preset is named 'dry_snad'; did you mean 'dry_sand'?"),
        ("x", "no law or preset is named 'x'; there are linear_elastic, hypoelastic, "),
    ],
)
def test_a_wrong_name(capfd, name, said):
    """Exit code 2, and what would be right."""
    assert cli.main(["materials", name]) == 2
    out, err = capfd.readouterr()
    assert out == ""
    assert err.startswith(said)
