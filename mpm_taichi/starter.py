"""The scene that `new` writes: short, every section explained, ready to run."""

from pathlib import Path

from . import gallery
from .errors import InputError

TEXT = """\
# {title}
#
# Say here what the scene shows, where it is from, and what to expect: a number, if there is one.
# Units are SI.  `python -m mpm_taichi check FILE` shows the plan, `python -m mpm_taichi FILE` runs
# it, `python -m mpm_taichi schema` prints all keys, for editors.
version: 1
title: {title}
source: made by `new`

# The box [0, size] and its grid; cells are {cubes}. Walls: none (particles may leave through open
# sides only by mistake: that stops the run), slip, sticky, separate, periodic, or a rule for each
# side, as {{left: slip, bottom: sticky}}.
domain: {{size: {size}, cells: {cells}, walls: slip}}

# basis: linear, gimp, quadratic, cubic; transfer: pic, flip, xpic, apic, tpic.  This is the
# default, and a good choice: quadratic B-splines, APIC in its MLS form.
method: {{basis: quadratic, transfer: {{type: apic, force: mls}}}}

# Simulated time [s]; step: auto takes half of the longest stable step (`safety: 0.5`), or give
# seconds.
time: {{end: 1.0, step: auto}}

gravity: {gravity}  # [m/s^2]

# By name: a law with its values, or a preset and what differs from it.
# `python -m mpm_taichi materials` lists laws and presets.
materials:
  soft: {{type: neo_hookean, density: 1000, youngs_modulus: 2.0e4, poissons_ratio: 0.3}}
  firm: {{preset: rubber, youngs_modulus: 1.0e5}}

# Shapes: ball, box, ring, cylinder.  Particles: lattice (per_cell along each axis, or spacing [m]),
# gmsh (size [m] of the elements), mesh (file: part.msh).  Velocity [m/s]: numbers, or formulas of
# X, Y, Z such as "0.5*sin(pi*X)".
bodies:
  - name: ball
    material: soft
    shape: {{type: ball, center: {center}, radius: 0.15}}
    particles: {{type: lattice, per_cell: 2}}
    velocity: {velocity}
  - name: block
    material: firm
    shape: {{type: box, min: {low}, max: {high}}}
    particles: {{type: lattice, per_cell: 2}}

# An output every 0.02 s; color_by: body, speed, pressure, stress, density, plastic_strain.  A row
# of history.csv (energies, momenta) every 10 steps.
output:
  every: 0.02
  images: {{color_by: body, size: 700}}
  history: {{every_steps: 10}}
"""

PARTS = {
    2: {
        "title": "A soft ball falls on a block", "cubes": "squares",
        "size": [1.0, 1.0], "cells": [32, 32], "gravity": [0, -9.81],
        "center": [0.45, 0.7], "velocity": [0.5, 0], "low": [0.3, 0.0], "high": [0.7, 0.2],
    },
    3: {
        "title": "A soft ball falls on a block in 3D", "cubes": "cubes",
        "size": [1.0, 1.0, 1.0], "cells": [20, 20, 20], "gravity": [0, -9.81, 0],
        "center": [0.45, 0.7, 0.5], "velocity": [0.5, 0, 0],
        "low": [0.3, 0.0, 0.3], "high": [0.7, 0.2, 0.7],
    },
}  # fmt: skip
"""What depends on the dimension."""


def write_new(path: Path, dimension: int, like: str | None) -> None:
    """A new file; InputError where one is there already, or cannot be."""
    if path.suffix not in (".yaml", ".yml"):
        raise InputError(f"{path}: a scene file ends in .yaml: say {path.name}.yaml")
    if like is None:
        text = TEXT.format(**PARTS[dimension])
    else:
        text = gallery.find(like).read_text(encoding="utf-8")
    try:
        with path.open("x", encoding="utf-8") as file:
            file.write(text)
    except FileExistsError:
        raise InputError(f"{path}: is there already, and is left as it is; name another") from None
    except FileNotFoundError:
        raise InputError(f"{path}: there is no folder {path.parent}; make it first") from None
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {error.strerror}") from None
