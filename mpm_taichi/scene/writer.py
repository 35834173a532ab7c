"""The writer: Scene -> YAML that the reader turns into an equal Scene."""

import re
from collections.abc import Iterator

from .document import plain_scalar
from .models import Scene

WIDTH = 100
PLAIN = re.compile(r"[A-Za-z/]([\w./ -]*[\w./-])?")


def dump_scene(scene: Scene) -> str:
    """The scene as YAML, with the defaults that it took and the absolute paths of mesh files."""
    lines = []
    for key, value in scene.model_dump(exclude_none=True).items():
        lines += _lines(f"{key}: ", value, "")
    return "\n".join(lines) + "\n"


def _lines(head: str, value, indent: str) -> Iterator[str]:
    """`head` and value on one line where they fit, else a line for each entry."""
    line = f"{indent}{head}{_flow(value)}"
    if len(line) <= WIDTH or not isinstance(value, dict | list):
        yield line
        return
    if head:
        yield f"{indent}{head}".rstrip()
        indent += "  "
    if isinstance(value, dict):
        for key, entry in _entries(value):
            yield from _lines(f"{key}: ", entry, indent)
    else:
        for entry in value:
            first, *rest = _lines("", entry, f"{indent}  ")
            yield f"{indent}- {first.lstrip()}"
            yield from rest


def _flow(value) -> str:
    if isinstance(value, dict):
        return f"{{{', '.join(f'{key}: {_flow(entry)}' for key, entry in _entries(value))}}}"
    if isinstance(value, list):
        return f"[{', '.join(map(_flow, value))}]"
    if isinstance(value, bool):
        return "true" if value else "false"
    return _text(value) if isinstance(value, str) else repr(value)


def _entries(value: dict) -> list[tuple[str, object]]:
    """`type` comes first, whatever the order of the model's fields."""
    return [(_text(key), value[key]) for key in sorted(value, key=lambda key: key != "type")]


def _text(text: str) -> str:
    """In quotes where the reader would take the bare text for something else."""
    if PLAIN.fullmatch(text) and isinstance(plain_scalar(text), str):
        return text
    escaped = (c if c.isprintable() and c not in '"\\' else f"\\U{ord(c):08x}" for c in text)
    return f'"{"".join(escaped)}"'
