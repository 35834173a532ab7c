"""Picture of stress against strain."""

from collections.abc import Iterable, Mapping
from pathlib import Path

import numpy as np

from ..whole_files import beside
from .units import prefix


def draw_stress_strain(
    path: Path, title: str, panels: Iterable[tuple[str, np.ndarray, Mapping[str, np.ndarray]]]
) -> None:
    """Panels of a name, strain s [4 k + 1] and stresses [4 k + 1] (Pa) by component, s going from 0
    to one side and back, then to the other and back: solid away from 0, dashed back."""
    from matplotlib.figure import Figure  # draws into a file; no display, no global state

    panels = list(panels)
    columns = min(2, len(panels))
    rows = -(-len(panels) // columns)
    figure = Figure(figsize=(3.5 + 3.75 * columns, 3.8 * rows + 0.7), layout="constrained")
    figure.suptitle(title, fontsize="medium")
    grid = figure.subplots(rows, columns, squeeze=False)
    for axes, (name, strain, stresses) in zip(grid.flat, panels, strict=True):
        factor, unit = prefix(max(np.abs(stress).max() for stress in stresses.values()))
        quarter = len(strain) // 4
        for number, (label, stress) in enumerate(_merged(stresses).items()):
            for leg in range(4):
                part = slice(leg * quarter, (leg + 1) * quarter + 1)
                axes.plot(
                    strain[part], stress[part] / factor, color=f"C{number}", lw=1.5,
                    ls="-" if leg % 2 == 0 else (0, (4, 2)), label=label if leg == 0 else None,
                )  # fmt: skip
        axes.set_title(name, fontsize="medium")
        axes.set_xlabel("strain s")
        axes.set_ylabel(f"Cauchy stress [{unit}Pa]")
        axes.locator_params(axis="x", nbins=7)
        axes.grid(alpha=0.25)
        axes.legend(framealpha=0.5)
    with beside(path) as part:
        figure.savefig(part, dpi=150, format="png")


def _merged(stresses: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Those within 1 % of the largest under one label, `yy, zz`; none that is 0 beside others."""
    scale = max(np.abs(stress).max() for stress in stresses.values())
    alike: list[list[str]] = []
    for label, stress in stresses.items():
        if scale == 0 or np.abs(stress).max() > 0:
            near = (k for k in alike if np.abs(stress - stresses[k[0]]).max() <= 0.01 * scale)
            mine = next(near, None)
            if mine is None:
                alike.append(mine := [])
            mine.append(label)
    return {", ".join(labels): stresses[labels[0]] for labels in alike}
