"""A small valid scene, from which the tests make others."""

TEXT = """\
version: 1
title: Two disks
domain: {size: [1.0, 2.0], cells: [20, 40], walls: {left: slip, top: sticky}}
method:
  basis: linear
  transfer: {type: flip}
time: {end: 3.5, step: 1.0e-3}
gravity: [0, -9.81]
materials:
  rubber: {type: linear_elastic, density: 1000, youngs_modulus: 1E6, poissons_ratio: 0.3}
  soft:
    type: neo_hookean
    density: 1e3
    youngs_modulus: 1000
    poissons_ratio: 0.3
bodies:
  - name: lower
    material: rubber
    shape: {type: ball, center: [0.2, 0.2], radius: 0.2}
    particles: {type: lattice, per_cell: 2}
    velocity: [0.1, 0.1]
  - name: upper
    material: soft
    shape: {type: box, min: [0.5, 1], max: [1, 2]}
    particles: {type: gmsh, size: 0.03}
output: {every: 0.05, images: {color_by: speed}}
"""


def changed(old: str, new: str) -> str:
    """The text with one passage replaced."""
    assert TEXT.count(old) == 1, old
    return TEXT.replace(old, new)
