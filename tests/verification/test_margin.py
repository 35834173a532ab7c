"""The measured limit of stability against closed forms."""

import pytest

from mpm_taichi import Simulation, bases, cli, load_scene, margin, transfers
from mpm_taichi.errors import InputError

from .test_lone_particle import limit_at

TEXT = """\
version: 1
domain: {{size: [0.8, 0.8], cells: [8, 8]}}
method: {{basis: quadratic, transfer: {{type: apic, force: {force}}}}}
time: {{end: 1}}
materials:
  jelly: {{type: {law}, density: 1000, youngs_modulus: 2.0e4, poissons_ratio: 0.3{more}}}
bodies:
  - name: speck
    material: jelly
    shape: {{type: box, min: [0.3, 0.3], max: [0.5, 0.5]}}
    particles: {{type: lattice, spacing: {spacing}}}
"""


@pytest.fixture
def scene(tmp_path):
    def scene(spacing=0.15, force="mls", law="neo_hookean", more=""):
        path = tmp_path / "scene.yaml"
        path.write_text(TEXT.format(spacing=spacing, force=force, law=law, more=more))
        return load_scene(path)

    return scene


@pytest.mark.slow
@pytest.mark.parametrize(("force", "transfer"), [("mls", "MLS"), ("gradient", "APIC")])
def test_lone_particle(rng, scene, force, transfer):
    """One particle at (k + 1/2) h, anywhere in a cell: dt = l dx sqrt(rho / (2 lam + 2 mu)) with l
    of its place (numerics.md 4.1), within 5 %: 2 % of the bisection, and what a growth of 3 % per
    step asks for."""
    spacing = rng.uniform(0.22, 0.32)
    alone = scene(spacing, force)
    simulation = Simulation(alone, precision="f64", threads=1)
    (x,) = simulation.snapshot.position
    found = margin.measured_limit(simulation, 0.01, seed=int(rng.integers(2**31)))
    unit = 0.1 * (1000 / (2 * 11538.46 + 2 * 7692.31)) ** 0.5
    limit = limit_at(x[0] / 0.1, bases.QuadraticBSpline, getattr(transfers, transfer))
    assert found == pytest.approx(limit * unit, rel=0.05)


def test_what_no_linear_step_stands_for_is_refused(scene):
    """Plastic materials, by name and law; and scenes of very many particles."""
    with pytest.raises(InputError, match=r"--margin: material jelly \(von_mises\) flows"):
        margin.refuse(scene(law="von_mises", more=", yield_stress: 100"), 4)
    with pytest.raises(InputError, match="at most 20000 particles"):
        margin.refuse(scene(), 20_001)
    margin.refuse(scene(), 20_000)


def test_options_that_the_margin_does_not_know_are_refused(tmp_path, capsys):
    """It is measured in f64 on one thread of the CPU, whatever a run would take."""
    for words in (["--precision", "f32"], ["--threads", "2"], ["--device", "vulkan"]):
        assert cli.main(["check", str(tmp_path / "x.yaml"), "--margin", *words]) == 2
        assert "leave out --device, --precision, --threads" in capsys.readouterr().err
