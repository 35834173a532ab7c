"""A scene at successive resolutions: the same experiment with cells of half the size."""

from collections.abc import Iterator

from pydantic import ValidationError

from .errors import InputError
from .expressions import Expressions
from .meshes import MeshFile
from .model import Model
from .scene import Scene
from .scene.messages import messages
from .scene.wording import path_text
from .shapes.box import Box


def strips(domain) -> tuple[int, ...]:
    """The periodic axes with one cell: what happens does not depend on their coordinate."""
    return tuple(axis for axis in domain.periodic if domain.cells[axis] == 1)


def refined(scene: Scene, level: int) -> Scene:
    """The scene with cells of 2^-level the size, and no pictures.

    Particles per cell, dt/dx and outputs stay.  An axis of `strips` keeps its one cell and gets
    thinner, and the bodies with it.  InputError where that is not possible: see `refuse`."""
    content, part, thin = scene.model_dump(), 0.5**level, strips(scene.domain)
    domain = content["domain"]
    for axis in range(scene.dimension):
        if axis in thin:
            domain["size"][axis] *= part
        else:
            domain["cells"][axis] *= 2**level
    if scene.time.step != "auto":
        content["time"]["step"] *= part
    content["output"]["images"] = "none"
    for body in content["bodies"]:
        for key in {"spacing", "size"} & body["particles"].keys():
            if body["particles"][key] is not None:
                body["particles"][key] *= part
        for axis in thin:
            for corner in ("min", "max"):
                body["shape"][corner][axis] *= part
    try:
        return Scene.model_validate(content)
    except ValidationError as error:
        found = messages(error.errors(include_url=False), content)
        text = "; ".join(f"{path_text(path)} {sentence}" for path, sentence in found)
        raise InputError(f"at level {level} of the refinement: {text}") from None


def refuse(scene: Scene) -> None:
    """InputError with all that keeps a scene from being refined."""
    if faults := list(_faults(scene)):
        raise InputError("\n".join(f"converge: {place}: {text}" for place, text in faults))


def _faults(scene: Scene) -> Iterator[tuple[str, str]]:
    thin = strips(scene.domain)
    if len(thin) == scene.dimension:
        yield "domain.cells", "no axis is left to refine: all are periodic with one cell"
    for number, body in enumerate(scene.bodies):
        if isinstance(body.particles, MeshFile):
            yield (
                f"bodies[{number}].particles ({body.name})",
                "a mesh file has one resolution: take type gmsh or lattice",
            )
        elif thin and not isinstance(body.shape, Box):
            axes = ", ".join("xyz"[axis] for axis in thin)
            yield (
                f"bodies[{number}].shape ({body.name})",
                f"along {axes}, periodic with one cell, the domain gets thinner with the cells, "
                "and of all shapes only a box can follow it",
            )
    for place, entries in _fields(scene):
        names = {name for axis in thin for name in ("XYZ"[axis], "xyz"[axis])}
        field = Expressions(entries, scene.definitions, dim=scene.dimension)
        if used := sorted(field.variables & names):
            yield (
                place,
                f"uses {', '.join(used)}, along which the domain is periodic with one cell: it "
                "gets thinner with the cells, so nothing may depend on the place there",
            )


def _fields(scene: Scene) -> Iterator[tuple[str, list]]:
    """All formulas of a scene that are fields of a place."""
    holders: list[tuple[str, Model, tuple[str, ...]]] = [("", scene, ("body_force",))]
    for number, body in enumerate(scene.bodies):
        holders.append((f"bodies[{number}].", body, ("velocity", "displacement")))
    if scene.exact is not None:
        holders.append(("exact.", scene.exact, ("displacement", "velocity", "stress")))
    for path, holder, keys in holders:
        for key in keys:
            entries = getattr(holder, key)
            if entries is not None:
                yield path + key, list(entries.values()) if key == "stress" else entries
