"""The form for GPUs, on software Vulkan (lavapipe), against the form for CPUs."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from mpm_taichi import runtime
from mpm_taichi.errors import InputError

from . import device_run, queue_run

ROOT = Path(__file__).parents[2]
SCENE = """\
version: 1
domain: {size: [1, 1], cells: [8, 8]}
time: {end: 0.01}
materials: {jelly: {type: neo_hookean, density: 1, youngs_modulus: 1, poissons_ratio: 0.3}}
bodies:
  - name: ball
    material: jelly
    shape: {type: ball, center: [0.5, 0.5], radius: 0.2}
    particles: {type: lattice, per_cell: 2}
output: {images: none}
"""


def python(*arguments):
    return subprocess.run(
        [sys.executable, *arguments], cwd=ROOT, capture_output=True, text=True, timeout=300
    )


@pytest.fixture(scope="module")
def vulkan():
    """A machine of a user's may have no Vulkan driver; CI must (see .ci/run)."""
    probe = "from mpm_taichi import runtime; runtime.start('vulkan', 'f32')"
    result = python("-c", probe)
    if result.returncode and not os.environ.get("CI"):
        pytest.skip("Vulkan does not work here: apt-get install libvulkan1 mesa-vulkan-drivers")
    assert result.returncode == 0, result.stderr


def states(folder, device, precision, run=device_run):
    name = run.__name__
    path = folder / f"{name}_{device}_{precision}.npz"
    if device == "cpu":
        run.main(device, precision, path)
    else:
        result = python("-m", name, device, precision, str(path))
        assert result.returncode == 0, result.stderr
    with np.load(path) as arrays:
        return dict(arrays)


@pytest.mark.slow
def test_atomics_and_slabs_agree(vulkan, tmp_path):
    """After 40 steps with sorts, FLIP in 2D and MLS in 3D: the atomic form in f32 differs from f64
    slabs by less than 1e-5 and no more than 3 times as much as f32 slabs do (other order)."""
    truth = states(tmp_path, "cpu", "f64")
    slabs = states(tmp_path, "cpu", "f32")
    atomics = states(tmp_path, "vulkan", "f32")
    for name, exact in truth.items():
        scale = np.abs(exact).max()
        error = np.abs(atomics[name] - exact).max() / scale
        usual = np.abs(slabs[name] - exact).max() / scale
        print(f"{name}: from f64, atomics {error:.1e}, slabs {usual:.1e}")
        assert error < min(1e-5, 3 * usual)


@pytest.mark.slow
def test_queued_steps_are_those_of_the_cpu(vulkan, tmp_path):
    """A scene with all that a queue has to get right (queue_run.py): in f32, and with a clock of 32
    bits, it takes the same number of steps as the CPU in f64, bound by the same limits, of the same
    lengths up to rounding (the clock rounds by 6e-8, the motion by 1e-5), reaches the outputs
    exactly, sorts as often and ends in the same state (see above).  A particle outside the domain
    ends the run in the first step that it is there."""
    truth = states(tmp_path, "cpu", "f64", queue_run)
    found = states(tmp_path, "vulkan", "f32", queue_run)
    for name in ("times", "bounds", "sorts", "lost"):
        assert np.array_equal(found[name], truth[name]), name
    assert truth["sorts"] > 2
    assert truth["lost"] == 1
    assert len(truth["lengths"]) > 25
    assert np.allclose(found["lengths"], truth["lengths"], rtol=1e-5, atol=0)
    for name in ("x", "H"):
        error = np.abs(found[name] - truth[name]).max() / np.abs(truth[name]).max()
        print(f"{name}: {error:.1e}")
        assert error < 1e-5


@pytest.mark.slow
def test_scene_runs_on_vulkan(vulkan, tmp_path):
    """By default in f32, and where asked in f64: no kernel uses the f64 functions that Vulkan does
    not have (logarithm, exponential, angles)."""
    scene = tmp_path / "scene.yaml"
    scene.write_text(SCENE)
    for precision in ((), ("--precision", "f64")):
        folder = str(tmp_path / "".join(("run", *precision)))
        done = python(
            "-m", "mpm_taichi", str(scene), "--device", "vulkan", *precision, "-o", folder
        )
        assert done.returncode == 0, done.stderr
        assert f"vulkan {'f64' if precision else 'f32'}" in done.stderr


def test_unknown_device_is_refused():
    """No silent fall-back to the CPU."""
    with pytest.raises(InputError, match="--device metal does not work"):
        runtime.start("metal", "f32")
