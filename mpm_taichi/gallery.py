"""The gallery: the scenes beside the package, each a documented experiment."""

from pathlib import Path

from .catalogue import unbroken, wrapped
from .errors import InputError
from .scene import Scene, load_scene
from .scene.wording import suggestion
from .seeding import expected_counts

FOLDER = Path(__file__).parents[1] / "scenes"
"""Of a clone of the repository; an installed package has none."""


def scene_files() -> list[Path]:
    """In the order of their names.  InputError where there is no gallery."""
    files = sorted(FOLDER.glob("*.yaml"))
    if not files:
        raise InputError(
            f"the gallery is not here ({FOLDER}): it is the folder `scenes` of the repository, and "
            "this package was installed without it. Clone the repository, or begin with "
            "`python -m mpm_taichi new NAME.yaml`"
        )
    return files


def find(name: str) -> Path:
    """A scene by its name in the gallery, or by its path.  InputError where there is none."""
    if Path(name).is_file():
        return Path(name)
    files = {path.stem: path for path in scene_files()}
    if Path(name).stem in files and Path(name).parent == Path():
        return files[Path(name).stem]
    raise InputError(
        f"{name}: no such file, and no such scene in the gallery"
        + (suggestion(name, files) or f"; there are {', '.join(files)}")
    )


def describe(path: Path) -> str:
    """Name and title; how large it is and where it is from."""
    scene = load_scene(path)
    facts = wrapped(unbroken([_extent(scene), scene.source]), indent=2)
    return f"{path.stem}: {scene.title}\n{facts}"


def _extent(scene: Scene) -> str:
    """`2D, about 420 particles, 20 x 20 cells`: the number of a mesh is known when it is made."""
    counts = expected_counts(scene)
    about = float(f"{sum(counts):.2g}")
    particles = f"about {about:,.0f} particles" if all(counts) else "meshed bodies"
    return f"{scene.dimension}D, {particles}, {' x '.join(map(str, scene.domain.cells))} cells"
