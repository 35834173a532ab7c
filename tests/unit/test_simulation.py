"""A Simulation as a program uses it: one after another, frame by frame, and when it goes wrong."""

import numpy as np
import pytest

from mpm_taichi import Simulation, diagnostics, load_scene, recorders
from mpm_taichi.errors import InputError, RunError
from mpm_taichi.scene import Images
from tests.command_line import SCENES

SHORT = ("time.end=0.05", "output.every=0.02")
NEO_HOOKEAN = "{type: neo_hookean, density: 1000, youngs_modulus: 1000, poissons_ratio: 0.3}"


def scene(*changes: str):
    return load_scene(SCENES / "two_disks_lattice.yaml", [*SHORT, *changes])


class Seen:
    """A recorder that notes what it is shown, and where the particles are at outputs."""

    def __init__(self):
        self.steps: list[int] = []
        self.outputs: list[tuple[float, int, np.ndarray]] = []

    def record(self, simulation, is_output):
        self.steps.append(simulation.step_count)
        if is_output:
            moment = simulation.snapshot
            self.outputs.append((simulation.time, simulation.step_count, moment.position))


def test_a_run_shows_its_steps_and_repeats():
    """Recorders see the start, each of 50 steps and the end, with outputs at 0, 0.02, 0.04, 0.05 s.

    A second Simulation in the same process starts afresh; `for now in simulation.frames()` pauses
    at the same outputs, and the numbers are the same to the last bit."""
    first, seen = Simulation(scene()), Seen()
    first.run([seen])
    assert first.is_done
    assert first.time == first.end == 0.05
    assert seen.steps == list(range(51))
    assert [(t, step) for t, step, _ in seen.outputs] == [
        (0.0, 0), (0.02, 20), (0.04, 40), (0.05, 50),
    ]  # fmt: skip
    assert first.warnings() == {}
    again = Simulation(scene())
    assert (again.time, again.step_count) == (0.0, 0)
    for (t, step, x), now in zip(seen.outputs, again.frames(), strict=True):
        assert (now.time, now.step_count) == (t, step)
        assert (now.snapshot.position == x).all()
        assert now.snapshot.time == t
    assert list(again.frames()) == [again]  # where it is: at its end


def test_functions_are_recorders_too():
    """A plain function is called at the start and at each output, beside recorder objects and with
    the same moment; what is neither is refused in words, before the first step."""
    simulation, seen, times = Simulation(scene("time.end=0.006", "output.every=0.002")), Seen(), []
    with pytest.raises(InputError, match=r"a recorder is a function of the simulation, .*got 7"):
        simulation.run([7])
    assert simulation.step_count == 0
    simulation.run([seen, lambda now: times.append((now.time, now.step_count))])
    assert times == [(time, step) for time, step, _ in seen.outputs]
    assert [time for time, _ in times] == [0.0, 0.002, 0.004, 0.006]


def test_a_notebook_shows_the_picture(tmp_path):
    """`_repr_png_` is the picture that a run writes at this moment, byte by byte, also where the
    scene writes none; the simulation goes on as if nobody had looked."""
    words = ("time.end=0.006", "output.every=0.002", "output.images.size=100")
    simulation, shown = Simulation(scene(*words)), None
    for _ in simulation.frames():
        shown = simulation._repr_png_()
    style = simulation.scene.output.images
    assert isinstance(style, Images)
    recorder = recorders.Images(tmp_path, simulation, style)
    recorder.record(simulation, is_output=True)
    assert shown == (tmp_path / "frame_0000.png").read_bytes()
    end, plain = simulation.snapshot.position, Simulation(scene("output.images=none", *words[:2]))
    plain.run()
    assert (plain.snapshot.position == end).all()
    picture = plain._repr_png_()
    assert picture is not None
    assert picture.startswith(b"\x89PNG")


def test_a_snapshot_is_of_its_moment():
    """The start is as given: 0.625 kg each, F = I, no stress, 2.6 J of motion and no other energy.

    A snapshot is taken once a step, and again after the next: disks that fly at 0.1 m/s per axis
    are 0.1 dt further, to rounding.  Its arrays are the reader's, to keep or to spoil."""
    simulation = Simulation(scene())
    before = simulation.snapshot
    assert before.mass == pytest.approx(np.full(416, 0.625), rel=1e-14)
    assert (before.deformation_gradient == np.eye(2)).all()
    assert not before.cauchy_stress.any()
    assert diagnostics.kinetic_energy(before) == pytest.approx(2.6, rel=1e-14)
    assert diagnostics.elastic_energy(before) == 0
    assert simulation.describe_particle(207) == "particle 207 (body lower, material rubber)"
    assert simulation.describe_particle(208) == "particle 208 (body upper, material rubber)"
    assert simulation.snapshot is before
    x = before.position.copy()
    before.velocity[:] = np.nan
    simulation.step()
    moved = simulation.snapshot.position - x
    sign = np.where(simulation.body_of_particle == 0, 1, -1)[:, None]
    assert np.abs(moved - 0.1 * 1e-3 * sign).max() < 1e-15
    assert (before.position == x).all()


@pytest.mark.filterwarnings("error")
def test_a_number_that_is_none_ends_the_run():
    """NaN in the position, deformation or momentum of one particle of 416, wherever the sort has
    put it, or a neo-Hookean particle turned inside out, F = diag(-1, 1), whose J < 0 has no
    logarithm: a RunError that names it by its place in the scene, with the moment and advice, from
    a snapshot for pictures as from the sums of a row of history.csv."""
    simulation = Simulation(scene(f"materials.rubber={NEO_HOOKEAN}"))
    simulation.step()
    particles = simulation.solver.particles
    place = int(np.flatnonzero(particles.id.to_numpy() == 300)[0])
    mirrored = np.diag([-2.0, 0.0])
    for name, value, words in (
        ("x", np.nan, "has a position that is no number (x = (nan, nan) m, v = ("),
        ("H", np.nan, "has a deformation that is no number (x = ("),
        ("rows", np.nan, "has a velocity that is no number (x = ("),
        ("H", mirrored, "is turned inside out: det F = -1 (x = ("),
    ):
        field = getattr(particles, name)
        whole = field.to_numpy()
        spoiled = whole.copy()
        spoiled[place] = value
        field.from_numpy(spoiled)
        for shown in ("snapshot", "sums"):
            simulation.__dict__.pop(shown, None)
            with pytest.raises(RunError) as found:
                getattr(simulation, shown)
            text = str(found.value)
            start = f"t = 0.001 s, step 1: particle 300 (body upper, material rubber) {words}"
            assert text.startswith(start)
            assert "). A shorter time.step may help: steps were up to 0.001 s" in text
        field.from_numpy(whole)
    assert simulation.snapshot.step == 1
    assert np.isfinite(simulation.sums["kinetic_energy"]).all()


def test_one_after_the_other():
    """Taichi has one set of fields: what reads those of a simulation that another has ended is
    told so, where it would crash the process.  What was read before stays."""
    first = Simulation(scene())
    snapshot = first.snapshot
    second = Simulation(scene())
    for ended in (first.advance, first.warnings, first.state, lambda: first.sums):
        with pytest.raises(RunError, match="this Simulation has ended: another was started"):
            ended()
    assert first.snapshot is snapshot
    second.step()


def test_a_speed_beyond_all_bounds():
    """|v|^2 of 1e200 m/s overflows: an automatic step would be 0.  RunError, not a division."""
    with np.errstate(over="ignore"), pytest.raises(RunError, match="time step would be 0 s"):
        Simulation(scene("time.step=auto", "bodies[0].velocity=[1e200, 0]"))


def test_warnings_count_what_a_reader_should_know():
    """Three steps of 0.0625 s are above the acoustic limit of 0.0263 s.  Two of them bring lattice
    points from 0.0125 to 0.025 m, where hat functions carry a weight of rounding error to the next
    node: taken as none, and counted.  At the start some nodes carry less than half of a particle,
    too little for such a step: told too."""
    simulation = Simulation(
        scene(
            "time.step=0.0625", "time.enforce=false", "time.end=0.1875", "output.every=0.1875"
        )
    )  # fmt: skip
    simulation.run()
    found = simulation.warnings()
    empty = "nodes below the mass cut-off, taken as empty (counted each step)"
    (light,) = (words for words in found if words.startswith("nodes too light for the step"))
    assert found.keys() == {"steps longer than the acoustic limit", empty, light}
    assert found["steps longer than the acoustic limit"] == 3
    assert found[empty] > 0


def test_a_given_step_is_shortened_as_bodies_get_faster():
    """0.0262 s is just below the acoustic limit at the start, 0.76 0.9 dx / (c + |v|) with
    c + |v| = 1.160 + 0.141 m/s.  Falling by 1 m/s^2 the disks gain 0.026 m/s in a step: the third
    and all later steps are shortened to the limit of their moment, or grow back slowly where a
    disk was slowed; counted."""
    simulation = Simulation(
        scene("time.step=0.0262", "gravity=[0, -1]", "time.end=0.25", "output.every=0.25")
    )
    simulation.run()
    rule = simulation.time_step
    limit = rule.limits(rule.motion)[0]
    assert limit.name == "acoustic"
    assert simulation.last_dt <= limit.seconds * 1.03 < 0.9 * 0.0262
    assert rule.shortened >= simulation.step_count - 2 and rule.counts["acoustic"] > 0
    words = "steps shorter than time.step, since a limit asked for it"
    assert simulation.warnings()[words] == rule.shortened


def test_too_many_threads():
    """A count of threads that no machine has would overflow loop counters: refused in words."""
    with pytest.raises(InputError, match=r"--threads: at most 1024 \(got 5000000\)"):
        Simulation(scene(), threads=5_000_000)


def test_a_precision_that_a_device_lacks():
    """Metal has no f64: refused before anything starts, on any computer, with the way out."""
    with pytest.raises(InputError, match="no 64-bit floats: take --precision f32"):
        Simulation(scene(), device="metal", precision="f64")


def test_the_fastest_particle_is_named():
    """Automatic steps of two disks, of which the second flies at 8 m/s, seven times the speed of
    sound: bound by the travel of one of its particles, at the start and later."""
    simulation = Simulation(
        scene("time.step=auto", "bodies[0].velocity=[1,0]", "bodies[1].velocity=[-8,0]")
    )
    (start,) = (each for each in simulation.limits_at_start if each.name == "travel")
    simulation.advance(3)
    assert set(simulation.time_step.binders) == {"travel"}
    for limit in (start, simulation.time_step.binders["travel"]):
        assert limit.particle is not None
        assert simulation.body_of_particle[limit.particle] == 1
        assert limit.seconds == pytest.approx(0.5 * 0.05 / 8, rel=0.02)


def test_nodes_too_light_are_told():
    """A disk moved so that its last particles are 1e-5 cells past nodes: with C = 0.023 the strain
    there grows for a weight below C^2 / 2 = 2.7e-4 (linear FLIP, USL), which warnings tell with the
    ways out; moved by a tenth of a cell less it has no such node."""
    for shift, told in ((0.0125005, True), (0.0075, False)):
        simulation = Simulation(scene(f"bodies[0].displacement=[{shift},{shift}]"))
        simulation.step()
        found = [words for words in simulation.warnings() if "too light" in words]
        assert (len(found), simulation.lookout.slivers > 0) == (told, told)
        assert all("basis: quadratic, or stress_update: musl" in words for words in found)


def test_particles_that_lose_their_neighbors_are_told():
    """Half a cell apart and stretched by 1.7 the particles of one disk are 0.85 cells apart, above
    the 0.6 at which hat functions are warned of; by 1.1 they are not."""
    for stretch, expected in ((0.7, 208), (0.1, 0)):
        simulation = Simulation(scene(f"bodies[0].displacement=[{stretch}*X,0]"))
        simulation.lookout.at_output()
        assert simulation.lookout.parting == expected
        assert any("numerical fracture" in words for words in simulation.warnings()) == (
            expected > 0
        )
