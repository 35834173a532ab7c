"""Where momentum and energy of a run come from and go, from what its tally has added up.

    K - K_0 + E - E_0 = work of gravity, body force and walls
                        - losses of P2G, time integration, G2P and the mass cut-off + residual

K is the kinetic energy of the particles with that of their affine motion, E what the laws store and
have lost.  P2G loses what particles have and nodes have not, G2P what nodes have and particles have
not.  With an increment (FLIP) particles keep motion that nodes do not see, so that these two are
one row.  Time integration loses the work of stress and loads less what the nodes gain by it; where
the stress works at other velocities than those of the grid update (MUSL, USF) it cannot be told
from the rest.  Each of these is counted by itself, and `energy_residual` is what the laws store and
lose beyond the work of the stress: the rest is an identity."""

import numpy as np


def begin_ledger(solver, sums) -> None:
    """After `solver.start`: the energies that the ledger starts with."""
    solver.tally.start = list(_energies(solver.tally.totals(), sums))


def ledger(solver, sums) -> dict[str, float]:
    """Columns of history.csv [kg m/s, kg m^2/s, J], from the start of the run on."""
    tally, totals = solver.tally, solver.tally.totals()
    g, axes = np.array(solver.gravity.to_numpy(), float), "xyz"[: solver.grid.dim]
    turning = ("",) if len(axes) == 2 else ("_x", "_y", "_z")

    def vector(name, width):
        return totals.get(name, np.zeros(width))

    columns = {}
    for name, of in (
        ("wall_impulse", "impulse"),
        ("body_impulse", "push"),
        ("cut_impulse", "lost"),
    ):
        columns |= _components(f"{name}_", axes, vector(of, len(axes)))
    for name, values in (
        ("wall_turn", vector("turn", len(turning))),
        ("body_turn", vector("twist", len(turning))),
        ("gravity_turn", _axial(vector("moment", len(axes)), g)),
    ):
        columns |= _components(name, turning, values)
    rows = _energy_rows(tally, totals, _energies(totals, sums), vector("path", len(axes)) @ g)
    if solver.stress_update != "usl":
        rows = _as_one(rows, "loss_transfers_and_time_integration")
    columns |= rows
    return {name: float(value) for name, value in columns.items()}


def _energies(totals, sums):
    """Kinetic, stored and lost."""
    affine = totals.get("kinetic")
    kinetic = sums["kinetic_energy"].sum() if affine is None else affine[0]
    stored, lost = sums["elastic_energy"].sum(), sums["dissipated_energy"].sum()
    return float(kinetic), float(stored), float(lost)


def _energy_rows(tally, totals, now, fallen):
    kinetic, *of_laws = now
    gained = sum(of_laws) - sum(tally.start[1:])
    images = totals.get("images", [0.0])[0]
    pushed = totals.get("pushing", [0.0])[0]
    given, held, end, cut, work = (totals[n][0] for n in ("given", "held", "end", "cut", "work"))
    rows = {
        "particle_kinetic_energy": kinetic,
        "work_of_gravity": fallen,
        "work_of_body_force": pushed,
        "work_of_walls": held + cut - given + images,
    }
    if tally.increment:
        rows["loss_transfers"] = tally.start[0] - kinetic + end + images - given
    else:
        before = tally.start[0] + totals["kinetics"][0] - kinetic
        rows["loss_p2g"] = before - given
        rows["loss_g2p"] = end + images - totals["kinetics"][0]
    rows["loss_time_integration"] = fallen + pushed - work - (end - held)
    rows["loss_cut_off"] = cut
    rows["energy_residual"] = gained - work
    return rows


def _as_one(rows, name):
    """The losses of the stages added up under one name; that of the cut-off is left."""
    stages = [row for row in rows if row.startswith("loss_") and row != "loss_cut_off"]
    together = {name: sum(map(rows.pop, stages))}
    return rows | together


def _components(name, axes, values):
    return {f"{name}{axis}": value for axis, value in zip(axes, values, strict=True)}


def _axial(a, b):
    """The components of a x b that the dimension has."""
    if len(a) == 2:
        return np.array([a[0] * b[1] - a[1] * b[0]])
    return np.cross(a, b)
