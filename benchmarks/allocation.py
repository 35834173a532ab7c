"""Bytes of the Taichi fields that an object holds."""

from math import prod

import taichi as ti


def fields_of(thing, seen=None) -> list[ti.Field]:
    """All fields among the attributes of an object of ours and in its lists, each once."""
    seen = {} if seen is None else seen
    if id(thing) in seen:
        return []
    seen[id(thing)] = thing
    if isinstance(thing, ti.Field):
        return [thing]
    if isinstance(thing, (list, tuple)):
        parts = list(thing)
    elif type(thing).__module__.startswith("mpm_taichi"):
        parts = list(getattr(thing, "__dict__", {}).values())
    else:
        parts = []
    return [field for part in parts for field in fields_of(part, seen)]


def allocated(fields) -> int:
    """Bytes of fields that share no memory.  A record with all its lanes and padding is a cell of
    the node of Taichi's tree that holds it."""
    return sum(prod(field.shape) * field.parent()._cell_size_bytes for field in fields)
