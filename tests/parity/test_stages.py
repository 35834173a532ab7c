"""Every stage and whole steps: the fast form against the twin, f64 with fast-math off.

Both add the same terms in another order, so they differ by a few rounding errors of the largest
term: 1e-12 of the field's largest value leaves room for about a thousand of them."""

from itertools import pairwise

import numpy as np
import pytest

from mpm_taichi.kernels import (
    clear,
    evaluate,
    g2p,
    grid_update,
    p2g,
    sort,
    update_stress,
)  # fmt: skip
from mpm_taichi.reference.kernels import (
    clear as twin_clear,
)  # fmt: skip
from mpm_taichi.reference.kernels import (
    evaluate as twin_evaluate,
)
from mpm_taichi.reference.kernels import (
    g2p as twin_g2p,
)
from mpm_taichi.reference.kernels import (
    grid_update as twin_grid_update,
)
from mpm_taichi.reference.kernels import (
    p2g as twin_p2g,
)
from mpm_taichi.reference.kernels import (
    update_stress as twin_update_stress,
)

from ..cases import CASES
from .states import build, largest_difference, nodes, particle_fields

TOLERANCE = 1e-12
DT = 2.5e-4


@pytest.mark.parametrize(("dim", "basis", "transfer"), CASES)
def test_steps_and_stages_equal_the_twin(exact, rng, dim, basis, transfer):
    """Three steps of unequal length, then one compared after each stage."""
    fast, twin = build(rng, dim, basis.__name__, transfer.__name__)
    lengths = DT * (0.5 + rng.random(4))
    for solver in (fast, twin):
        solver.start(lengths[0])
        for dt, dt_next in pairwise(lengths):
            assert solver.step(dt, lambda speed, dt_next=dt_next: dt_next) == dt_next
    dt = lengths[-1]
    P, G, Q, N = fast.particles, fast.grid, twin.particles, twin.grid
    lanes = list(range(dim))

    sort.sort(P, G, fast.basis)
    for name, (ours, theirs) in particle_fields(fast, twin).items():
        assert largest_difference(ours, theirs) < TOLERANCE, f"{name} after three steps and a sort"

    clear.clear(G)
    twin_clear.clear(N)
    p2g.p2g(P, G, fast.basis, fast.transfer)
    twin_p2g.p2g(Q, N, twin.basis, twin.transfer)
    momentum, impulse = nodes(G, lanes)
    assert largest_difference(nodes(G, dim)[0], N.m) < TOLERANCE
    assert largest_difference(momentum + impulse, N.mv + N.impulse) < TOLERANCE

    grid_update.grid_update(G, fast.walls, fast.gravity, dt)
    twin_grid_update.grid_update(N, twin.walls, twin.gravity, dt)
    v, increment = nodes(G, lanes)
    assert largest_difference(v, N.v) < TOLERANCE
    if fast.transfer.increment:
        assert largest_difference(increment, N.v - N.v_old) < TOLERANCE
    assert G.speed_squared[None] == pytest.approx(N.speed_squared, rel=TOLERANCE)
    assert G.cut[None] == N.cut

    g2p.g2p(P, G, fast.basis, fast.transfer)
    twin_g2p.g2p(Q, N, twin.basis, twin.transfer)
    v_pic = P.to_numpy("rows")[:, P.layout.pic, :dim]
    assert largest_difference(v_pic, Q.v_pic) < TOLERANCE

    for group, twin_group in zip(P.groups, Q.groups, strict=True):
        update_stress.update_stress(P, group, G, fast.transfer, dt, 0.7 * dt)
        twin_update_stress.update_stress(Q, twin_group, N, twin.transfer, dt, 0.7 * dt)
    for name, (ours, theirs) in particle_fields(fast, twin).items():
        assert largest_difference(ours, theirs) < TOLERANCE, name

    shown = twin_evaluate.evaluate(Q, N)
    for name, ours in evaluate.evaluate(P, G).items():
        assert largest_difference(ours, shown[name]) < TOLERANCE, name
    assert P.lost[None] == Q.lost
    assert np.isfinite(P.to_numpy("x")).all()
