"""What must agree between the keys of a scene.

Each check reads the sections that its parameters name and yields the faults it finds, each as the
location of a key and the sentence that follows it.  `bodies` is a dict of index -> Body."""

from collections.abc import Iterator, Mapping
from inspect import signature
from math import prod
from pathlib import Path
from sys import float_info
from typing import Any

from ..bases import BASES
from ..meshes import MeshFile
from ..model import Model
from .formula_checks import body_force, definitions, exact, formulas
from .wording import Found, shown, suggestion, wrong_length

MOST_CELLS = 2**31 - 1


def across(sections: Mapping[str, Any]) -> Iterator[Found]:
    """The faults of all checks whose sections are there: a section that is wrong by itself is left
    out, so that its fault is reported once."""
    for check in CHECKS:
        names = signature(check).parameters
        if sections.keys() >= names.keys():
            yield from check(**{name: sections[name] for name in names})


def cells(domain) -> Iterator[Found]:
    """One count per axis, equal edges to 1e-9, and few enough to be numbered."""
    place = ("domain", "cells")
    if len(domain.cells) != domain.dimension:
        yield place, wrong_length(domain.cells, domain)
        return
    edges = [size / count for size, count in zip(domain.size, domain.cells, strict=True)]
    if min(edges) < float_info.min:
        yield ("domain", "size"), "is too small for floating-point numbers"
    elif max(edges) - min(edges) > 1e-9 * max(edges):
        yield place, _other_cells(domain, edges)
    if prod(domain.cells) > MOST_CELLS:
        yield place, f"makes {prod(domain.cells):.3g} cells; at most {MOST_CELLS:.3g} are possible"


def _other_cells(domain, edges: list[float]) -> str:
    """Names counts that would fit, where the edge of one axis divides all sizes, and sizes."""
    fits = []
    for edge in edges:
        counts = [size / edge for size in domain.size]
        if all(1 <= c < MOST_CELLS and abs(c - round(c)) <= 1e-9 * c for c in counts):
            fits.append(f"cells {_listed(counts)}")
    fits.append(f"size {_listed(count * edges[0] for count in domain.cells)}")
    kind = "square" if domain.dimension == 2 else "cubic"
    return (
        f"must make {kind} cells, but size / cells is {_listed(edges)}; "
        f"{' or '.join(dict.fromkeys(fits))} would fit"
    )


def walls(domain) -> Iterator[Found]:
    for side in ("back", "front"):
        if domain.dimension == 2 and getattr(domain.walls, side, "none") != "none":
            yield ("domain", "walls", side), f"a 2D domain has no {side}: only a 3D one has"


def periodic(domain) -> Iterator[Found]:
    """An axis closes on itself with both of its sides."""
    for sides in (("left", "right"), ("bottom", "top"), ("back", "front")):
        words = [getattr(domain.walls, side, "periodic") for side in sides]
        if words.count("periodic") == 1:
            open_side = sides[words.index(next(word for word in words if word != "periodic"))]
            closed = sides[1 - sides.index(open_side)]
            text = f"must be periodic too, as {closed} is: both are sides of one axis"
            yield ("domain", "walls", open_side), text


def support(domain, method) -> Iterator[Found]:
    """The stencil of a particle fits into the domain."""
    basis = method.basis_class
    for axis, count in enumerate(domain.cells):
        if count < basis.support and axis not in domain.periodic:
            yield (
                ("domain", "cells", axis),
                f"must be at least {basis.support}, the nodes per axis that the {basis.name} basis "
                f"touches (got {count})",
            )


def moment(method) -> Iterator[Found]:
    """Transfers that gather affine moments divide by them: APIC by that of each particle, its MLS
    form by one that must be constant."""
    basis, transfer = method.basis_class, method.transfer_class
    if not transfer.moments:
        return
    if basis.moment_vanishes:
        bases = [basis.name for basis in BASES if not basis.moment_vanishes]
        yield (
            ("method", "transfer"),
            f"apic divides by the moment of the weights, and that of the {basis.name} basis has "
            f"zeros: take transfer tpic, flip, xpic or pic, or basis {', '.join(bases)}",
        )
    elif not transfer.gradient and basis.inverse_moment is None:
        bases = [basis.name for basis in BASES if basis.inverse_moment is not None]
        yield (
            ("method", "transfer"),
            f"the force in its mls form needs a basis whose moment is constant, and that of the "
            f"{basis.name} basis is not: take force: gradient, or basis {' or '.join(bases)}",
        )


def blend(method) -> Iterator[Found]:
    """One way to say how much PIC there is in FLIP."""
    given = [getattr(method.transfer, key, None) for key in ("ratio", "relaxation_time")]
    if None not in given:
        text = "must not be given with relaxation_time: each says how much PIC is blended in"
        yield ("method", "transfer", "ratio"), text


def stress_update(method) -> Iterator[Found]:
    """The force in its MLS form scatters stress and velocity as one, so it knows USL alone."""
    if method.stress_update != "usl" and not method.transfer_class.gradient:
        yield (
            ("method", "stress_update"),
            f"{method.stress_update} needs the force along grad w: take transfer "
            "{type: apic, force: gradient} or another, or stress_update: usl",
        )


def step(time) -> Iterator[Found]:
    if time.step != "auto" and time.step > time.end:
        yield ("time", "step"), f"must not exceed time.end, {time.end:.12g} (got {time.step:.12g})"
    if time.step == "auto" and not time.enforce:
        yield ("time", "enforce"), "must not be false where time.step is auto: give a step"
    if time.step != "auto" and time.safety != type(time).model_fields["safety"].default:
        yield ("time", "safety"), "is of step: auto, and time.step is given: leave out one of them"


def interval(time, output) -> Iterator[Found]:
    if output.every is not None and output.every > time.end:
        yield (
            ("output", "every"),
            f"must not exceed time.end, {time.end:.12g} (got {output.every:.12g})",
        )


def stages(domain, output) -> Iterator[Found]:
    if output.stages and domain.dimension != 2:
        yield ("output", "stages"), "is for 2D scenes: leave it out"
    if output.stages and output.snapshots is False:
        yield ("output", "stages"), "needs the snapshots, so output.snapshots must not be false"


def view(domain, output) -> Iterator[Found]:
    """A 2D domain is seen straight on; the middle has one entry per axis."""
    if output.images == "none":
        return
    place, its = ("output", "images", "view"), output.images.view
    for key in ("turn", "tilt"):
        if domain.dimension == 2 and getattr(its, key) is not None:
            yield (*place, key), "a 2D domain is seen straight on: only a 3D one can be turned"
    if its.center is not None and len(its.center) != domain.dimension:
        yield (*place, "center"), wrong_length(its.center, domain)


def colors(output) -> Iterator[Found]:
    """Pressure has two signs, and 0 the color between."""
    style = output.images
    if style == "none" or style.color_by != "pressure" or style.range is None:
        return
    low, high = style.range
    if low != -high:
        most = max(abs(low), abs(high))
        yield (
            ("output", "images", "range"),
            f"must have 0 in its middle for pressure: [{-most:g}, {most:g}] (got "
            f"{shown(style.range)})",
        )


def gravity(domain, gravity) -> Iterator[Found]:
    if gravity is not None and len(gravity) != domain.dimension:
        yield ("gravity",), wrong_length(gravity, domain)


def names(bodies) -> Iterator[Found]:
    first = {}
    for number, body in bodies.items():
        if not body.name.isprintable():
            yield ("bodies", number, "name"), "must be on one line, of characters that show"
        other = first.setdefault(body.name, number)
        if other != number:
            yield (
                ("bodies", number, "name"),
                f"{shown(body.name)} is also the name of bodies[{other}]",
            )


def material(bodies, materials) -> Iterator[Found]:
    for number, body in bodies.items():
        if body.material not in materials:
            known = f"; the materials are {', '.join(materials)}"
            hint = suggestion(body.material, materials) or known
            yield (
                ("bodies", number, "material"),
                f"no material is named {shown(body.material)}{hint}",
            )


def shape(bodies) -> Iterator[Found]:
    for number, body in bodies.items():
        word = body.particles.type
        if body.particles.needs_shape and body.shape is None:
            yield ("bodies", number, "shape"), f"is required by particles of type {word}"
        elif body.shape is not None and not body.particles.needs_shape:
            text = f"must not be given with particles of type {word}, which bring their own"
            yield ("bodies", number, "shape"), text


def mesh_file(bodies) -> Iterator[Found]:
    for number, body in bodies.items():
        if isinstance(body.particles, MeshFile) and (text := _unreadable(body.particles.file)):
            yield ("bodies", number, "particles", "file"), text


def _unreadable(file: str) -> str | None:
    try:
        if Path(file).is_file():
            return None
        return f"{file!r} is a folder" if Path(file).is_dir() else f"there is no file {file!r}"
    except (OSError, ValueError) as error:
        return f"{file!r} cannot be read: {error}"


def lengths(domain, bodies) -> Iterator[Found]:
    """Every vector of a body has one entry per axis."""
    for number, body in bodies.items():
        for place, vector in _vectors(("bodies", number), body):
            if len(vector) != domain.dimension:
                yield place, wrong_length(vector, domain)


def _vectors(place: tuple, value) -> Iterator[tuple[tuple, list]]:
    if isinstance(value, Model):
        for name, member in value:
            yield from _vectors((*place, name), member)
    elif isinstance(value, list) and all(isinstance(entry, float | int | str) for entry in value):
        yield place, value
    elif isinstance(value, list):
        for number, entry in enumerate(value):
            yield from _vectors((*place, number), entry)


def inside(domain, bodies) -> Iterator[Found]:
    """Shapes lie in the closed domain, to 1e-12 of its size."""
    for number, body in bodies.items():
        if body.shape is None or body.shape.dimension != domain.dimension:
            continue
        beyond = []
        for axis, size, low, high in zip("xyz", domain.size, *body.shape.bounds(), strict=False):
            if low < -1e-12 * size:
                beyond.append(f"{-low:.6g} m below {axis} = 0")
            if high > size * (1 + 1e-12):
                beyond.append(f"{high - size:.6g} m beyond {axis} = {size:.12g}")
        if beyond:
            yield ("bodies", number, "shape"), f"leaves the domain: {' and '.join(beyond)}"


def _listed(numbers) -> str:
    return f"[{', '.join(f'{number:.12g}' for number in numbers)}]"


CHECKS = (
    cells,
    walls,
    periodic,
    support,
    moment,
    blend,
    stress_update,
    step,
    interval,
    stages,
    view,
    colors,
    gravity,
    names,
    material,
    shape,
    mesh_file,
    lengths,
    inside,
    definitions,
    formulas,
    body_force,
    exact,
)
