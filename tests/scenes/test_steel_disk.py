"""A steel disk hits an aluminum target: code against code, with the law of the published one.

Problem: Sulsky, Zhou and Schreyer 1995; Sinaie et al. 2017, section 4.3 (MPM-Julia), and mpmat;
numbers read off frames of the published code to 0.2 mm (benchmarks.md 4.4)."""

from typing import Any, Literal

import numpy as np
import pytest
import taichi as ti

from mpm_taichi import Simulation, load_scene, runtime
from mpm_taichi.bases import Linear
from mpm_taichi.boundaries import Sticky, Wall
from mpm_taichi.materials import LinearElastic
from mpm_taichi.materials.accumulated_strain import AccumulatedStrain
from mpm_taichi.materials.invariants import volume_strain
from mpm_taichi.particles import BodyPoints
from mpm_taichi.solver import Solver
from mpm_taichi.transfers import FLIP
from tests.command_line import SCENES

LOWEST = {5: 39.8, 10: 35.6, 15: 32.0, 20: 29.1, 25: 27.0,
          30: 25.4, 35: 24.1, 40: 23.2, 45: 22.5, 48: 22.4}  # fmt: skip
"""Height of the lowest particle of the disk [mm] at times [us]."""

CELL, SPACING, STEP = 1.2e-3, 0.6e-3, 1e-8


class PlanarYield(AccumulatedStrain):
    """The law of the published code, in the plane alone, with small strain added up and not turned:
    dev = eps - tr eps / 2 I,  s = 2 mu (dev - eps_p),  |s| <= k;
    sigma = (lam + mu) tr eps I + s,  tau = J sigma.  Only its stress is used."""

    type: Literal["planar_yield"]
    strength: float

    def constants(self, cell_size: float) -> dict[str, float]:
        return super().constants(cell_size) | {"strength": self.strength}

    def state(self, dim: int) -> dict[str, Any]:
        return super().state(dim) | {"flow": [[0.0] * dim for _ in range(dim)]}

    def start(self, H: np.ndarray) -> dict[str, np.ndarray]:
        return super().start(H) | {"flow": np.zeros_like(H)}

    @staticmethod
    @ti.func
    def update(c, H, L, dt, s):
        s.strain += (0.5 * dt) * (L + L.transpose())
        pressing = 0.5 * s.strain.trace() * ti.Matrix.identity(float, 2)
        stress = 2.0 * c.mu * (s.strain - pressing - s.flow)
        excess = stress.norm() / c.strength - 1.0
        if excess > 0.0:
            stress /= 1.0 + excess
            s.flow += (0.5 * excess / c.mu) * stress
        sigma = 2.0 * (c.lam + c.mu) * pressing + stress
        return H, s, (1.0 + volume_strain(H)) * sigma


def lattice(center, counts, radius=np.inf):
    """Points center + (k + 1/2) spacing, within a radius."""
    ticks = [(np.arange(-(n // 2), n - n // 2) + 0.5 * (n % 2 == 0)) * SPACING for n in counts]
    x = np.stack(np.meshgrid(*ticks, indexing="ij"), axis=-1).reshape(-1, 2)
    return x[np.hypot(*x.T) < radius] + center


@pytest.mark.slow
@pytest.mark.parametrize(
    "end", [20, pytest.param(48, marks=pytest.mark.campaign)], ids=["20 us", "48 us"]
)
def test_published_law_at_the_published_times(end):
    """Hat functions, FLIP, MUSL, steps of 1e-8 s: each height within 0.3 mm of the table (seen
    0.13).  Another law or scheme is further off: standard J2 by 1.2 mm at 40 us, quadratic FLIP by
    2.3."""
    runtime.start("cpu", "f64", threads=1)
    steel = LinearElastic(
        type="linear_elastic", density=7850, youngs_modulus=200e9, poissons_ratio=0.3
    )
    aluminum: Any = PlanarYield(
        type="planar_yield", density=2700, youngs_modulus=78.2e9, poissons_ratio=0.3, strength=300e6
    )
    disk = lattice((0.03, 0.05), (16, 16), 4.8e-3)
    target = lattice((0.03, 0.02), (100, 67))
    assert (len(disk), len(target)) == (208, 6700)
    bodies = [
        BodyPoints(law, x, np.full_like(x, [0.0, v]), np.full(len(x), SPACING**2))
        for law, x, v in ((steel, disk, -1160.0), (aluminum, target, 0.0))
    ]
    walls = tuple(Wall(axis, upper, Sticky) for axis in (0, 1) for upper in (False, True))
    solver = Solver(bodies, (50, 50), CELL, Linear, FLIP, walls, (0, 0), stress_update="musl")
    solver.start(STEP)
    seen = {}
    for number in range(1, 100 * end + 1):
        solver.step((number - 1) * STEP, STEP, STEP)
        if number in (100 * t for t in LOWEST):
            lowest = 1e3 * solver.particles.to_numpy("x")[: len(disk), 1].min()
            seen[number // 100] = round(float(lowest), 3)
    print(seen)
    assert seen == pytest.approx({t: y for t, y in LOWEST.items() if t <= end}, abs=0.3)


@pytest.mark.slow
@pytest.mark.parametrize(
    "end", [8e-6, pytest.param(40e-6, marks=pytest.mark.campaign)], ids=["8 us", "40 us"]
)
def test_scene_bores_its_crater(end):
    """Standard J2 with automatic steps: while the disk is slowed down energy adds up within 5 %
    (seen 2.5 % at 40 us) and the target flows.  At 40 us another code of this scheme has the lowest
    particle at 22.02 mm, with steps of 1e-8 s and the disk 0.2 mm higher at the start: 0.3 mm."""
    changes = ["output.images=none", f"time.end={end}", "output.every=8e-6"]
    scene = load_scene(SCENES / "steel_disk.yaml", changes)
    simulation = Simulation(scene, threads=1)
    totals = [
        sum(now.sums[f"{kind}_energy"].sum() for kind in ("kinetic", "elastic", "dissipated"))
        for now in simulation.frames()
    ]
    here = simulation.snapshot
    disk = slice(*simulation.ranges[:2])
    lowest = 1e3 * here.position[disk, 1].min()
    gain = np.divide(totals, totals[0]) - 1
    print(f"lowest {lowest:.2f} mm, energy gained {gain.round(4)}")
    assert np.abs(gain).max() < 0.05
    assert here.plastic_strain[disk].max() == 0
    assert here.plastic_strain.max() > 1
    if end == 40e-6:
        assert lowest == pytest.approx(22.02, abs=0.3)
