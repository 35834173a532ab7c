"""The reader: scene file -> Scene, or every fault that it has, each with its place."""

from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from pydantic import TypeAdapter, ValidationError

from ..errors import InputError
from ..formulas import Formula
from ..materials import Material
from ..model import Model, Vector
from .checks import across
from .document import Document, Fault, Place, parse
from .messages import messages
from .models import (
    Body,
    Domain,
    Exact,
    MaterialOrPreset,
    Method,
    Output,
    Scene,
    Time,
    VectorField,
)
from .overrides import override
from .wording import path_text, printable, shown, suggestion

LARGEST_FILE = 1_000_000


def load_scene(path: str | Path, overrides: Sequence[str] = ()) -> Scene:
    """The scene of a file, with `bodies[0].velocity=[0, 1]` and the like in place of its values.

    Otherwise an InputError with one line for each fault, in the order of the file:
    `scenes/x.yaml:12:7: materials.rubber.youngs_modulus: must be greater than 0 (got -3)`.
    Checks that compare sections run on those that are valid by themselves.

    Mesh files are looked up from the folder of the scene file."""
    document = parse(_text(Path(path)), str(path))
    if not isinstance(document.value, dict):
        said = "is empty" if document.value is None else f"is {shown(document.value)}, no mapping"
        document.add((), f"{said}: a scene is a mapping that begins with version: 1")
        raise InputError(_lines(document.faults))
    refused = _changed(document, overrides)
    _resolve_mesh_files(document.value, Path(path).absolute().parent)
    try:
        scene = Scene.model_validate(document.value)
        if not document.faults and not refused:
            return scene
    except ValidationError as error:
        _add_faults(document, error)
    raise InputError("\n".join(filter(None, [_lines(document.faults), *refused])))


def load_material(values: dict, overrides: Sequence[str] = ()) -> Material:
    """The material of a mapping as a scene has it, with `youngs_modulus=1e5` and the like in place
    of its values.  Otherwise an InputError with one line for each fault."""
    document = Document(dict(values), {(): Place((0,), "material")})
    refused = _changed(document, overrides)
    try:
        material = TypeAdapter(MaterialOrPreset).validate_python(document.value)
        if not document.faults and not refused:
            return material
    except ValidationError as error:
        place = ("materials", "this")  # the schema is that of scenes
        errors = [{**e, "loc": (*place, *e["loc"])} for e in error.errors(include_url=False)]
        for path, sentence in messages(errors, {"materials": {"this": document.value}}):
            document.add(path[len(place) :], sentence)
    raise InputError("\n".join(filter(None, [_lines(document.faults), *refused])))


def _changed(document: Document, overrides: Sequence[str]) -> list[str]:
    """Sets what the overrides say; returns what is wrong with those that cannot be set."""
    refused = []
    for number, text in enumerate(overrides):
        try:
            override(document, text, number)
        except InputError as error:
            refused.append(printable(str(error)))
    return refused


def _text(path: Path) -> str:
    try:
        if path.is_dir():
            raise InputError(f"{path}: is a folder, not a scene file")
        with path.open("rb") as file:
            raw = file.read(LARGEST_FILE + 1)
    except FileNotFoundError:
        siblings = [str(sibling) for sibling in path.parent.glob("*.yaml")]
        raise InputError(f"{path}: there is no such file{suggestion(path, siblings)}") from None
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: cannot be read: {getattr(error, 'strerror', error)}") from None
    if len(raw) > LARGEST_FILE:
        raise InputError(f"{path}: is larger than {LARGEST_FILE} bytes, so it is no scene file")
    try:
        return raw.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = raw.count(b"\n", 0, error.start) + 1
        raise InputError(f"{path}:{line}: is not UTF-8 text; save it with that encoding") from None


def _resolve_mesh_files(data: dict, folder: Path) -> None:
    bodies = data.get("bodies")
    for body in bodies if isinstance(bodies, list) else ():
        particles = body.get("particles") if isinstance(body, dict) else None
        if isinstance(particles, dict) and isinstance(particles.get("file"), str):
            particles["file"] = str(folder / particles["file"])


def _add_faults(document: Document, error: ValidationError) -> None:
    """What lies below a fault of the YAML, or around or below one of pydantic's, is not judged."""
    found = messages(error.errors(include_url=False), document.value)
    broken = {fault.path for fault in document.faults}
    for path, sentence in found:
        if broken.isdisjoint(_around(path)):
            document.add(path, sentence)
    broken.update(path for path, _ in found)
    around = {above for path in broken for above in _around(path)}
    for path, sentence in across(_sections(document.value)):
        if path not in around and broken.isdisjoint(_around(path)):
            document.add(path, sentence)


def _around(path: tuple) -> list[tuple]:
    """The path itself and all that hold it."""
    return [path[:length] for length in range(len(path) + 1)]


def _sections(data: dict) -> dict[str, Any]:
    """The sections and bodies that are valid, if need be without their wrong keys.  Of materials
    the names suffice."""
    sections: dict[str, Any] = {"bodies": {}}
    for name, kind in (("domain", Domain), ("method", Method), ("time", Time), ("output", Output)):
        with suppress(ValidationError):
            sections[name] = _without_wrong_keys(kind, data.get(name, {}))
    with suppress(ValidationError):
        sections["gravity"] = TypeAdapter(Vector | None).validate_python(data.get("gravity"))
    with suppress(ValidationError):
        force = TypeAdapter(VectorField | None).validate_python(data.get("body_force"))
        sections["body_force"] = force
    with suppress(ValidationError):
        names = TypeAdapter(dict[str, Formula]).validate_python(data.get("definitions", {}))
        sections["definitions"] = names
    with suppress(ValidationError):
        sections["exact"] = TypeAdapter(Exact | None).validate_python(data.get("exact"))
    if data.get("materials") and isinstance(data["materials"], dict):
        sections["materials"] = data["materials"]
    if isinstance(data.get("bodies"), list):
        for number, body in enumerate(data["bodies"]):
            with suppress(ValidationError):
                sections["bodies"][number] = _without_wrong_keys(Body, body)
    return sections


def _without_wrong_keys(kind: type[Model], value) -> Model:
    try:
        return kind.model_validate(value)
    except ValidationError as error:
        if not isinstance(value, dict):
            raise
        wrong = {found["loc"][0] for found in error.errors() if found["loc"]}
        return kind.model_validate({key: value[key] for key in value if key not in wrong})


def _lines(faults: list[Fault]) -> str:
    lines = []
    for path, place, sentence in sorted(faults, key=lambda fault: fault.place.order):
        where = path_text(path)
        if where and place.text != f"--set {where}":
            sentence = f"{where}: {sentence}"
        lines.append(f"{place.text}: {printable(sentence)}")
    return "\n".join(lines)
