"""The command `curve`: stress against strain of one material, as a picture and a table."""

import csv
from collections.abc import Sequence
from importlib.util import find_spec
from itertools import count
from pathlib import Path

import numpy as np

from . import runtime
from .catalogue import LAWS, NAMES, constants, unbroken, wrapped
from .element import PATHS, Elements, Response, cycle, deformation
from .errors import InputError
from .materials import Material
from .materials.presets import PRESETS
from .scene import load_material, load_scene
from .scene.wording import suggestion
from .whole_files import beside

COMPONENTS = {"xx": (0, 0), "yy": (1, 1), "zz": (2, 2), "xy": (0, 1)}
"""The others vanish on every path."""

ROUNDING = 1e-15
"""Stress that a picture shows as 0, of the modulus rho c^2."""


def curve(options) -> int:
    """Lead the material of `options.what` along its paths; picture and table beside each other."""
    if find_spec("matplotlib") is None:
        raise InputError('curve draws with matplotlib: pip install "matplotlib>=3.8"')
    material, origin = material_of(options.what, options.set)
    picture = _picture_path(options.output, options.overwrite, options.what)
    runtime.start("cpu", "f64")
    paths = [options.path] if options.path else list(PATHS)
    elements = Elements(material, options.dim, len(paths))
    strain = options.strain or min(0.3, 4 * (elements.first_flow(options.compression) or 1))
    s = cycle(strain)
    F = np.stack([deformation(path, s, options.dim) for path in paths], axis=1)
    found = elements.lead(F, abs(s[1]) / options.rate, options.compression)
    said = f"{material.type}, {origin}: {unbroken(constants(material))}"
    how = f"strain {strain:.3g} at {options.rate:g} /s, {options.dim}D"
    how += f", after a volumetric compression of {options.compression:g}" * bool(
        options.compression
    )
    try:
        picture.parent.mkdir(parents=True, exist_ok=True)
        _write_table(picture.with_suffix(".csv"), paths, s, found)
        sigma = found.cauchy_stress.copy()
        sigma[np.abs(sigma) < ROUNDING * material.density * material.wave_speed() ** 2] = 0
        _draw(picture, f"{wrapped(said, 90)}\n{how}", paths, s, sigma)
    except OSError as failure:
        raise InputError(f"{picture}: cannot be written: {failure}") from None
    print(f"{wrapped(said)}\n{', '.join(paths)}: {how}")
    for path in np.array(paths)[~sigma.any(axis=(0, 2, 3))]:
        print(f"{path}: no stress at all; --compression 0.01 has the material compressed before")
    print(f"picture: {picture}\ntable:   {picture.with_suffix('.csv')}")
    return 0


def material_of(word: str, changes: Sequence[str]) -> tuple[Material, str]:
    """The material of a preset, a law (with the constants of a preset) or a scene, such as
    scenes/two_disks.yaml:rubber, with `youngs_modulus=1e5` and the like in place of its values; and
    where its constants are from."""
    if word.endswith((".yaml", ".yml")) or ".yaml:" in word or ".yml:" in word:
        return _of_scene(word, changes), f"of {word}"
    if word in PRESETS:
        return load_material({"preset": word}, changes), f"preset {word}"
    if word in LAWS:
        values, name = _borrowed(word)
        return load_material(values, changes), f"constants of preset {name}"
    hint = suggestion(word, NAMES) or f"; there are {', '.join(NAMES)}, and SCENE.yaml:MATERIAL"
    raise InputError(f"no law or preset is named {word!r}{hint}")


def _of_scene(word: str, changes: Sequence[str]) -> Material:
    file, _, name = (word, "", "") if word.endswith((".yaml", ".yml")) else word.rpartition(":")
    known = list(load_scene(file).materials)
    if not name and len(known) == 1:
        name = known[0]
    if name not in known:
        said = f"no material is named {name!r}" if name else f"there are {len(known)} materials"
        raise InputError(f"{file}: {said}: say {' or '.join(f'{file}:{key}' for key in known)}")
    return load_scene(file, [f"materials.{name}.{change}" for change in changes]).materials[name]


def _borrowed(law: str) -> tuple[dict, str]:
    """Values for a law: those of its first preset, or of the first that has all it requires."""
    needed = {key for key, field in LAWS[law].model_fields.items() if field.is_required()}
    own = [name for name, preset in PRESETS.items() if preset.material.type == law]
    fit = [name for name, preset in PRESETS.items() if needed <= set(dict(preset.material))]
    name = (own + fit)[0]
    values = dict(PRESETS[name].material)
    return {key: values[key] for key in LAWS[law].model_fields if key in values} | {
        "type": law
    }, name


def _picture_path(wanted: Path | None, overwrite: bool, what: str) -> Path:
    """`wanted`, or the first free one of runs/curve-<what>-001.png, -002, ..."""
    if wanted is None:
        if overwrite:
            raise InputError("--overwrite: is for -o FILE.png, which names a picture")
        name = Path(what).name.replace(".yaml", "").replace(":", "-")
        numbered = (Path("runs") / f"curve-{name}-{number:03d}.png" for number in count(1))
        return next(path for path in numbered if not _taken(path))
    if wanted.suffix != ".png":
        raise InputError(f"-o {wanted}: the picture is a .png file, and a .csv file beside it")
    if _taken(wanted) and not overwrite:
        raise InputError(
            f"-o {wanted}: it is there already, or the .csv beside it; name another file, or add "
            "--overwrite"
        )
    return wanted


def _taken(picture: Path) -> bool:
    return picture.exists() or picture.with_suffix(".csv").exists()


def _write_table(path: Path, paths: list[str], s: np.ndarray, found: Response) -> None:
    """SI units; a row for each strain of each path."""
    scalars = ("volume_ratio", "plastic_strain", "energy_density", "dissipated_energy")
    with beside(path) as part, part.open("w", newline="") as file:
        table = csv.writer(file)
        table.writerow(["path", "strain", *(f"stress_{key}" for key in COMPONENTS), *scalars])
        for number, name in enumerate(paths):
            stresses = [found.cauchy_stress[:, number, i, j] for i, j in COMPONENTS.values()]
            others = [getattr(found, scalar)[:, number] for scalar in scalars]
            for row in np.stack([s, *stresses, *others], axis=1).tolist():
                table.writerow([name, *row])


def _draw(picture: Path, title: str, paths: list[str], s: np.ndarray, sigma: np.ndarray) -> None:
    from .renderers.stress_strain import draw_stress_strain  # with Pillow, and only now

    panels = [
        (
            f"{name}: {PATHS[name]}",
            s,
            {key: sigma[:, number, i, j] for key, (i, j) in COMPONENTS.items()},
        )
        for number, name in enumerate(paths)
    ]
    draw_stress_strain(picture, title, panels)
