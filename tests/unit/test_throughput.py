"""`throughput.py` adds up what it has timed, and measures on threads and in curves."""

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

BENCHMARKS = Path(__file__).parents[2] / "benchmarks"


@pytest.fixture
def bench(monkeypatch):
    """Modules of `throughput.py`."""
    monkeypatch.syspath_prepend(str(BENCHMARKS))
    import allocation  # pyright: ignore[reportMissingImports]
    import clocks  # pyright: ignore[reportMissingImports]
    import curves  # pyright: ignore[reportMissingImports]
    import limits  # pyright: ignore[reportMissingImports]
    import stopwatch  # pyright: ignore[reportMissingImports]
    import throughput  # pyright: ignore[reportMissingImports]
    import workload  # pyright: ignore[reportMissingImports]

    return SimpleNamespace(
        allocation=allocation, clocks=clocks, curves=curves, limits=limits, main=throughput,
        stopwatch=stopwatch, workload=workload,
    )  # fmt: skip


def test_least_and_median_of_turns(bench):
    """P2G of 5, 3, 7 and 9 ns, a sort of 40, 60 and 80 every 20th step: least 3 + 40 / 20, median
    6 + 60 / 20."""
    turns = [
        {"cpu": {"p2g": [5.0, 3.0], "sort": [80.0]}, "steps_per_sort": 20.0},
        {"cpu": {"p2g": [7.0, 9.0], "sort": [40.0, 60.0]}, "steps_per_sort": 20.0},
    ]
    found = bench.main.best(turns, "cpu")
    assert found["stages"] == {"p2g": 3.0, "sort": 40.0}
    assert found["median_stages"] == {"p2g": 6.0, "sort": 60.0}
    assert (found["total"], found["median_total"]) == (5.0, 9.0)


def test_balance_of_workers(bench):
    """3 ns beside 4: 0.75; nothing where nothing was counted."""
    assert bench.main.balance([4.0, 3.0]) == 0.75
    assert bench.main.balance([]) is None
    assert bench.main.balance([0.0, 0.0]) is None


def test_limits_of_a_particle_step(bench):
    """3D f32 at 26.6 GB/s: 266 bytes in 10 ns; 800 instructions, 4 a cycle, at 4 GHz: 50 ns.  Half
    of the first and a quarter of the second are 20 and 200 ns."""
    assert bench.limits.memory_limit(3, "f32", 26.6) == pytest.approx(10.0, rel=1e-15)
    assert bench.limits.instruction_limit(3, 4.0) == 50.0
    row = {"threads": 1, "clock_ghz": 4.0, "dim": 3, "precision": "f32", "total": 200.0}
    assert bench.main.add_shares({"3D f32": {"quadratic mls": row}}, 26.6) == 4.0
    assert row["shares"] == pytest.approx({"memory": 0.05, "float4": 0.25}, rel=1e-15)
    assert bench.limits.copy_bandwidth(2**20, 1) > 0


def test_bytes_of_fields(bench, fast):
    """In f64 a block of MLS in 2D: x, H and three rows of four lanes, twice for the sort; m, V0 and
    room for reals; id, order and room for whole numbers: 2 (16 + 32 + 96) + 24 + 12 bytes a
    particle.  What all share, as the constants of the law, is less than one byte for each of
    1,024."""
    solver, _ = bench.workload.our_solver(2, 1000, "quadratic mls")
    found = bench.allocation.allocated(bench.allocation.fields_of(solver.particles))
    assert 324 * 1024 <= found < 325 * 1024
    grid = bench.allocation.allocated(bench.allocation.fields_of(solver.grid))
    assert grid > 32 * solver.grid.node.shape[0]


def test_clock_of_the_processor(bench, fast):
    """Between 0.5 and 7 GHz, or None where latencies are not known; the time does not depend on
    what is computed, and grows with it: CPU and wall time of the chain are above 0."""
    spent = bench.stopwatch.spent(bench.clocks.clock_ghz)
    ghz = spent.result
    assert ghz is None or 0.5 < ghz < 7
    assert ghz is None or min(spent.cpu, spent.wall) > 0


def test_a_pause_is_on_neither_clock(bench):
    """A call that does nothing takes less than the pause behind it, at least once in twenty."""
    calls = [bench.stopwatch.spent(lambda: 7) for _ in range(20)]
    assert {call.result for call in calls} == {7}
    for clock in ("cpu", "wall"):
        assert 0 <= min(getattr(call, clock) for call in calls) < bench.stopwatch.PAUSE


def test_empty_cells_around_the_same_block(bench):
    """With twice the cells along each axis particles lie the same way in theirs, and cross as many
    of them in a step."""
    near, far = (bench.workload.block(3, 500, "quadratic mls", room) for room in (1, 2))
    cells, more = near[3], far[3]
    assert more == 2 * cells
    assert np.abs(far[0] * more - near[0] * cells - cells // 2).max() < 1e-12 * more
    assert np.abs(far[1] - near[1]).max() < 1e-14


def test_forms_by_name(bench):
    """`basis transfer` as classes; what does not exist or work is told in a sentence."""
    from mpm_taichi.bases import CubicBSpline
    from mpm_taichi.transfers import FLIPBlend

    assert bench.workload.pair("cubic FLIPBlend") == (CubicBSpline, FLIPBlend)
    for form in ("quadratic", "quartic mls", "quadratic pid"):
        with pytest.raises(ValueError, match="is no form: write 'BASIS TRANSFER' with one of lin"):
            bench.workload.pair(form)
    with pytest.raises(ValueError, match="'gimp mls' does not work: the force in its mls form"):
        bench.workload.pair("gimp mls")


def test_arguments_of_throughput(bench, capsys):
    """One thread is always there to compare with; what does not work ends with exit code 2."""
    options = bench.main.parse(["--quick", "--threads", "2"])
    assert (options.threads, options.forms, options.dim) == ([1, 2], ["quadratic mls"], [3])
    assert bench.main.parse([]).forms == list(bench.workload.FORMS)
    for words in (["--forms", "linear mls"], ["--threads", "0"], ["--large"], ["--rounds", "0"]):
        with pytest.raises(SystemExit) as end:
            bench.main.parse(words)
        assert end.value.code == 2
        assert words[0] in capsys.readouterr().err


def test_points_of_curves(bench):
    """Powers of ten up to a million, ten with --large, or up to what is asked; in 3D 100,000
    particles or fewer among 1, 8 and 64 times as many cells."""
    assert bench.curves.points(2) == [(10**k, 1) for k in (3, 4, 5, 6)]
    assert bench.curves.points(2, large=True)[-1] == (10**7, 1)
    assert bench.curves.points(3)[4:] == [(100_000, 2), (100_000, 4)]
    assert bench.curves.points(3, 500) == [(500, 1), (500, 2), (500, 4)]


@pytest.mark.slow
def test_threads_and_curves(bench, monkeypatch):
    """A thousand particles in 2D on one thread and on two, in turns: a line with the ratio of wall
    times, who did the work where Linux counts it, and a point of a curve."""
    for name in ("TEXTBOOK", "PEERS"):
        monkeypatch.setattr(bench.main, name, ())
    results = bench.main.measured(2, "f32", 1000, ["quadratic mls"], [1, 2], 1)
    one, two = (results[case]["quadratic mls"] for case in ("2D f32", "2D f32 2 threads"))
    ratio = two["wall"]["total"] / one["wall"]["total"]
    table = bench.main.thread_table(results)
    assert f"2D f32 quadratic mls, 2 threads | {two['wall']['total']:.1f}" in table
    assert f"{ratio:.3f}" in table
    assert all(ns > 0 for ns in two["stages"].values())
    for times in (one, two, one["wall"], two["wall"]):
        assert 0 < times["total"] <= times["median_total"]
    assert len(two["workers"]) == (2 if Path("/proc/self/schedstat").exists() else 0)
    assert all(ns > 0 for ns in two["workers"])
    (row,) = bench.curves.measured(2, "f32", "quadratic mls", [2], 1, most=1000)
    assert (row["particles"], row["threads"], row["cells"]) == (1024, 2, [64, 64])
    assert 0 < row["cpu"] <= row["median_cpu"]
    assert 0 < row["sort_share"] < 0.5
    assert f"{row['wall']:.1f}" in bench.curves.table([row])
