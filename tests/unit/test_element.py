"""Single elements: a law along given deformations, and the command `curve` that draws it."""

import csv
import sys

import numpy as np
import pytest
from PIL import Image

from mpm_taichi import cli, runtime
from mpm_taichi.catalogue import LAWS
from mpm_taichi.curve import material_of
from mpm_taichi.element import PATHS, Elements, cycle, deformation
from mpm_taichi.errors import InputError
from mpm_taichi.materials import VonMises
from mpm_taichi.materials.presets import PRESETS
from tests.command_line import SCENES
from tests.laws import BY_NAME

from .scene_text import TEXT


@pytest.fixture
def started():
    runtime.start("cpu", "f64")


def test_cycle():
    """Out and back to one side, then to the other, in steps of one size; the ends are exact."""
    s = cycle(-0.3, steps=10)
    assert s[[0, 10, 20, 30, 40]].tolist() == [0, -0.3, 0, 0.3, 0]
    assert np.abs(np.diff(s)) == pytest.approx(np.full(40, 0.03), rel=1e-12)


@pytest.mark.parametrize("dim", [2, 3])
def test_paths(dim, rng):
    """Shear keeps the volume, `volumetric` has J = 1 + s and no shear, uniaxial strain J = 1 + s
    and biaxial J = (1 + s)^2: to rounding."""
    s = rng.uniform(-0.9, 2, 50)
    J = {path: np.linalg.det(deformation(path, s, dim)) for path in PATHS}
    assert J["shear"] == pytest.approx(np.ones(50), rel=1e-12)
    assert J["uniaxial"] == pytest.approx(1 + s, rel=1e-12)
    assert J["volumetric"] == pytest.approx(1 + s, rel=1e-12)
    assert J["biaxial"] == pytest.approx((1 + s) ** 2, rel=1e-12)
    F = deformation("volumetric", s, dim)
    assert np.abs(F - F[:, :1, :1] * np.eye(dim)).max() == 0


@pytest.mark.usefixtures("started")
def test_neo_hookean_in_closed_form():
    """With stretch a: sigma_xx = (mu (a^2 - 1) + lam ln a) / a and sigma_yy = sigma_zz =
    lam ln a / a; in shear s, sigma_xy = mu s and sigma_xx = mu s^2.  After a compression, which
    such a material does not remember, sigma = (mu (b - I) + lam ln J I) / J of the whole F.  F is
    built up in 400 steps, whose rounding errors add up: 1e-12 of the modulus."""
    material = BY_NAME["neo_hookean"]
    c = material.constants(1.0)
    mu, lam, tiny = c["mu"], c["lam"], 1e-12 * material.youngs_modulus
    s = cycle(0.4)
    F = np.stack([deformation(path, s, 3) for path in ("uniaxial", "shear")], axis=1)
    elements = Elements(material, dim=3, count=2)
    found = elements.lead(F)
    a, sigma = 1 + s, found.cauchy_stress
    assert sigma[:, 0, 0, 0] == pytest.approx((mu * (a**2 - 1) + lam * np.log(a)) / a, abs=tiny)
    for axis in (1, 2):
        assert sigma[:, 0, axis, axis] == pytest.approx(lam * np.log(a) / a, abs=tiny)
    assert sigma[:, 1, 0, 1] == pytest.approx(mu * s, abs=tiny)
    assert sigma[:, 1, 0, 0] == pytest.approx(mu * s**2, abs=tiny)
    assert found.volume_ratio[:, 0] == pytest.approx(a, rel=1e-12)
    assert not found.dissipated_energy.any()
    assert elements.first_flow() is None
    sigma = elements.lead(F, compression=0.2).cauchy_stress
    G = 0.8 ** (1 / 3) * F
    J = np.linalg.det(G)[..., None, None]
    expected = (mu * (G @ G.swapaxes(2, 3) - np.eye(3)) + lam * np.log(J) * np.eye(3)) / J
    assert sigma == pytest.approx(expected, abs=tiny)


@pytest.mark.usefixtures("started")
def test_loop_of_von_mises_in_closed_form(rng):
    """Perfectly plastic, plane strain, uniaxial: with e = ln(1 + s) the difference q = tau_xx -
    tau_yy grows by 2 mu de and stays within [-Y, Y]; tau_xx = K e + 2/3 q, tau_yy = tau_zz = K e -
    q/3, and Y / (2 mu) of each strain beyond, 2/3 is equivalent plastic strain, at the loss of Y.
    The return is exact for steps of any size: 1e-11, for rounding errors of 400 steps.  A second
    time it is the same: the history starts afresh."""
    E, nu, Y = 1e5, rng.uniform(0.1, 0.4), rng.uniform(500, 2000)
    material = VonMises(
        type="von_mises", density=1000.0, youngs_modulus=E, poissons_ratio=nu, yield_stress=Y
    )
    mu, K = E / (2 * (1 + nu)), E / (3 * (1 - 2 * nu))
    s = cycle(0.1)
    e = np.log(1 + s)
    q, plastic = np.zeros_like(s), np.zeros_like(s)
    for n in range(1, len(s)):
        trial = q[n - 1] + 2 * mu * (e[n] - e[n - 1])
        q[n] = np.clip(trial, -Y, Y)
        plastic[n] = plastic[n - 1] + abs(trial - q[n]) / (3 * mu)
    assert (q == Y).any() and (q == -Y).any()
    elements = Elements(material, dim=2, count=1)
    for _ in range(2):
        found = elements.lead(deformation("uniaxial", s, 2)[:, None])
        tau = found.cauchy_stress[:, 0] * (1 + s)[:, None, None]
        assert tau[:, 0, 0] == pytest.approx(K * e + 2 / 3 * q, abs=1e-11 * E)
        assert tau[:, 1, 1] == pytest.approx(K * e - q / 3, abs=1e-11 * E)
        assert tau[:, 2, 2] == pytest.approx(K * e - q / 3, abs=1e-11 * E)
        assert found.plastic_strain[:, 0] == pytest.approx(plastic, abs=1e-11)
        assert found.dissipated_energy[:, 0] == pytest.approx(Y * plastic, abs=1e-11 * E)
    first = elements.first_flow()
    assert first is not None
    assert 1 <= first * np.sqrt(3) * mu / Y < 1.15  # q = sqrt(3) mu s, and the steps are 10 %


def test_command(tmp_path, monkeypatch, capfd):
    """`curve neo_hookean --set ... --path shear`: exit code 0; stdout says whose constants these
    are and where the files are; the table has sigma_xy = mu s on the way out and back; the picture
    is one.  Files that are there are kept unless --overwrite."""
    monkeypatch.chdir(tmp_path)
    words = ["curve", "neo_hookean", "--set", "youngs_modulus=2.9e5", "--path", "shear"]
    words += ["--strain", "0.3", "--dim", "2"]
    assert cli.main([*words, "-o", "out/shear.png"]) == 0
    out, err = capfd.readouterr()
    assert err == ""
    lines = out.splitlines()
    assert lines[0].startswith("neo_hookean, constants of preset rubber: density 930 kg/m^3, ")
    assert "youngs_modulus 290000 Pa" in out
    assert "shear: strain 0.3 at 1 /s, 2D" in lines
    assert lines[-2:] == ["picture: out/shear.png", "table:   out/shear.csv"]
    with (tmp_path / "out" / "shear.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert {row["path"] for row in rows} == {"shear"}
    s = np.array([float(row["strain"]) for row in rows])
    assert (s.min(), s.max()) == (-0.3, 0.3)
    assert [float(row["stress_xy"]) for row in rows] == pytest.approx(1e5 * s, abs=1e-6)
    picture = tmp_path / "out" / "shear.png"
    assert len(np.unique(np.asarray(Image.open(picture).convert("L")))) > 10  # shades of gray

    before = picture.read_bytes()
    assert cli.main([*words, "-o", "out/shear.png", "--strain", "0.1"]) == 2
    assert "out/shear.png: it is there already" in capfd.readouterr().err
    assert picture.read_bytes() == before
    assert cli.main([*words, "-o", "out/shear.png", "--strain", "0.1", "--overwrite"]) == 0
    assert picture.read_bytes() != before
    (tmp_path / "runs").mkdir()
    (tmp_path / "runs" / "curve-neo_hookean-001.csv").touch()
    assert cli.main(words) == 0
    assert (tmp_path / "runs" / "curve-neo_hookean-002.png").exists()


@pytest.mark.parametrize("law", LAWS)
def test_a_law_alone_has_constants(law):
    """Those of a preset, of which it says which; any of them can be changed."""
    material, origin = material_of(law, ["density=123"])
    assert (material.type, material.density) == (law, 123)
    assert origin.split()[-1] in PRESETS


def test_material_of_a_preset_or_a_scene():
    """By name, or as SCENE.yaml:MATERIAL, where the name may be left out if there is but one."""
    assert material_of("dry_sand", [])[0] == PRESETS["dry_sand"].material
    scene = str(SCENES / "two_disks.yaml")
    rubber, origin = material_of(f"{scene}:rubber", [])
    assert (rubber.type, origin) == ("linear_elastic", f"of {scene}:rubber")
    assert material_of(scene, []) == (rubber, f"of {scene}")
    assert material_of(scene, ["density=7"])[0].density == 7


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["von_mise"], "no law or preset is named 'von_mise'; did you mean 'von_mises'?"),
        (["x"], "no law or preset is named 'x'; there are linear_elastic, "),
        (
            ["snow", "--set", "youngs_modulus=-3"],
            "--set youngs_modulus: must be greater than 0 (got -3)",
        ),
        (["snow", "--set", "hardnes=3"], "--set hardnes: unknown key; did you mean 'hardening'?"),
        (
            ["water", "--set", "type=gas"],
            "--set type: must be fluid, the law of preset water (got 'gas')",
        ),
        (["snow", "--set", "density"], "--set density: must be KEY=VALUE"),
        (
            [f"{SCENES / 'two_disks.yaml'}:ruber"],
            f"no material is named 'ruber': say {SCENES / 'two_disks.yaml'}:rubber",
        ),
        (["no.yaml:rubber"], "no.yaml: there is no such file"),
        (["snow", "-o", "a.jpg"], "-o a.jpg: the picture is a .png file"),
        (["snow", "--strain", "1.5"], "must be between 0 and 1, or -1 and 0 (got '1.5')"),
        (["snow", "--rate", "0"], "must be a number above 0 (got '0')"),
        (["snow", "--compression", "1"], "must be at least 0 and less than 1 (got '1')"),
        (["snow", "--path", "torsion"], "invalid choice: 'torsion'"),
        ([], "the following arguments are required: WHAT"),
    ],
)
def test_bad_input_is_refused_in_words(tmp_path, monkeypatch, capfd, words, said):
    """Exit code 2, a sentence on stderr, nothing on stdout, and no file."""
    monkeypatch.chdir(tmp_path)
    try:
        code = cli.main(["curve", *words])
    except SystemExit as end:  # argparse's way
        code = end.code
    out, err = capfd.readouterr()
    assert (code, out) == (2, "")
    assert said in err and "Traceback" not in err
    assert list(tmp_path.iterdir()) == []


def test_values_for_the_path_before_the_command(tmp_path, monkeypatch, capfd):
    """Options may come before the command and its word, also those that take a value."""
    monkeypatch.chdir(tmp_path)
    assert cli.main(["--strain", "0.1", "--path", "shear", "curve", "sno"]) == 2
    assert "did you mean 'snow'?" in capfd.readouterr().err


def test_a_scene_of_several_materials(tmp_path):
    """Which one has to be said."""
    path = tmp_path / "scene.yaml"
    path.write_text(TEXT)
    with pytest.raises(InputError) as caught:
        material_of(str(path), [])
    assert str(caught.value) == f"{path}: there are 2 materials: say {path}:rubber or {path}:soft"
    assert material_of(f"{path}:soft", [])[0].type == "neo_hookean"


def test_without_matplotlib(monkeypatch, capfd):
    """What installs it, before anything is computed."""
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    assert cli.main(["curve", "snow"]) == 2
    assert 'pip install "matplotlib>=3.8"' in capfd.readouterr().err
