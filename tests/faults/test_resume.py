"""A run that is taken up again is the run that was never interrupted, to the last bit."""

import numpy as np
import pytest

from mpm_taichi import Simulation, load_scene
from mpm_taichi.checkpoints import load, newest, newest_first, save
from mpm_taichi.errors import InputError, MotionError

LAWS = {
    "linear": "{type: linear_elastic, density: 10, youngs_modulus: 1e4, poissons_ratio: 0.3}",
    "metal": "{type: von_mises, density: 10, youngs_modulus: 1e4, poissons_ratio: 0.3, "
    "yield_stress: 50, hardening: 100}",
    "sand": "{type: drucker_prager, density: 10, youngs_modulus: 1e4, poissons_ratio: 0.3, "
    "friction_angle: 30}",
    "snow": "{type: snow, density: 10, youngs_modulus: 1e4, poissons_ratio: 0.2, "
    "critical_compression: 2.5e-3, critical_stretch: 7.5e-4, hardening: 10}",
    "fluid": "{type: fluid, density: 10, bulk_modulus: 1e4, viscosity: 0.1}",
    "gas": "{type: gas, density: 10, pressure: 100}",
}

SCENE = """
version: 1
domain: {{size: {size}, cells: {cells}, walls: {walls}}}
method: {{basis: {basis}, transfer: {transfer}, stress_update: {update}, precision: {precision}}}
time: {{end: 0.5, step: {step}}}
gravity: {gravity}
{force}
materials:
  one: {one}
  other: {other}
bodies:
  - name: lower
    material: one
    shape: {{type: box, min: {low}, max: {high}}}
    particles: {{type: lattice, per_cell: 2}}
    velocity: {velocity}
  - name: upper
    material: other
    shape: {{type: box, min: {low2}, max: {high2}}}
    particles: {{type: lattice, per_cell: 2}}
output: {{every: 0.05, images: none, audit: {audit}}}
"""


def scene(
    tmp_path, basis, transfer, update, laws, precision="f64", step="auto, safety: 0.4", dim=2,
    **more,
):  # fmt: skip
    one, other = (LAWS[law] for law in laws)
    values = {
        "size": [1.0] * dim, "cells": [8] * dim, "walls": "slip", "gravity": [0.3, -9.8, 0.1][:dim],
        "low": [0.15] * dim, "high": [0.6] * dim, "low2": [0.25] + [0.65] * (dim - 1),
        "high2": [0.7] + [0.9] * (dim - 1), "velocity": ["2*Y", "1 - 3*X", "Y"][:dim], "force": "",
        "audit": "false",
    }  # fmt: skip
    values |= more
    text = SCENE.format(
        basis=basis, transfer=transfer, update=update, precision=precision, step=step, one=one,
        other=other, **values,
    )  # fmt: skip
    (tmp_path / "scene.yaml").write_text(text)
    return load_scene(tmp_path / "scene.yaml", [])


BASES = ("linear", "gimp", "quadratic", "cubic", "quadratic_boundary", "cubic_boundary")
TRANSFERS = (
    "{type: pic}", "{type: flip}", "{type: flip, relaxation_time: 0.01}", "{type: tpic}",
    "{type: apic}", "{type: apic, force: gradient}", "{type: xpic, order: 2}",
)  # fmt: skip
WALLS = ("slip", "sticky", "{left: periodic, right: periodic, bottom: sticky, top: separate}")


def drawn(tmp_path, rng, dim):
    """A scene of parts drawn at random that go together."""
    while True:
        laws = rng.choice(list(LAWS), 2)
        parts = {
            "basis": rng.choice(BASES), "transfer": rng.choice(TRANSFERS), "laws": laws,
            "update": rng.choice(("usl", "usl", "musl", "usf")), "dim": dim,
            "precision": rng.choice(("f32", "f64")), "walls": rng.choice(WALLS),
            "force": rng.choice(("", "body_force: [sin(3*X), t]")) if dim == 2 else "",
            "audit": rng.choice(("false", "true")),
        }  # fmt: skip
        try:
            found = scene(tmp_path, **parts)
        except InputError:  # APIC with the linear basis, say
            continue
        print(parts)
        return found


def fields(simulation):
    return {name: field.to_numpy() for name, field in simulation.solver.stored.items()}


def goes_on_alike(wanted, tmp_path, rng):
    """Steps to a draw, saves, steps on; then from the file once more."""
    simulation = Simulation(wanted)
    before, after = rng.integers(20, 40, 2)
    while simulation.step_count < before:
        simulation.advance(int(before) - simulation.step_count)
    path = save(
        tmp_path, simulation.step_count, {"simulation": simulation.state()},
        simulation.solver.stored,
    )  # fmt: skip
    ends = []
    for _ in range(2):
        sorts = simulation.solver.sorts
        while simulation.step_count < before + after:
            simulation.advance(int(before + after) - simulation.step_count)
        found = fields(simulation) | {"state": simulation.state()}
        ends.append((found, simulation.snapshot, simulation.solver.sorts - sorts))
        checkpoint = load(path)
        simulation.restore(checkpoint.meta["simulation"], checkpoint.arrays)
        assert simulation.step_count == before
    (first, seen, sorts), (second, seen_again, _) = ends
    print(f"{before} + {after} steps, {sorts} sorts in the second part")
    assert first["state"] == second["state"]
    for name, values in first.items():
        if name != "state":
            assert np.array_equal(values, second[name]), name
    assert np.array_equal(seen.cauchy_stress, seen_again.cauchy_stress)
    assert np.isfinite(seen.cauchy_stress).all()


@pytest.mark.slow
@pytest.mark.parametrize("dim", [2, pytest.param(3, marks=pytest.mark.campaign)])
def test_goes_on_to_the_last_bit(dim, tmp_path, rng):
    """Laws, basis, transfer, order of the stages, precision and walls are drawn.  After 20 to 40
    steps the run is saved, runs 20 to 40 steps on, goes back to the file and runs them again:
    clock, time step and every field that a checkpoint keeps are the same bytes.  What a checkpoint
    did not keep would be of the end, not of the moment it was written."""
    while True:
        try:
            return goes_on_alike(drawn(tmp_path, rng, dim), tmp_path, rng)
        except MotionError as error:  # some draws are no stable scheme
            print(error)


@pytest.mark.campaign
@pytest.mark.parametrize("draw", range(40))
def test_many_go_on_to_the_last_bit(draw, tmp_path, rng):
    """The same of forty draws."""
    test_goes_on_to_the_last_bit(2, tmp_path, rng)


class Held:
    """A field on the host."""

    def __init__(self, values):
        self.values = values

    def to_numpy(self):
        return self.values


def some(rng):
    return {"x": Held(rng.random((50, 2))), "law0.J": Held(rng.random(50).astype(np.float32))}


def test_the_last_two_are_kept(tmp_path, rng):
    """Of five, in the order of their steps; each as it was written, and nothing else in the
    folder."""
    written = {}
    for step in (3, 20, 100, 1000, 12345678901):
        written[step] = some(rng)
        save(tmp_path, step, {"step": step}, written[step])
    paths = newest_first(tmp_path)
    assert [path.name for path in paths] == ["step_12345678901.npz", "step_000001000.npz"]
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted(
        name for path in paths for name in (path.name, f"{path.name}.sha256")
    )
    found = newest(tmp_path)
    assert found is not None
    assert found.meta == {"step": 12345678901, "format": 1}
    for name, field in written[12345678901].items():
        assert found.arrays[name].dtype == field.values.dtype
        assert np.array_equal(found.arrays[name], field.values)


def test_damage_is_found_and_the_one_before_is_used(tmp_path, rng):
    """500 files with a bit flipped, a part cut off or filled with zeros, or a checksum lost: none
    is taken for whole, none ends in anything but an InputError; and the one before is used, with
    a warning that names the damaged one.  Where both are damaged: an InputError, never a start
    from nothing."""
    save(tmp_path, 1, {"step": 1}, some(rng))
    path = save(tmp_path, 2, {"step": 2}, some(rng))
    whole = path.read_bytes()
    digest = path.with_name(path.name + ".sha256")
    told = digest.read_bytes()
    for _ in range(500):
        content, checksum = bytearray(whole), told
        kind = rng.integers(5)
        at = int(rng.integers(len(content)))
        if kind == 0:
            content[at] ^= 1 << int(rng.integers(8))
        elif kind == 1:
            del content[at:]
        elif kind == 2:
            end = min(len(content), at + int(rng.integers(1, 600)))
            content[at:end] = bytes(end - at)
        elif kind == 3:
            checksum = told[: int(rng.integers(64))]
        else:
            checksum = bytes(rng.integers(0, 256, len(told), np.uint8))
        path.write_bytes(content)
        digest.write_bytes(checksum)
        if bytes(content) == whole and checksum == told:
            continue
        warnings = []
        with pytest.raises(InputError, match="step_000000002"):
            load(path)
        found = newest(tmp_path, warnings.append)
        assert found is not None
        assert found.meta["step"] == 1
        assert len(warnings) == 1
        assert path.name in warnings[0]
    newest_first(tmp_path)[1].write_bytes(b"")
    with pytest.raises(InputError, match="none of 2 checkpoints can be read"):
        newest(tmp_path)
    assert newest(tmp_path / "nowhere") is None


def test_no_pickle_is_opened(tmp_path):
    """A checkpoint made by someone else, whose checksum is right, with a pickle inside: refused."""
    import hashlib

    path = tmp_path / "step_000000001.npz"
    with path.open("wb") as file:
        np.savez(file, meta=np.array([{"format": 1}], dtype=object))
    digest = hashlib.sha256(path.read_bytes()).hexdigest()
    path.with_name(path.name + ".sha256").write_text(f"{digest}  {path.name}\n")
    with pytest.raises(InputError, match="no checkpoint of ours"):
        load(path)


def test_a_full_disk_leaves_the_last_good_one(tmp_path, rng):
    """/dev/full cannot be written, so a field that fails to come stands for it: the error goes up,
    the checkpoint of before is there, and no part of the new one."""

    class Failing(Held):
        def to_numpy(self):
            raise OSError(28, "No space left on device")

    save(tmp_path, 1, {}, some(rng))
    before = sorted(tmp_path.iterdir())
    with pytest.raises(OSError, match="No space left"):
        save(tmp_path, 2, {}, some(rng) | {"late": Failing(0)})
    assert sorted(tmp_path.iterdir()) == before
