"""A run folder with a motion that a test makes up, as a run would have left it."""

import csv
import json
from pathlib import Path

import numpy as np

from mpm_taichi import load_scene
from mpm_taichi.arrays_file import write_arrays
from mpm_taichi.recorders.snapshots import SCALARS
from mpm_taichi.scene import dump_scene
from tests.command_line import SCENES


def write_run(folder: Path, scene: str, changes, position, scalars=None, every=0.1) -> Path:
    """Positions [frames, n, dim] every `every` seconds, NaN of a particle that was deleted, with
    the velocities of their differences; scalars [frames, n] by name, 0 unless given; bodies take
    turns."""
    folder.mkdir(parents=True)
    experiment = load_scene(SCENES / f"{scene}.yaml", changes)
    (folder / "scene.yaml").write_text(dump_scene(experiment), encoding="utf-8")
    report = {"status": "done", "steps": 100, "versions": {"mpm_taichi": "0", "gmsh": None}}
    (folder / "run.json").write_text(json.dumps(report))
    position = np.asarray(position, np.float32)
    frames, n = position.shape[:2]
    times = every * np.arange(frames)
    velocity = np.gradient(position, every, axis=0) if frames > 1 else 0 * position
    velocity = np.nan_to_num(velocity)
    mass = np.linspace(1, 2, n)
    scalars = dict.fromkeys(SCALARS, np.zeros((frames, n))) | (scalars or {})
    (folder / "snapshots").mkdir()
    write_arrays(
        folder / "snapshots" / "particles.npz",
        body=np.arange(n, dtype=np.uint8) % len(experiment.bodies),
        mass=mass.astype(np.float32),
        initial_volume=np.full(n, experiment.cell_size**experiment.dimension / 4, np.float32),
    )
    for k in range(frames):
        write_arrays(
            folder / "snapshots" / f"snapshot_{k:04d}.npz",
            time=np.float64(times[k]),
            step=np.int64(10 * k),
            position=position[k],
            velocity=velocity[k].astype(np.float32),
            **{name: np.asarray(values[k], np.float32) for name, values in scalars.items()},
        )
    kinetic = 0.5 * (mass * (velocity**2).sum(axis=2)).sum(axis=1)
    with (folder / "history.csv").open("w", newline="") as file:
        rows = csv.writer(file)
        parts = ("kinetic", "elastic", "dissipated", "gravitational")
        rows.writerow(["time", *(f"{part}_energy" for part in parts)])
        rows.writerows([t, e, 0.5 * t, 0.0, -t] for t, e in zip(times, kinetic, strict=True))
    return folder


def turning_disk(frames: int, n: int, rng, noise=0.0) -> np.ndarray:
    """Positions [frames, n, 2] of the particles, in random order, of a disk that turns and swells
    within the unit square; with as much white noise [m] as asked for."""
    radius, angle = 0.3 * np.sqrt(rng.random(n)), 2 * np.pi * rng.random(n)
    t = np.linspace(0, 1, frames)[:, None]
    r = radius * (1 + 0.2 * np.sin(3 * t + 9 * radius))
    x = np.stack([np.cos(angle + 2 * t), np.sin(angle + 2 * t)], axis=-1) * r[..., None] + 0.5
    return x + noise * rng.standard_normal(x.shape)
