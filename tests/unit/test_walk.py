"""A step, stage by stage."""

from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest

from mpm_taichi import Simulation, load_scene
from mpm_taichi.errors import InputError, RunError
from mpm_taichi.recorders.stages import look_ahead
from mpm_taichi.stage_formulas import formulas, stage_names
from mpm_taichi.walk import Stage, Walk

LATTICE = Path(__file__).parents[2] / "scenes" / "two_disks_lattice.yaml"
STEPS = 3
METHODS = {
    "linear FLIP": [],
    "quadratic MLS at walls": ["method={}", "domain.walls=slip", "gravity=[0,-9.81]"],
}


def scene_of(changes):
    return load_scene(LATTICE, ["output.images=none", *changes])


@pytest.fixture(scope="module", params=METHODS)
def steps(request):
    """Some steps from the same start, in three ways: whole in one launch, in stages, and walked, of
    which all stages are kept with their numbers."""
    simulation = Simulation(scene_of(METHODS[request.param]), threads=1)
    assert simulation.solver.is_whole
    clock, fields = everything(simulation)
    found = {}
    for way in ("whole", "staged"):
        simulation.solver.is_whole = way == "whole"
        for _ in range(STEPS):
            simulation.step()
        found[way] = everything(simulation)
        simulation.restore(clock, fields)
    walk = Walk(simulation, particle=40)
    stages = [walk.advance() for _ in range(4 * STEPS)]
    return Walked(walk, stages, found | {"walk": everything(simulation)})


def everything(simulation):
    """Numbers and fields, as a checkpoint keeps them."""
    stored = simulation.solver.stored
    return simulation.state(), {name: field.to_numpy() for name, field in stored.items()}


class Walked(NamedTuple):
    walk: Walk
    stages: list[Stage]
    found: dict[str, tuple]

    @property
    def scene(self):
        return self.walk.simulation.scene


def test_a_walk_ends_where_the_steps_end(steps):
    """The walk calls the kernels of the step in their order, so it equals the steps in stages to
    the last bit.  Whole steps are compiled as one kernel, whose terms may be rounded otherwise:
    1e-12 of the largest value, as in the parity tests."""
    (ours, fields) = steps.found["walk"]
    for way, tolerance in (("staged", 0.0), ("whole", 1e-12)):
        theirs, its_fields = steps.found[way]
        assert ours["step_count"] == theirs["step_count"] == STEPS
        for name in ("time", "dt", "last_dt"):
            assert ours[name] == pytest.approx(theirs[name], rel=tolerance)
        for name, values in fields.items():
            assert np.abs(values - its_fields[name]).max() <= tolerance * np.abs(values).max(), name
    assert ours == steps.found["staged"][0]


def test_stages_follow_the_method(steps):
    """Update stress last: the four stages of the source slides, then the next step."""
    assert [stage.name for stage in steps.stages] == list(stage_names(steps.scene)) * STEPS
    assert all(stage.formula == formulas(steps.scene, stage.name) for stage in steps.stages)
    assert [stage.time for stage in steps.stages[::4]] == pytest.approx([0, 1e-3, 2e-3])


def test_weights_and_masses(steps):
    """sum_i w_ip = 1 and sum_i grad w_ip = 0 to rounding (the gradients are some 100 / m); the
    nodes have the mass of all particles, and after the reset none."""
    total = steps.found["walk"][1]["m"].sum()
    for stage in steps.stages:
        assert stage.weights.sum() == pytest.approx(1, abs=1e-14)
        assert np.abs(stage.gradients.sum(axis=0)).max() < 1e-11
        there = 0.0 if stage.name == "reset" else total
        assert stage.node_mass.sum() == pytest.approx(there, rel=1e-12)


def test_a_step_is_what_its_formulas_say(steps):
    """From the nodes that a walk shows, by the formulas that it shows, for the picked particle:
    x_p and v_p (to rounding), F_p = (I + dt L_p) F_p, and the places of the moved nodes."""
    increment = steps.scene.method.transfer_class.increment
    for first in range(0, len(steps.stages), 4):
        before, grid, after, reset = steps.stages[first : first + 4]
        p, i, w = grid.particle, grid.nodes, grid.weights
        moved = before.position[p] + grid.dt * w @ grid.node_velocity[i]
        assert after.position[p] == pytest.approx(moved, rel=1e-12)
        change = grid.node_velocity - increment * grid.node_velocity_before
        expected = increment * before.velocity[p] + w @ change[i]
        assert after.velocity[p] == pytest.approx(expected, rel=1e-10)
        F, F_new = (dict_of(stage)["F_p"] for stage in (before, after))
        L = dict_of(after)["L_p"]
        assert F_new == pytest.approx((np.eye(2) + grid.dt * L) @ F, abs=1e-13)
        assert grid.moved_node == pytest.approx(grid.node_position + grid.dt * grid.node_velocity)
        assert (reset.moved_node == reset.node_position).all()


def dict_of(stage):
    return {number.symbol: number.value for number in stage.numbers}


def test_nothing_else_moves_amid_a_step(steps):
    """Until its last stage a step can only be finished: then the simulation goes on as ever."""
    walk, simulation = steps.walk, steps.walk.simulation
    walk.advance()
    assert walk.is_amid_step
    with pytest.raises(RunError, match="amid a step"):
        simulation.step()
    walk.particle = 3
    assert walk.stage.particle == 3
    walk.finish()
    assert not walk.is_amid_step and walk.stage.name == "reset"
    count = simulation.step_count
    simulation.step()
    assert simulation.step_count == count + 1


@pytest.mark.parametrize(
    ("method", "stage", "line"),
    [
        ("{stress_update: usf, basis: linear, transfer: {type: flip}}", "stress",
         "v_i = sum_p w_ip m_p v_p / m_i"),
        ("{stress_update: musl, basis: linear, transfer: {type: tpic}}", "nodes to particles",
         "L_p = sum_i v_i grad w_ip^T"),
        ("{transfer: {type: flip, ratio: 0.9}}", "nodes to particles",
         "v_p <- alpha (v_p + sum_i w_ip (v_i - v_i^old)) + (1 - alpha) sum_i w_ip v_i"),
        ("{transfer: {type: xpic, order: 3}}", "nodes to particles",
         "v_p <- v_p - (1 - S S^+)^3 v_p + sum_i w_ip (v_i - v_i^old)"),
        ("{transfer: {type: apic, force: gradient}}", "particles to nodes",
         "(m v)_i = sum_p (w_ip (m_p v_p + A_p r_ip) - dt V_p tau_p grad w_ip)"),
        ("{basis: cubic}", "particles to nodes",
         "A_p = m_p C_p - dt V_p tau_p D^-1, D = dx^2 / 3"),
    ],
)  # fmt: skip
def test_formulas_are_those_of_the_method(method, stage, line):
    """As the module docstrings of the transfers, and Solver.stages for orders of the stress."""
    assert line in formulas(scene_of([f"method={method}"]), stage)


def test_a_step_that_is_seen_ahead_is_taken_back(steps):
    """To see the next step for a recorder leaves everything as it was, to the last bit; and what is
    seen is the step that then comes."""
    simulation = steps.walk.simulation
    clock, fields = everything(simulation)
    stages = look_ahead(simulation)
    its_clock, its_fields = everything(simulation)
    assert its_clock == clock and its_fields.keys() == fields.keys()
    assert all((its_fields[name] == values).all() for name, values in fields.items())
    assert tuple(stages) == stage_names(steps.scene)
    simulation.step()
    assert (stages["nodes to particles"].position == simulation.snapshot.position).all()


def test_3d_is_refused():
    class Cube:
        scene = load_scene(LATTICE.with_name("two_balls.yaml"))

    with pytest.raises(InputError, match="2D only"):
        Walk(Cube())  # pyright: ignore[reportArgumentType]
