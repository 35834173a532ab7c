"""Picture of the energy of a run: what it has, what it was given, and which stage has lost it."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from ..whole_files import beside

HAS = ("particle_kinetic_energy", "elastic_energy", "dissipated_energy")


def draw_ledger(path: Path, columns: Mapping[str, np.ndarray], title: str = "") -> None:
    """The columns of a history.csv that was written with output.audit, over time [s]."""
    from matplotlib.figure import Figure  # draws into a file; no display, no global state

    figure = Figure(figsize=(8, 8), layout="constrained")
    energies, losses = figure.subplots(2, 1, sharex=True)
    counted = [name for name in columns if name.startswith(("work_", "loss_"))]
    for name in HAS:
        energies.plot(columns["time"], columns[name], label=_words(name))
    for name in counted:
        if np.any(columns[name]):
            axes = energies if name.startswith("work_") else losses
            axes.plot(columns["time"], columns[name], "--", label=_words(name))
    losses.plot(columns["time"], columns["energy_residual"], "k", label="residual")
    energies.set(title=title, ylabel="energy [J]")
    losses.set(ylabel="lost since the start [J]", xlabel="time [s]")
    for axes in (energies, losses):
        axes.legend()
        axes.grid(alpha=0.25)
    with beside(path) as part:
        figure.savefig(part, dpi=150, format="png")


def _words(name):
    return name.removeprefix("particle_").removeprefix("loss_").replace("_", " ")
