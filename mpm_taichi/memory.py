"""The memory that a scene takes, told before any of it is allocated."""

from dataclasses import dataclass
from math import gcd, inf, prod

from .errors import InputError
from .fields import SCRATCH, particle_fields, state_fields
from .free_memory import free_memory
from .grid import NodeLayout, folded_axes
from .kernels.rows import RowLayout
from .sampling import Lattice
from .snapshot import host_bytes
from .tally import TallyLayout

NUMBER = {"f32": 4, "f64": 8}


@dataclass(frozen=True)
class Memory:
    """Bytes of each field, by name: those of all particles, those of all nodes, with the
    tables of an audit; and the bytes that
    output takes on the host.  A few numbers besides, under 1 KiB, do not count."""

    particles: int
    nodes: int
    of_particles: dict[str, int]
    of_nodes: dict[str, int]
    output: int

    @property
    def per_particle(self) -> float:
        """0 where the number of particles is not known yet."""
        return sum(self.of_particles.values()) / max(1, self.particles)

    @property
    def per_node(self) -> float:
        return sum(self.of_nodes.values()) / self.nodes

    @property
    def fields(self) -> int:
        """Bytes of all fields."""
        return sum(self.of_particles.values()) + sum(self.of_nodes.values())

    def needs(self, device: str) -> dict[str, int]:
        """By the places where it has to be found, as in `free_memory`."""
        if device == "cpu":
            return {"memory": self.fields + self.output}
        return {f"{device} memory": self.fields, "memory": self.output}

    def describe(self) -> str:
        """One line."""
        return (
            f"memory: {size(sum(self.of_particles.values()))} for particles "
            f"({self.per_particle:.0f} B each), {size(sum(self.of_nodes.values()))} for nodes "
            f"({self.per_node:.0f} B each), {size(self.output)} for output"
        )

    def summary(self) -> dict:
        """For run.json."""
        return {
            "bytes_per_particle": self.per_particle,
            "bytes_per_node": self.per_node,
            "fields": {**self.of_particles, **self.of_nodes},
            "output": self.output,
        }


def planned_memory(scene, counts, precision, cells=None) -> Memory:
    """Of a scene whose bodies have `counts` particles, on its own cells or on others."""
    method, dim, count = scene.method, scene.dimension, sum(counts)
    force = scene.field(scene.body_force)
    rows = RowLayout(
        method.transfer_class, dim, method.stress_update == "musl", force is not None,
        scene.output.audit,
    ).count  # fmt: skip
    plans = particle_fields(count, dim, rows, method.basis_class, force)
    materials = [scene.materials[body.material] for body in scene.bodies]
    for law in dict.fromkeys(map(type, materials)):
        mine = [k for k, material in enumerate(materials) if type(material) is law]
        history = state_fields(materials[mine[0]], dim, sum(counts[k] for k in mine))
        for word, plan in history.items():
            name = f"{materials[mine[0]].type}.{word}"
            plans[name] = plans[name + SCRATCH] = plan
    grid = NodeLayout(
        cells or scene.domain.cells, method.basis_class, len(set(materials)), count,
        method.transfer_class.increment, scene.output.audit,
    )  # fmt: skip
    of_nodes = dict(grid.fields)
    if scene.output.audit:
        rules, basis = scene.domain.rules, method.basis_class
        of_nodes |= TallyLayout(
            grid, rules, folded_axes(basis, rules, scene.domain.periodic), count,
            len(set(materials)), method.transfer_class, any(scene.gravity_vector),
            force is not None,
        ).fields  # fmt: skip
    return Memory(
        particles=count,
        nodes=prod(grid.shape),
        of_particles={name: plan.bytes(precision) for name, plan in plans.items()},
        of_nodes={name: plan.bytes(precision) for name, plan in of_nodes.items()},
        output=count * host_bytes(dim, NUMBER[precision]),
    )


def refuse_too_much(scene, counts, device, precision):
    """InputError where a scene whose bodies have `counts` particles needs more than is free, with
    what would fit."""
    free, memory = free_memory(device), planned_memory(scene, counts, precision)
    if _fits(memory, device, free):
        return
    place, need = next(
        (place, need) for place, need in memory.needs(device).items() if need > free.get(place, inf)
    )
    particles = f"{memory.particles:,} particles of {memory.per_particle:.0f} B, "
    both = memory.of_particles | memory.of_nodes
    largest = sorted(both, key=lambda name: both[name], reverse=True)[:3]
    raise InputError(
        f"the scene needs {size(need)} of {place}, and {size(free[place])} are free: "
        f"{particles if memory.particles else ''}{memory.nodes:,} nodes of "
        f"{memory.per_node:.0f} B, {size(memory.output)} for output; the largest fields are "
        f"{', '.join(f'{name} {size(both[name])}' for name in largest)}. "
        + (
            _cells_that_fit(scene, counts, device, precision, free)
            or _particles_that_fit(scene, counts, device, precision, free)
            or "Take fewer, larger cells (domain.cells) and fewer particles"
        )
    )


def _fits(memory, device, free):
    return all(need <= free.get(place, inf) for place, need in memory.needs(device).items())


def _cells_that_fit(scene, counts, device, precision, free):
    """The most cells, particles per cell being what they are; nothing where no smaller number is
    enough for the stencil.  Where none has the proportions of the domain, the edge of the cells."""
    cells, dim, support = scene.domain.cells, scene.dimension, scene.method.basis_class.support

    def fewer(part, parts):
        return [max(1, round(n * part / parts)) for n in cells]

    def fits(part, parts):
        of_bodies = [
            int(count * (part / parts) ** dim) if _follows_cells(body) else count
            for body, count in zip(scene.bodies, counts, strict=True)
        ]
        return _fits(planned_memory(scene, of_bodies, precision, fewer(part, parts)), device, free)

    for parts in (gcd(*cells), cells[0]):
        part = _largest(lambda part, parts=parts: fits(part, parts), parts)
        if part and min(fewer(part, parts)) >= support:
            edge = f"{scene.cell_size * parts / part:.6g} m"
            if all(n * part % parts == 0 for n in cells):
                return f"domain.cells: {fewer(part, parts)} would fit, cells of {edge}"
            return f"domain: cells of {edge} would fit"
    return None


def _follows_cells(body):
    return isinstance(body.particles, Lattice) and body.particles.per_cell is not None


def _particles_that_fit(scene, counts, device, precision, free):
    """What the body with the most particles may have, and its word for that."""
    most = max(range(len(counts)), key=lambda k: counts[k])
    body, key = scene.bodies[most], f"bodies[{most}].particles"

    def fits(count):
        of_bodies = [*counts[:most], count, *counts[most + 1 :]]
        return _fits(planned_memory(scene, of_bodies, precision), device, free)

    count = _largest(fits, counts[most])
    if count == 0:
        return None
    apart = (counts[most] / count) ** (1 / scene.dimension)
    for word in ("spacing", "size"):
        if getattr(body.particles, word, None) is not None:
            distance = 1.001 * apart * getattr(body.particles, word)
            return f"{key}.{word}: {distance:.4g} would fit, {count:,} particles"
    return f"{key}: {count:,} particles would fit"


def _largest(fits, end) -> int:
    """The largest number below `end` that fits, 0 if none does."""
    low = 0
    while end - low > 1:
        middle = (low + end) // 2
        low, end = (middle, end) if fits(middle) else (low, middle)
    return low


def size(count: float) -> str:
    """Bytes in words: 312 KiB, 2.31 GiB."""
    for unit in ("B", "KiB", "MiB"):
        if count < 1000:
            return f"{count:.3g} {unit}"
        count /= 1024
    return f"{count:,.3g} GiB" if count < 1000 else f"{count:,.0f} GiB"
