"""The books of a run, closed at its end: what it should have kept, what it was given, what is
missing.

A line passes where the residual is within its bound.  Rounding: n steps add n k u, k being the
contributions to a node and u the rounding error of a number, to a scale that nothing in the sum
exceeds, sqrt(2 m (K + E)) >= sum m |v| (numerics.md, chapter 6).  Energy: 1 % of the largest sum of
kinetic, stored and lost energy.  A line without a bound is reported, with the reason."""

from typing import NamedTuple

import numpy as np

from .history_table import read_history

MASS_BOUND, ENERGY_BOUND = 1e-12, 0.01
"""Of mass and energy scale: particles keep their masses."""

WORK = ("work_of_gravity", "work_of_body_force", "work_of_walls")


class Line(NamedTuple):
    """`supplied` and the `residual` = end - start - supplied are in the unit of `start`; `bound` is
    None where the line is only reported, for the reason in `note`."""

    name: str
    start: float
    end: float
    supplied: float
    residual: float
    scale: float
    bound: float | None
    note: str = ""

    @property
    def verdict(self) -> str:
        if self.bound is None:
            return "reported"
        return "PASS" if abs(self.residual) <= self.bound else "FAIL"

    def describe(self) -> str:
        unit = self.scale or 1.0
        bound = "" if self.bound is None else f", at most {self.bound / unit:.1e}"
        note = f" ({self.note})" if self.note else ""
        return (
            f"{self.verdict:8} {self.name}: {self.start:.6g} -> {self.end:.6g}, supplied "
            f"{self.supplied:.6g}, residual {abs(self.residual) / unit:.1e} of the scale"
            f"{bound}{note}"
        )


def audit(simulation, history_path) -> list[Line]:
    """Of a run whose history.csv is on the disk; nothing where that has no row."""
    columns = read_history(history_path)
    if not len(columns.get("time", ())):
        return []
    first, last = ({name: values[k] for name, values in columns.items()} for k in (0, -1))
    books = Books(simulation, first, last, columns)
    return [
        books.mass(), *books.momentum(), *books.angular_momentum(), books.volume(), books.energy(),
    ]  # fmt: skip


def describe(lines: list[Line]) -> str:
    """One line if all is well, else those that fail too."""
    count = {word: sum(line.verdict == word for line in lines) for word in ("PASS", "FAIL")}
    reported = [line.name for line in lines if line.verdict == "reported"]
    told = f"; reported: {', '.join(reported)}" if reported else ""
    text = f"audit: {count['PASS']} lines pass, {count['FAIL']} fail{told}"
    return "\n".join([text, *(line.describe() for line in lines if line.verdict == "FAIL")])


def summary(lines: list[Line]) -> list[dict]:
    """For run.json."""
    return [line._asdict() | {"verdict": line.verdict} for line in lines]


class Books:
    """First and last row of the history and all columns of it."""

    def __init__(self, simulation, first, last, columns):
        self.simulation, self.scene = simulation, simulation.scene
        self.first, self.last, self.columns = first, last, columns
        self.transfer, self.basis = simulation.solver.transfer, simulation.solver.basis
        self.is_audited = self.scene.output.audit
        self.brought_in = simulation.solver.particles.brought_in[None]
        self.axes = "xyz"[: self.scene.dimension]
        kinetic = columns["kinetic_energy"]
        self.energy_scale = float(
            (kinetic + columns["elastic_energy"] + columns["dissipated_energy"]).max()
        )
        stored = float((kinetic + columns["elastic_energy"]).max())
        self.momentum_scale = float(np.sqrt(2 * first["mass"] * max(stored, 0.0)))

    @property
    def rounding(self) -> float:
        """n k u."""
        volume = self.simulation.solver.particles.to_numpy("V0").min()
        crowd = max(1.0, self.scene.cell_size**self.scene.dimension / volume)
        k = crowd * self.basis.support**self.scene.dimension
        u = np.finfo(self.simulation.solver.particles.dtype).eps / 2
        return max(1, self.simulation.step_count) * k * u

    def line(self, name, start, end, supplied, scale, bound, note="") -> Line:
        return Line(name, start, end, supplied, end - start - supplied, scale, bound, note)

    def mass(self) -> Line:
        """Supplied is what was deleted at the border of the domain."""
        start, deleted = float(self.first["mass"]), self._change("mass")
        now = float(self.simulation.solver.particles.to_numpy("m").sum())
        return self.line("mass", start, now, deleted, start, MASS_BOUND * start)

    def momentum(self) -> list[Line]:
        return [self._momentum(d, axis) for d, axis in enumerate(self.axes)]

    def _momentum(self, d, axis) -> Line:
        name, time = f"momentum_{axis}", self.last["time"] - self.first["time"]
        supplied = self.first["mass"] * self.scene.gravity_vector[d] * time
        note, scale = self._taken_out(), self.momentum_scale + abs(supplied)
        if self.is_audited:
            parts = {n: self._change(f"{n}_{axis}") for n in ("wall_impulse", "body_impulse")}
            supplied += sum(parts.values()) - self._change(f"cut_impulse_{axis}")
            scale += sum(map(abs, parts.values()))
            if self.transfer.filtered and self.scene.domain.rules:
                note = "what the filter of XPIC takes at walls is not counted"
        elif self.scene.domain.rules or self.scene.body_force:
            note = "impulses of walls and body force are counted with output.audit: true"
        bound = None if note else self.rounding * scale
        return self.line(name, self.first[name], self.last[name], supplied, scale, bound, note)

    def angular_momentum(self) -> list[Line]:
        turning = ("",) if len(self.axes) == 2 else ("_x", "_y", "_z")
        note, size = self._why_not_turning(), float(np.linalg.norm(self.scene.domain.size))
        lines = []
        for axis in turning:
            name = f"angular_momentum{axis}"
            parts = [0.0]
            if self.is_audited:
                parts = [self._change(f"{n}_turn{axis}") for n in ("wall", "body", "gravity")]
            scale = self.momentum_scale * size + sum(map(abs, parts))
            bound = None if note else self.rounding * scale
            start, end = self.first[name], self.last[name]
            lines.append(self.line(name, start, end, sum(parts), scale, bound, note))
        return lines

    def _why_not_turning(self) -> str:
        """Why angular momentum is only reported; nothing where it is kept."""
        scene = self.scene
        forces = scene.domain.rules or scene.body_force or any(scene.gravity_vector)
        if self.brought_in:
            return self._taken_out()
        if not self.transfer.moments:
            return f"{scene.method.transfer.type} does not keep it"
        if scene.domain.periodic:
            return "has no meaning across a periodic axis"
        if self.simulation.solver.grid.cut[None]:
            return "the moment of what the mass cut-off takes is not counted"
        if forces and not self.is_audited:
            return "moments of walls, body force and gravity are counted with output.audit: true"
        return ""

    def volume(self) -> Line:
        now = self.simulation.snapshot
        end = float(now.initial_volume @ now.volume_ratio)
        start = self.simulation.start_volume
        return self.line("volume", start, end, 0.0, start, None, "matter may change its volume")

    def energy(self) -> Line:
        if not self.is_audited:
            parts = ("kinetic", "elastic", "dissipated", "gravitational")
            start, end = (
                sum(row[f"{part}_energy"] for part in parts) for row in (self.first, self.last)
            )
            note = "works and losses are counted with output.audit: true"
            return self.line("energy", start, end, 0.0, self.energy_scale, None, note)
        start, end = (
            row["particle_kinetic_energy"] + row["elastic_energy"] + row["dissipated_energy"]
            for row in (self.first, self.last)
        )
        losses = {n: self._change(n) for n in self.columns if n.startswith("loss_")}
        supplied = sum(map(self._change, WORK)) - sum(losses.values())
        fallen = np.ptp(self.columns["work_of_gravity"] + self.columns["work_of_body_force"])
        scale = max(self.energy_scale, float(fallen))
        told = ", ".join(
            f"{n.removeprefix('loss_').replace('_', ' ')} {value / scale:.2%}"
            for n, value in losses.items()
            if scale
        )
        bound = None if self.brought_in else ENERGY_BOUND * scale
        note = f"losses: {told}" if bound else self._taken_out()
        return self.line("energy", start, end, supplied, scale, bound, note)

    def _taken_out(self) -> str:
        if not self.brought_in:
            return ""
        return f"what particles lost at the border of the domain ({self.brought_in}) is not counted"

    def _change(self, name) -> float:
        return float(self.last[name] - self.first[name])
