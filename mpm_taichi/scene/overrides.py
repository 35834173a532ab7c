"""Overrides: `bodies[0].velocity=[0, 1]` in place of what the file says."""

import re

from ..errors import InputError
from .document import Document, Fault, Place, parse
from .wording import path_text

WORD = r"[^.\[\]=\s]+"
KEY = re.compile(rf"{WORD}(\.{WORD}|\[\d{{1,9}}\])*")


def override(document: Document, text: str, number: int) -> None:
    """Sets one value; mappings that are missing on the way to it are made.

    InputError, and nothing set, where the key leads nowhere or the value is no YAML.  Whatever else
    is wrong with the value has its place at `--set KEY`."""
    key, equals, value = text.partition("=")
    key = key.strip()
    if not equals or not KEY.fullmatch(key):
        raise InputError(
            f"--set {text}: must be KEY=VALUE, with a key such as time.end or bodies[0].velocity"
        )
    place = Place((1, number), f"--set {key}")
    new = parse(value, place.text)
    parts = re.findall(rf"\[\d+\]|{WORD}", key)
    path = tuple(int(part[1:-1]) if part.startswith("[") else part for part in parts)
    set_at = _set(document.value, path, new.value, place.text)
    for known in [known for known in document.places if known[: len(set_at)] == set_at]:
        del document.places[known]
    document.places[set_at] = place
    document.faults += [Fault((*path, *below), place, said) for below, _, said in new.faults]


def _set(holder, path: tuple, value, name: str) -> tuple:
    """Returns the path of what was set: `path`, or the first mapping on the way that was made."""
    depth, there = 0, True
    while there:
        part = path[depth]
        _refuse_misfit(holder, path[:depth], part, name)
        depth += 1
        there = depth < len(path) and (isinstance(holder, list) or holder.get(part) is not None)
        holder = holder[part] if there else holder
    for number in range(depth, len(path)):
        _refuse_misfit({}, path[:number], path[number], name)
    for missing in reversed(path[depth:]):
        value = {missing: value}
    holder[path[depth - 1]] = value
    return path[:depth]


def _refuse_misfit(holder, path: tuple, part: str | int, name: str) -> None:
    if isinstance(part, str):
        if not isinstance(holder, dict):
            raise InputError(f"{name}: {path_text(path)} is no mapping, so it has no '{part}'")
    elif not isinstance(holder, list):
        raise InputError(f"{name}: {path_text(path)} is no list, so it has no [{part}]")
    elif part >= len(holder):
        entries = "1 entry" if len(holder) == 1 else f"{len(holder)} entries"
        raise InputError(f"{name}: {path_text(path)} has {entries}, counted from [0]")
