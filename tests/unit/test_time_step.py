"""The limits of a step against their formulas, worked out here by hand (numerics.md, 4 and 5)."""

import json
from math import log, sqrt

import pytest

from mpm_taichi import load_scene
from mpm_taichi.errors import InputError
from mpm_taichi.time_step import BOUNDS, GROWTH, Limit, Motion, Stiffness, TimeStep

# E = 2e4, nu = 0.3, rho = 1000: lam = 6000 / (1.3 * 0.4) = 11538.46, mu = 2e4 / 2.6 = 7692.31 Pa
LAM, MU, RHO = 2e4 * 0.3 / (1.3 * 0.4), 2e4 / 2.6, 1000
WAVE = sqrt((LAM + 2 * MU) / RHO)  # 5.1887 m/s
DX = 0.05

TEXT = """\
version: 1
domain: {{size: {size}, cells: {cells}}}
method: {method}
time: {{end: 1, {time}}}
gravity: {gravity}
materials:
  jelly: {{type: neo_hookean, density: 1000, youngs_modulus: 2.0e4, poissons_ratio: 0.3}}
bodies:
  - name: ball
    material: jelly
    shape: {{type: ball, center: {center}, radius: 0.2}}
    particles: {{type: lattice, per_cell: 2}}
"""


@pytest.fixture
def scene(tmp_path):
    """A scene of a dimension, method, time step and gravity."""

    def scene(dim=2, method="{}", time="step: auto", gravity=None):
        path = tmp_path / "scene.yaml"
        path.write_text(
            TEXT.format(
                size=[1.0] * dim, cells=[20] * dim, center=[0.5] * dim, method=method, time=time,
                gravity=gravity or [0.0] * dim,
            )
        )  # fmt: skip
        return load_scene(path)

    return scene


def seconds(limits: list[Limit]) -> dict[str, float]:
    return {limit.name: limit.seconds for limit in limits}


def step_of(scene, motion=None) -> TimeStep:
    given = None if scene.time.step == "auto" else scene.time.step
    return TimeStep(scene, given, scene.time.safety, motion=motion, enforce=scene.time.enforce)


def chosen(step, speed=0.0, rate=0.0) -> float:
    """The next length after a step of such motion."""
    step.move(0.0, Motion(speed, rate))
    return step.choose()


def seen(step, factor, particle=7) -> None:
    """All materials are `factor` times as stiff as undeformed, where a particle is."""
    step.see({
        material: Stiffness(factor * now.wave, particle, factor * now.lone, particle)
        for material, now in step.stiffness.items()
    })  # fmt: skip


METHODS = [
    # bulk limit of chapter 4.3 (2D, 2 x 2 per cell, the worst transfer), and isolated limit of 4.1:
    # MLS 2 / sqrt(4), APIC sqrt(2 / (6 - 2)), PIC and FLIP sqrt(2 / 6); none for hat functions
    ("{}", 1.03, 1.0),
    ("{basis: quadratic, transfer: {type: apic, force: gradient}}", 1.03, 0.7071067811865476),
    ("{basis: quadratic, transfer: {type: flip}}", 1.03, 0.5773502691896257),
    ("{basis: quadratic, transfer: {type: pic}}", 1.03, 0.5773502691896257),
    ("{basis: linear, transfer: {type: flip}}", 0.76, None),
]


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize(("method", "bulk", "isolated"), METHODS)
def test_limits(scene, dim, method, bulk, isolated):
    """acoustic 0.9 b dx / (c + |v|), isolated l dx sqrt(rho / (d lam + 2 mu)), travel 0.5 dx / |v|,
    deformation 0.2 / |grad v|, gravity sqrt(0.5 dx / |g|); exact but for rounding, shortest
    first."""
    v, rate, g = 0.7, 3.0, [0.0, -9.81, 0.0][:dim]
    found = step_of(scene(dim, method, gravity=g)).limits(Motion(v, rate))
    expected = {
        "acoustic": 0.9 * bulk * DX / (WAVE + v),
        "travel": 0.5 * DX / v,
        "deformation": 0.2 / rate,
        "gravity": sqrt(0.5 * DX / 9.81),
    }
    if isolated is not None:
        expected["isolated particle"] = isolated * DX * sqrt(RHO / (dim * LAM + 2 * MU))
    assert seconds(found) == pytest.approx(expected, rel=1e-14)
    assert [limit.name for limit in found] == sorted(expected, key=expected.__getitem__)


def test_numbers_worked_out_by_hand(scene):
    """The default method in 2D at rest: acoustic 0.9 * 1.03 * 0.05 / 5.1887 = 8.933e-3 s, isolated
    0.05 sqrt(1000 / 38461.5) = 8.062e-3 s.  No speed, no gravity: no limit of travel or fall."""
    found = step_of(scene()).limits(Motion())
    assert seconds(found) == pytest.approx(
        {"isolated particle": 8.0623e-3, "acoustic": 8.9328e-3}, rel=1e-4
    )
    assert found[0] == Limit("isolated particle", found[0].seconds, "material jelly")


def test_fast_bodies_are_limited_by_travel(scene):
    """At 100 m/s, 19 times the speed of sound, no particle may cross half a cell."""
    found = step_of(scene()).limits(Motion(100.0))
    assert (found[0].name, found[0].seconds) == ("travel", 0.5 * DX / 100.0)


def test_auto_is_safety_times_the_shortest_limit(scene):
    """0.5 by default; 0.25 of it where the scene says so."""
    shortest = DX * sqrt(RHO / (2 * LAM + 2 * MU))
    assert step_of(scene()).choose() == pytest.approx(0.5 * shortest, rel=1e-14)
    quarter = scene(time="step: auto, safety: 0.25")
    assert step_of(quarter).choose() == pytest.approx(0.25 * shortest, rel=1e-14)


def test_an_automatic_step_shrinks_at_once_and_grows_slowly(scene):
    """From a collision on it follows the speed down within one step, and up by 2 % a step."""
    step = step_of(scene())
    long = step.choose()
    short = chosen(step, 1000.0)
    assert short == pytest.approx(0.5 * 0.5 * DX / 1000.0, rel=1e-14)
    assert GROWTH == 1.02
    assert [chosen(step) for _ in range(3)] == pytest.approx(
        [short * 1.02**k for k in (1, 2, 3)], rel=1e-13
    )
    assert [chosen(step) for _ in range(500)][-1] == long


def test_stiffer_material_takes_shorter_steps(scene):
    """Four times as stiff: half the step, and the limit names the particle; a look is due before
    it can have tripled, as the square of a stretch does at a strain of ln 3 / 2."""
    step = step_of(scene())
    long = step.choose()
    for _ in range(3):
        assert not step.is_look_due
        step.move(0.1, Motion(0.0, log(3) / 2 / 0.29))
    assert step.is_look_due
    seen(step, 4.0)
    assert not step.is_look_due
    assert step.choose() == pytest.approx(0.5 * long, rel=1e-14)
    limit = step.limits(Motion())[0]
    assert (limit.name, limit.particle) == ("isolated particle", 7)


def test_a_given_step_is_shortened_where_a_limit_falls_below_it(scene):
    """To the limit itself, counted; above a limit at the start it is refused, in words that name
    the limit and the ways out; not where the scene asks to have it as it is."""
    step = step_of(scene(time="step: 0.008"))
    assert step.begin() == chosen(step, 0.1) == 0.008
    step.note([0.008], [step.code])
    assert chosen(step, 10.0) == pytest.approx(0.5 * DX / 10, rel=1e-14)
    step.note([0.008], [step.code])
    step.note([0.0025], [step.code])
    assert (step.shortened, step.counts) == (1, {"given": 2, "travel": 1})
    step.refuse(step.limits(Motion())[0])  # the isolated particle's, 0.00806 s

    long = step_of(scene(time="step: 0.02"))
    with pytest.raises(InputError) as refusal:
        long.refuse(long.limits(Motion())[0])
    assert str(refusal.value) == (
        "time.step: 0.02 s is longer than the isolated particle limit of 0.008062 s (material "
        "jelly): the run could blow up. Take `step: auto`, a step of at most 0.008062, or, to have "
        "it exactly as it is, `time.enforce: false`"
    )
    free = step_of(scene(time="step: 0.02, enforce: false"))
    free.refuse(free.limits(Motion())[0])
    assert free.choose() == chosen(free, 1e6, 1e6) == chosen(free) == 0.02
    lines = free.describe(0.02)
    assert lines[0] == "time step 0.02 s: given; isolated particle limit 0.00806 s (material jelly)"
    assert lines[1].startswith("warning: time.step is 2.48 times the isolated particle limit")
    assert "`step: auto` chooses a stable one" in lines[1]


def test_enforce_is_about_given_steps(scene):
    with pytest.raises(InputError, match=r"must not be false where time\.step is auto"):
        scene(time="step: auto, enforce: false")


def test_safety_is_about_automatic_steps(scene):
    with pytest.raises(InputError, match=r"time\.safety: is of step: auto"):
        scene(time="step: 0.001, safety: 0.4")


def test_a_step_goes_on_from_its_state(scene):
    """Through JSON: the same lengths, to the last bit, and the same counts."""
    one, other = step_of(scene()), step_of(scene())
    one.begin()
    seen(one, 3.0)
    one.move(0.01, Motion(20.0, 7.0))
    one.choose()
    one.note([0.001], [one.code])
    other.restore(json.loads(json.dumps(one.state())))
    for step in (one, other):
        step.note([0.002] * 3, [step.code, 1, 2])
    assert [one.choose() for _ in range(5)] == [other.choose() for _ in range(5)]
    assert one.state() == other.state()


def test_an_automatic_step_is_explained(scene):
    """Which limit it is from; and that hat functions have none for a lone particle."""
    step = step_of(scene())
    (line,) = step.describe(0.004)
    assert line == (
        "time step 0.004 s: auto, at most 0.5 of the isolated particle limit 0.00806 s "
        "(material jelly)"
    )
    hats = step_of(scene(method="{basis: linear, transfer: {type: flip}}"))
    assert "no limit above zero for a lone particle" in hats.describe(0.003)[1]
    assert hats.describe(0.003)[1].endswith("nodes too light for the step are counted")
    musl = step_of(scene(method="{basis: linear, transfer: {type: flip}, stress_update: musl}"))
    assert musl.describe(0.003)[1].endswith("auto takes that of a filled body")


def test_the_stiffest_material_decides(scene, tmp_path):
    """Each material that a body has has its limits, named after it; the shortest is first."""
    path = tmp_path / "two.yaml"
    text = TEXT.format(
        size=[1.0, 1.0], cells=[20, 20], center=[0.5, 0.5], method="{}", time="step: auto",
        gravity=[0.0, 0.0],
    )  # fmt: skip
    (jelly,) = (line for line in text.splitlines() if "jelly: {" in line)
    steel = jelly.replace("jelly", "steel").replace("2.0e4", "2.0e6")
    text = text.replace(jelly, f"{jelly}\n{steel}")
    path.write_text(text)
    alone = step_of(load_scene(path)).limits(Motion())
    assert {limit.cause for limit in alone} == {"material jelly"}
    body = text[text.index("  - name:") :]
    second = body.replace("material: jelly", "material: steel").replace("ball\n", "second\n", 1)
    path.write_text(text + second)
    found = step_of(load_scene(path)).limits(Motion())
    assert [limit.cause for limit in found] == ["material steel"] * 2 + ["material jelly"] * 2
    assert found[2].seconds == pytest.approx(10 * found[0].seconds, rel=1e-14)


def test_steps_taken_are_remembered(scene):
    """The shortest and the longest, and what bound each; the limit that bound most."""
    step = step_of(scene())
    step.begin()
    step.move(0.0, Motion(100.0, 50.0))
    travel, growth = BOUNDS.index("travel"), BOUNDS.index("growth")
    step.note([0.3, 0.1, 0.2, 0.2], [travel, travel, growth, growth])
    assert (step.shortest, step.longest) == (0.1, 0.3)
    assert step.counts == {"isolated particle": 1, "travel": 2, "growth": 1}
    assert step.most_binding() == (Limit("travel", 0.5 * DX / 100, "speed 100 m/s"), 2)


def test_a_limit_of_motion_names_its_particle(scene):
    """It is asked for when the limit first binds, and again once it is a tenth shorter; the one
    that is known stays in between."""
    step, travel = step_of(scene()), BOUNDS.index("travel")
    step.begin()

    def fly(speed):
        step.move(0.0, Motion(speed, 1.0))
        step.note([0.1], [travel])

    fly(100.0)
    assert step.is_nameless
    step.name(Motion(100.0, 1.0, fastest=7, steepest=8))
    assert "deformation" not in step.binders
    fly(105.0)
    assert not step.is_nameless
    assert step.binders["travel"] == Limit("travel", 0.5 * DX / 100, "speed 100 m/s", 7)
    fly(120.0)
    assert step.is_nameless
    step.name(Motion(120.0, 1.0, fastest=9, steepest=8))
    assert step.binders["travel"] == Limit("travel", 0.5 * DX / 120, "speed 120 m/s", 9)
    assert step.counts == {"isolated particle": 1, "travel": 2}
