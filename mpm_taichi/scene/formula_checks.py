"""What must hold for the formulas of a scene; checks as those of `checks.py`."""

from collections.abc import Iterator

from ..expressions import Expressions
from ..formulas import check_name, parse
from .wording import Found, wrong_length


def definitions(domain, definitions) -> Iterator[Found]:
    """Each formula by itself, with the names before it."""
    known = {}
    for name, formula in definitions.items():
        try:
            check_name(name)
            known[name] = parse(formula, domain.dimension, known)
        except ValueError as error:
            yield ("definitions", name), str(error)
            return


def formulas(domain, definitions, bodies) -> Iterator[Found]:
    for number, body in bodies.items():
        for key in ("velocity", "displacement"):
            place = ("bodies", number, key)
            yield from _unusable(place, getattr(body, key), domain, definitions, "XYZ")


def body_force(domain, definitions, body_force) -> Iterator[Found]:
    yield from _unusable(("body_force",), body_force, domain, definitions, "XYZxyzt")
    if body_force is not None and len(body_force) != domain.dimension:
        yield ("body_force",), wrong_length(body_force, domain)


def exact(domain, definitions, exact) -> Iterator[Found]:
    if exact is None:
        return
    for key in ("displacement", "velocity"):
        entries = getattr(exact, key)
        yield from _unusable(("exact", key), entries, domain, definitions, "XYZt")
        if entries is not None and len(entries) != domain.dimension:
            yield ("exact", key), wrong_length(entries, domain)
    yield from _unusable(("exact", "stress"), exact.stress, domain, definitions, "XYZt")
    if exact.displacement is exact.velocity is exact.stress is None:
        yield ("exact",), "must have at least one of displacement, velocity, stress"


def _unusable(place, formulas, domain, definitions, variables) -> Iterator[Found]:
    """Formulas (a list or a mapping) that cannot be read or use what is not known there."""
    items = formulas.items() if isinstance(formulas, dict) else enumerate(formulas or ())
    for key, formula in items:
        try:
            used = Expressions([formula], definitions, dim=domain.dimension).variables
            unknown = sorted(used - set(variables))
            there = [name for name in variables if name.lower() != "z" or domain.dimension == 3]
            text = f"must not use {', '.join(unknown)}: it is a field of {', '.join(there)}"
        except ValueError as error:
            unknown, text = [formula], str(error)
        if unknown and not _definitions_are_wrong(definitions, domain):
            yield (*place, key), text


def _definitions_are_wrong(given, domain) -> bool:
    """Then each is told once, where it stands."""
    return any(definitions(domain, given))
