"""A run of whole steps on one device, in a process of its own, with all that these have to get
right: two materials of a law, ghosts at walls and along a periodic axis, gravity and a body force
that depends on time, a FLIP part that depends on dt, sorts and outputs.

    python -m tests.verification.queue_run DEVICE PRECISION OUT.npz
"""

import sys
from pathlib import Path

import numpy as np

from mpm_taichi import Simulation, load_scene
from mpm_taichi.errors import RunError

SCENE = """\
version: 1
domain: {size: [1, 1], cells: [10, 10], walls: {left: periodic, right: periodic, bottom: slip}}
method: {transfer: {type: flip, relaxation_time: 0.1}}
time: {end: 0.2}
gravity: [0, -1]
body_force: ["2*sin(6*x)*t", "-y*t"]
materials:
  jelly: {type: neo_hookean, density: 1, youngs_modulus: 10, poissons_ratio: 0.3}
  rubber: {type: neo_hookean, density: 2, youngs_modulus: 15, poissons_ratio: 0.2}
bodies:
  - name: ball
    material: jelly
    shape: {type: ball, center: [0.5, 0.26], radius: 0.2}
    particles: {type: lattice, per_cell: 2}
    velocity: [3, -1]
  - name: block
    material: rubber
    shape: {type: box, min: [0.2, 0.6], max: [0.5, 0.8]}
    particles: {type: lattice, per_cell: 2}
    velocity: [2, -0.5]
output: {images: none, every: 0.05}
"""


def run(scene, device, precision):
    """The state at the end and the clock on the way there."""
    simulation = Simulation(scene, device=device, precision=precision)
    assert simulation.solver.is_whole
    lengths, bounds, times = [], [], []
    note = simulation.time_step.note

    def remember(taken, codes):
        lengths.extend(taken)
        bounds.extend(codes)
        note(taken, codes)

    simulation.time_step.note = remember  # pyright: ignore[reportAttributeAccessIssue]
    for _ in simulation.frames():
        times.append(simulation.time)
    particles = simulation.solver.particles
    return {
        "x": particles.to_numpy("x"), "H": particles.to_numpy("H"), "lengths": lengths,
        "bounds": bounds, "times": times, "sorts": simulation.solver.sorts,
    }  # fmt: skip


def steps_until_lost(scene, device, precision):
    """With a particle that starts above the domain, which is open there."""
    simulation = Simulation(scene, device=device, precision=precision)
    x = simulation.solver.particles.x.to_numpy()
    x[3, 1] = 1.05
    simulation.solver.particles.x.from_numpy(x)
    try:
        simulation.advance()
    except RunError:
        return simulation.step_count
    return 0


def main(device, precision, path):
    file = Path(path).with_suffix(".yaml")
    file.write_text(SCENE)
    scene = load_scene(file)
    results = run(scene, device, precision)
    np.savez(path, **results, lost=steps_until_lost(scene, device, precision))


if __name__ == "__main__":
    main(*sys.argv[1:])
