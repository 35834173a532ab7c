"""Memory: what a scene allocates, told to the byte before it does, and refused where it is too
much."""

import ctypes
import gc
import json
import tracemalloc

import pytest
from taichi._snode.fields_builder import FieldsBuilder

from mpm_taichi import Simulation, cli, free_memory, load_scene, memory, report, sampling, snapshot
from mpm_taichi.attempts import Attempts
from mpm_taichi.errors import InputError
from mpm_taichi.memory import planned_memory, size
from mpm_taichi.seeding import expected_counts

SOFT = "{type: neo_hookean, density: 1000, youngs_modulus: 1e5, poissons_ratio: 0.3}"
HARD = "{type: linear_elastic, density: 1000, youngs_modulus: 1e5, poissons_ratio: 0.3}"


def text(dim, method, precision, laws=(SOFT,), cells=8, more=""):
    """Boxes side by side, one of each law, in a square or cube; particles half a cell apart."""
    bodies = ""
    for k in range(len(laws)):
        low, high = [0.25 + 0.25 * k, *[0.25] * (dim - 1)], [0.5 + 0.25 * k, *[0.75] * (dim - 1)]
        bodies += (
            f"  - {{name: b{k}, material: m{k}, particles: {{type: lattice, per_cell: 2}},\n"
            f"     shape: {{type: box, min: {low}, max: {high}}}}}\n"
        )
    materials = "".join(f"  m{k}: {law}\n" for k, law in enumerate(laws))
    return (
        f"version: 1\ndomain: {{size: {[1.0] * dim}, cells: {[cells] * dim}}}\n"
        f"method: {{{method}, precision: {precision}}}\ntime: {{end: 1, step: 0.001}}\n"
        f"materials:\n{materials}bodies:\n{bodies}output: {{images: none}}\n{more}"
    )


def scene_of(tmp_path, *arguments, changes=(), **options):
    path = tmp_path / "scene.yaml"
    path.write_text(text(*arguments, **options))
    return load_scene(path, list(changes))


def doubled(**carried):
    """Fields that the sort moves through one of their own."""
    return carried | {f"{name} (sort)": count for name, count in carried.items()}


PLAIN = {"V0": 4, "order": 4}
KINDS = {
    "2D linear FLIP, accumulated strain, f64": (
        (2, "basis: linear, transfer: {type: flip}", "f64", (HARD,)),
        doubled(x=16, H=32, m=8, id=4, rows=4 * 32, **{"linear_elastic.strain": 32})
        | {"V0": 8, "order": 4},
        452,
    ),
    "3D quadratic MLS, f32": (
        (3, "basis: quadratic, transfer: {type: apic}", "f32"),
        doubled(x=12, H=36, m=4, id=4, rows=4 * 16) | PLAIN,
        248,
    ),
    "2D quadratic APIC, f32": (
        (2, "basis: quadratic, transfer: {type: apic, force: gradient}", "f32"),
        doubled(x=8, H=16, m=4, id=4, rows=5 * 16) | PLAIN,
        232,
    ),
    "3D quadratic XPIC, f64": (
        (3, "basis: quadratic, transfer: {type: xpic}", "f64"),
        doubled(x=24, H=72, m=8, id=4, rows=6 * 32) | {"V0": 8, "order": 4},
        612,
    ),
    "2D GIMP TPIC, body force by place, f32": (
        (2, "basis: gimp, transfer: {type: tpic}", "f32"),
        doubled(x=8, H=16, m=4, id=4, rows=6 * 16) | PLAIN | {"X": 8, "half_width": 4},
        276,
    ),
    "3D linear TPIC, MUSL, two laws, f32": (
        (3, "basis: linear, transfer: {type: tpic}, stress_update: musl", "f32", (SOFT, HARD)),
        doubled(x=12, H=36, m=4, id=4, rows=8 * 16, **{"linear_elastic.strain": 18}) | PLAIN,
        412,
    ),
}


@pytest.mark.parametrize("kind", KINDS)
def test_a_scene_allocates_what_it_needs(tmp_path, kind):
    """The whole list of fields, in bytes per particle: no history under a law without one (of two
    laws only for one, here half of the particles), no affine rows under FLIP, no rows of gradients
    under MLS, no undeformed place and no width that nothing reads.

    And the plan is true: Taichi's trees of fields have as many bytes, but for the constants, the
    counters and their alignment, under 1 KiB, less than another number per particle."""
    arguments, expected, total = KINDS[kind]
    more = "body_force: [0, sin(X)]\n" if "body force" in kind else ""
    scene = scene_of(tmp_path, *arguments, cells={2: 32, 3: 12}[arguments[0]], more=more)
    simulation = Simulation(scene)
    plan = simulation.memory
    count = simulation.solver.particles.count
    assert plan.particles == count > 256
    assert {name: n / count for name, n in plan.of_particles.items()} == expected
    assert plan.per_particle == sum(expected.values()) == total
    allocated = sum(root._cell_size_bytes for root in FieldsBuilder._finalized_roots())
    assert 0 <= allocated - plan.fields < 1024
    assert plan.summary()["fields"]["rows"] == expected["rows"] * count


def test_shared_scratch(tmp_path):
    """The sort moves V0 and half_width through the scratch of m, X through that of x."""
    scene = scene_of(
        tmp_path, 2, "basis: gimp, transfer: {type: tpic}", "f64", more="body_force: [X, 0]\n"
    )
    particles = Simulation(scene).solver.particles
    room = {id(field): scratch for field, scratch, _begin in particles.carried}
    assert room[id(particles.V0)] is room[id(particles.m)] is room[id(particles.half_width)]
    assert room[id(particles.X)] is room[id(particles.x)]
    assert len(room) == 8
    plain = Simulation(scene_of(tmp_path, 2, "basis: quadratic", "f64")).solver.particles
    assert plain.X is plain.x


def test_nodes_and_their_second_record(tmp_path):
    """8 x 8 cells of hat functions: 13 x 17 nodes in rows of 4 more, 256 to the mask, and a stencil
    of 2 (17 + 1) behind them; 4 lanes each, and with an increment twice."""
    flip = scene_of(tmp_path, 2, "basis: linear, transfer: {type: flip}", "f64")
    pic = scene_of(tmp_path, 2, "basis: linear, transfer: {type: pic}", "f64")
    one = planned_memory(pic, [8], "f64")
    two = planned_memory(flip, [8], "f64")
    assert one.nodes == 13 * 13
    assert one.of_nodes["node"] == 32 * (256 + 36)
    assert two.of_nodes["node"] == 2 * one.of_nodes["node"]
    assert one.of_nodes["count"] == 4 * 256
    assert one.of_nodes["occupied"] == one.of_nodes["reached"] == 4 * 256 // 32


def test_ten_million_particles(tmp_path):
    """3D, quadratic MLS, f32, 8 particles per cell in half of 136^3 cells: 2.48 GB for particles,
    0.09 GB for nodes and, while an output is made, 4.88 GB: 0.55 GB below 8."""
    scene = scene_of(tmp_path, 3, "basis: quadratic, transfer: {type: apic}", "f32", cells=136)
    plan = planned_memory(scene, [10_000_000], "f32")
    assert sum(plan.of_particles.values()) == 2_480_000_000
    assert plan.output == 4_880_000_000
    assert plan.needs("cpu")["memory"] == pytest.approx(7.45e9, rel=1e-3)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("dim", "precision"), [(2, "f64"), pytest.param(3, "f32", marks=pytest.mark.campaign)]
)
def test_arrays_on_the_host(tmp_path, monkeypatch, dim, precision):
    """NumPy's peak in an output is that of the plan, 10 % for the arrays of a block of particles.
    Starting takes less.  It is the second output that counts: arrays with which a kernel was
    compiled are in cycles of Taichi's, and go when Python collects those."""
    scene = scene_of(
        tmp_path, dim, "basis: quadratic, transfer: {type: apic}", precision,
        cells=32 if dim == 3 else 200, changes=["time.enforce=false"],
    )  # fmt: skip
    monkeypatch.setattr(snapshot, "BLOCK", 128)
    tracemalloc.start()
    try:
        simulation = Simulation(scene)
        start = tracemalloc.get_traced_memory()[1]
        _ = simulation.snapshot
        del simulation.snapshot
        gc.collect()
        others = tracemalloc.get_traced_memory()[0] - 8 * simulation.memory.particles * (dim + 2)
        tracemalloc.reset_peak()
        _ = simulation.snapshot
        peak = tracemalloc.get_traced_memory()[1] - others
    finally:
        tracemalloc.stop()
    print(start / simulation.memory.output, peak / simulation.memory.output, others)
    assert start - others < simulation.memory.output
    assert 0.9 < peak / simulation.memory.output < 1.1


def free(monkeypatch, **places):
    monkeypatch.setattr(memory, "free_memory", lambda device: places)


def test_too_much_is_refused(tmp_path, monkeypatch):
    """Where a scene needs more than is free: an InputError with what is needed and free, bytes per
    particle and node, the three largest fields, and cells that do fit, the most of them."""
    path = tmp_path / "scene.yaml"
    path.write_text(text(3, "basis: quadratic, transfer: {type: apic}", "f32", cells=64))
    scene = load_scene(path)
    assert expected_counts(scene) == [16 * 32 * 32 * 8]
    free(monkeypatch, memory=32 * 2**20)
    with pytest.raises(InputError) as found:
        Simulation(scene)
    said = str(found.value)
    for words in (
        "the scene needs 102 MiB of memory, and 32 MiB are free:", "131,072 particles of 248 B",
        "357,911 nodes of", "the largest fields are node 8.26 MiB, rows 8 MiB, rows (sort) 8 MiB. ",
        "domain.cells: [",
    ):  # fmt: skip
        assert words in said, said
    cells = int(said.split("domain.cells: [")[1].split(",")[0])
    assert f"[{cells}, {cells}, {cells}] would fit, cells of {1 / cells:.6g} m" in said
    for n, enough in ((cells, True), (cells + 1, False)):
        changes = [f"domain.cells={[n] * 3}"]
        there = load_scene(path, changes)
        needed = planned_memory(there, expected_counts(there), "f32").needs("cpu")["memory"]
        assert (needed <= 32 * 2**20) == enough
    simulation = Simulation(load_scene(path, [f"domain.cells={[cells] * 3}"]))
    assert simulation.memory.needs("cpu")["memory"] <= 32 * 2**20


def test_a_refusal_uses_the_words_of_the_scene(tmp_path, monkeypatch):
    """Particles a given distance apart stay when cells grow: then that distance is what helps.
    Cells whose numbers have no common divisor: the edge that would fit.  On a GPU, its memory."""
    method = "basis: linear, transfer: {type: flip}"
    apart = scene_of(
        tmp_path, 2, method, "f64",
        changes=["bodies[0].particles={type: lattice, spacing: 0.001}"],
    )  # fmt: skip
    free(monkeypatch, memory=20 * 2**20)
    with pytest.raises(InputError, match=r"bodies\[0\]\.particles\.spacing: 0\.00217 would fit"):
        Simulation(apart)
    odd = scene_of(
        tmp_path, 2, method, "f64",
        changes=["domain={size: [1, 1.01], cells: [100, 101]}"],
    )  # fmt: skip
    free(monkeypatch, memory=2**20)
    with pytest.raises(InputError, match=r"\. domain: cells of 0\.0\d+ m would fit"):
        Simulation(odd)
    free(monkeypatch, memory=2**40, **{"cuda memory": 2**16})
    with pytest.raises(InputError, match="of cuda memory, and 64 KiB are free"):
        memory.refuse_too_much(odd, [10_000], "cuda", "f64")
    free(monkeypatch)
    memory.refuse_too_much(odd, [10**9], "vulkan", "f64")


def test_a_typing_error_is_refused_before_particles_are_made(tmp_path, monkeypatch):
    """A zero too many makes 1.1e8 particles of a million: refused by their expected number, before
    each has a place (V / h^3)."""
    scene = scene_of(tmp_path, 3, "basis: quadratic", "f64", cells=600)
    free(monkeypatch, memory=2**33)
    monkeypatch.delattr(sampling.Lattice, "points")
    with pytest.raises(InputError, match=r"108,000,000 particles of 484 B"):
        Simulation(scene)


def test_nodes_alone_can_be_too_much(tmp_path, monkeypatch):
    """Before a mesh is made the number of its particles is not known: the nodes are counted."""
    box = "{type: box, min: [0.2, 0.2], max: [0.8, 0.8]}"
    scene = scene_of(
        tmp_path, 2, "basis: quadratic", "f64", cells=10_000,
        changes=["bodies[0].particles={type: gmsh, size: 0.1}", f"bodies[0].shape={box}"],
    )  # fmt: skip
    free(monkeypatch, memory=2**30)
    with pytest.raises(InputError, match=r"GiB are free: 100,140,049 nodes of .*cells: \[\d{4}, "):
        Simulation(scene)


def cgroup(root, version, groups):
    """Files of a Linux system: the process is in the first group; limit, use and cached files of
    each group, by its path."""
    top, limit, use, cached = free_memory.GROUPS[version]
    (root / "proc/self").mkdir(parents=True)
    first = next(iter(groups))
    line = f"0::{first}\n" if version == 2 else f"5:cpu:/\n4:memory:{first}\n"
    (root / "proc/self/cgroup").write_text(line)
    (root / "proc/meminfo").write_text("MemTotal: 999999 kB\nMemAvailable: 1000 kB\n")
    for path, (most, used, files) in groups.items():
        folder = root / top / path.lstrip("/")
        folder.mkdir(parents=True, exist_ok=True)
        (folder / limit).write_text(f"{most}\n")
        (folder / use).write_text(f"{used}\n")
        (folder / "memory.stat").write_text(f"anon 7\n{cached} {files}\n")


@pytest.mark.parametrize("version", [1, 2])
def test_control_groups(tmp_path, version):
    """The least of what is available and what each group around the process leaves; files that the
    kernel has cached count as free.  Without limits, without groups, and without Linux: what there
    is to ask."""
    none = "max" if version == 2 else 2**63 - 4096
    cases = {
        "own": ({"/a/b": (900_000, 500_000, 100_000), "/a": (none, 1, 0)}, 500_000),
        "around": ({"/a/b": (none, 5, 0), "/a": (600_000, 500_000, 0)}, 100_000),
        "full": ({"/a": (600_000, 700_000, 0)}, 0),
        "none": ({"/a": (none, 5, 0)}, 1_024_000),
        "host's path": ({"/": (300_000, 100_000, 0)}, 200_000),
    }
    for name, (groups, expected) in cases.items():
        cgroup(tmp_path / name, version, groups)
        if name == "host's path":
            path = tmp_path / name / "proc/self/cgroup"
            path.write_text(path.read_text().replace("/\n", "/on/the/host\n"))
        assert free_memory.free_on_host(tmp_path / name) == expected, name
    assert free_memory.free_on_host(tmp_path / "nothing") is None


def test_a_driver_is_asked(monkeypatch):
    """CUDA's own figure, through its C library; no library, or a call that fails: nothing."""

    class Driver:
        code = 0

        def __getattr__(self, name):
            if name != "cuMemGetInfo_v2":
                return lambda *arguments: 0

            def info(free, total):
                free._obj.value = 12345
                return self.code

            return info

    driver = Driver()
    monkeypatch.setattr(ctypes, "CDLL", lambda name: driver)
    assert free_memory.free_memory("cuda")["cuda memory"] == 12345
    driver.code = 1
    assert "cuda memory" not in free_memory.free_memory("cuda")

    def missing(name):
        raise OSError

    monkeypatch.setattr(ctypes, "CDLL", missing)
    assert free_memory.free_on_cuda() is None
    assert free_memory.free_memory("vulkan").keys() <= {"memory"}


def test_check_and_report_say_it(tmp_path, capfd):
    """One line of `check`; `memory` in run.json."""
    path = tmp_path / "scene.yaml"
    path.write_text(text(2, "basis: linear, transfer: {type: flip}", "f64"))
    assert cli.main(["check", str(path)]) == 0
    (line,) = [line for line in capfd.readouterr().err.splitlines() if "memory" in line]
    assert line == (
        "memory: 12.1 KiB for particles (388 B each), 19.5 KiB for nodes (118 B each), "
        "12.5 KiB for output"
    )
    scene = load_scene(path)
    attempts = Attempts(Simulation(scene), tmp_path, None)
    content = report.Report(attempts, []).content("running")
    assert json.loads(json.dumps(content))["memory"] == planned_memory(scene, [32], "f64").summary()


def test_sizes_in_words():
    """Three digits, in the unit that suits them."""
    assert [size(n) for n in (999, 312 * 1024, 24 * 2**20, 2.314 * 2**30, 4000 * 2**30)] == [
        "999 B", "312 KiB", "24 MiB", "2.31 GiB", "4,000 GiB",
    ]  # fmt: skip
