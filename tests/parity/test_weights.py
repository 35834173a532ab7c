"""The weights that are shown, against the twin."""

import pytest

from mpm_taichi.kernels.weights import weights
from mpm_taichi.reference.kernels.weights import weights as twin_weights

from .states import build, largest_difference


@pytest.mark.parametrize("basis", ["CubicBoundary", "GIMP"])
def test_weights_equal_the_twin(exact, rng, basis):
    """At walls, and for particles of several sizes: the same stencils, weights and slopes, to a few
    rounding errors of numbers of the order of 1."""
    fast, twin = build(rng, 2, basis, "FLIP")
    ours = weights(fast.particles, fast.grid, fast.basis)
    theirs = twin_weights(twin.particles, twin.grid, twin.basis)
    assert (ours[0] == theirs[0]).all()
    assert largest_difference(ours[1], theirs[1]) < 1e-12
    assert largest_difference(ours[2], theirs[2]) < 1e-12
