"""Scenes of hard cases: cells of edge 1, density 1, wave speed 1, unless a case says otherwise."""

from collections.abc import Iterable
from typing import Any

import numpy as np
from experiments import Scheme

from mpm_taichi import Simulation
from mpm_taichi.scene import Scene


def solid(poissons_ratio: float = 0.3, wave_speed: float = 1.0) -> dict[str, Any]:
    """P = 2 mu (F - R) + lam (J - 1) J F^-T: with nu = 0 and one axis, P = E (F - 1)."""
    nu = poissons_ratio
    E = wave_speed**2 * (1 + nu) * (1 - 2 * nu) / (1 - nu)
    return {"type": "fixed_corotated", "density": 1, "youngs_modulus": E, "poissons_ratio": nu}


def body(name, low, high, per_cell: int = 2, **keys) -> dict[str, Any]:
    """A box of lattice particles, of the material `solid`."""
    shape = {"type": "box", "min": [float(a) for a in low], "max": [float(a) for a in high]}
    particles = {"type": "lattice", "per_cell": per_cell}
    made = {"name": f"{name}", "material": "solid", "shape": shape, "particles": particles}
    return made | keys


SIDES = (("left", "right"), ("bottom", "top"), ("back", "front"))


def strip(length: int, axis: int, dim: int, **walls: str) -> tuple[list[int], dict[str, Any]]:
    """Cells and `domain` of a strip one cell wide that closes on itself across `axis`: what is the
    same all across it moves as in 1D."""
    cells = [1] * dim
    cells[axis] = length
    across = (side for other in range(dim) if other != axis for side in SIDES[other])
    return cells, {"walls": dict.fromkeys(across, "periodic") | walls}


def along(axis: int, dim: int, value: Any, other: float = 0.0) -> list[Any]:
    """A vector that has `value` along one axis and `other` along the rest."""
    return [value if d == axis else other for d in range(dim)]


def vector(values: Iterable[Any]) -> list[str]:
    """Numbers or formulas as a scene takes them."""
    return [value if isinstance(value, str) else repr(float(value)) for value in values]


def simulate(scheme: Scheme, cells, bodies, material, end, **sections) -> Simulation:
    """From t = 0 to `end`, one thread; outputs are those of `sections`, by default 100."""
    content = {
        "version": 1,
        "domain": {"size": [float(n) for n in cells], "cells": [int(n) for n in cells]},
        "method": scheme.method,
        "time": {"end": float(end)},
        "materials": {"solid": material},
        "bodies": bodies,
        "output": {"images": "none"},
    }
    for name, section in sections.items():
        content[name] = content.get(name, {}) | section if isinstance(section, dict) else section
    return Simulation(Scene.model_validate(content), precision=scheme.precision, threads=1)


def clamps(simulation: Simulation) -> dict[str, int]:
    """What was clamped, cut off or taken away, and how often."""
    found = simulation.warnings()
    told = ("steps ", "nodes too light ", "particles stretched so far ")
    return {words: count for words, count in found.items() if not words.startswith(told)}


def by_body(simulation: Simulation, values: np.ndarray) -> np.ndarray:
    """Sums over the particles of each body."""
    return np.add.reduceat(values, simulation.ranges[:-1])


def energies(simulation: Simulation) -> tuple[np.ndarray, np.ndarray]:
    """Of each body: kinetic, without that of its center of mass, and elastic."""
    now = simulation.snapshot
    mass = by_body(simulation, now.mass)[:, None]
    momentum = by_body(simulation, now.mass[:, None] * now.velocity)
    whole = 0.5 * by_body(simulation, now.mass * (now.velocity**2).sum(axis=1))
    riding = 0.5 * (momentum**2 / mass).sum(axis=1)
    return whole - riding, by_body(simulation, now.initial_volume * now.energy_density)
