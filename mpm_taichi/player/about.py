"""What the page says of the run: where it is from, how it was made, with which versions."""

from collections.abc import Iterator

from ..recording import Recording
from ..renderers.units import with_unit

SIDES = ("left", "right", "bottom", "top", "back", "front")


def about(recording: Recording) -> list[tuple[str, str]]:
    """Pairs of a word and a text."""
    return [(word, text) for word, text in _rows(recording) if text]


def _rows(recording: Recording) -> Iterator[tuple[str, str]]:
    scene, report = recording.scene, recording.report
    domain, method = scene.domain, scene.method
    yield "source", scene.source
    yield "domain", " x ".join(with_unit(length, "m") for length in domain.size)
    cells = " x ".join(map(str, domain.cells))
    yield "cells", f"{cells} of {with_unit(scene.cell_size, 'm')}"
    walls = domain.walls
    if isinstance(walls, str):
        yield "walls", walls
    else:
        yield (
            "walls",
            ", ".join(f"{side} {getattr(walls, side)}" for side in SIDES[: 2 * scene.dimension]),
        )
    yield "method", f"{method.basis} basis, {method.transfer.type}, {method.stress_update}"
    for name, material in scene.materials.items():
        yield f"material {name}", material.type
    yield "status", _sentence(report, "status")
    yield "time steps", _sentence(report, "steps")
    yield "started", _sentence(report, "started")
    device = (_sentence(report, name) for name in ("device", "precision"))
    yield "device", ", ".join(filter(None, device))
    versions = report.get("versions")
    if isinstance(versions, dict):
        known = (f"{name} {version}" for name, version in versions.items() if version)
        yield "versions", ", ".join(known)


def _sentence(report: dict, name: str) -> str:
    return str(report.get(name, ""))
