"""What a particle is like that has gone wrong, and what is left of the run that failed by it:

RUN/trouble/trouble.json        who, when, in which state, what was tried
RUN/trouble/surroundings.png    the particles around it
RUN/trouble/step_*.npz          where the last attempt began, for `replay`; none: at the start
"""

import contextlib
import shutil
from pathlib import Path
from typing import Any

import numpy as np

from .errors import InputError, MotionError
from .whole_files import write_json

AROUND = 6.0
"""Half the edge of the picture of surroundings [cells]."""


def particle_values(solver, particle: int) -> dict[str, Any]:
    """Of one particle, by its place in the scene, whatever its numbers are: position [m], velocity
    [m/s], deformation gradient and J [-], Cauchy stress [Pa], pressure of which is - tr / 3."""
    particles = solver.particles
    place = int(np.flatnonzero(particles.id.to_numpy() == particle)[0])
    group = next(g for g in particles.groups if g.begin <= place < g.end)
    m, row = float(particles.m[place]), particles.rows[place, 0].to_numpy()
    H = particles.H[place].to_numpy().astype(float)
    with np.errstate(all="ignore"):
        return {
            "position": particles.x[place].to_numpy().tolist(),
            "velocity": (row[: particles.dim] / m).tolist(),
            "deformation_gradient": (H + np.eye(particles.dim)).tolist(),
            "det_F": float(np.linalg.det(H + np.eye(particles.dim))),
            "mass": m,
            "law": group.law.kind.__name__,
        }


def fault(values: dict[str, Any]) -> str:
    """What is wrong with it, in words."""
    for name, noun in (("position", "a position"), ("velocity", "a velocity")):
        if not np.isfinite(values[name]).all():
            return f"has {noun} that is no number"
    F = np.array(values["deformation_gradient"])
    if not np.isfinite(F).all():
        return "has a deformation that is no number"
    if values["det_F"] <= 0:
        return f"is turned inside out: det F = {values['det_F']:.3g}"
    if np.abs(F).max() > 1e6:
        return f"is deformed without bound: F has an entry of {np.abs(F).max():.3g}"
    return "has a stress or an energy that is no number"


def in_words(values: dict[str, Any]) -> str:
    """One line."""
    x, v, F = (
        _vector(np.array(values[name]).ravel())
        for name in ("position", "velocity", "deformation_gradient")
    )
    return f"x = {x} m, v = {v} m/s, F = {F} (by rows), det F = {values['det_F']:.4g}"


def _vector(numbers) -> str:
    return f"({', '.join(f'{number:.4g}' for number in numbers)})"


def gone_wrong(simulation, particle: int) -> MotionError:
    """Of a particle whose numbers are none, or no longer those of matter."""
    values = particle_values(simulation.solver, particle)
    return MotionError(
        f"{_when(simulation, particle)} {fault(values)} ({in_words(values)}). "
        f"{_advice(simulation)}",
        particle,
    )


def gone_outside(simulation) -> MotionError:
    """Of the first particle, by its place in the scene, that is outside the domain."""
    lost = simulation.solver.particles.lost[None]
    x = simulation.solver.particles.to_numpy("x")[lost]
    if not np.isfinite(x).all():
        return gone_wrong(simulation, lost)
    return MotionError(
        f"{_when(simulation, lost)} has left the domain {simulation.scene.domain.size}: it is at "
        f"{[float(f'{value:.9g}') for value in x]}. Make the domain larger, give it walls "
        "(domain.walls; a fast soft body can still be pressed through), or say what happens to "
        "such particles (domain.outside: delete or clamp). If it should not have moved so: "
        f"{_advice(simulation)}",
        lost,
        is_exit=True,
    )


def _when(simulation, particle):
    who = simulation.describe_particle(particle)
    return f"t = {simulation.time:.6g} s, step {simulation.step_count}: {who}"


def _advice(simulation):
    limit, longest = simulation.limit, simulation.time_step.longest
    if simulation.lookout.slivers:
        return (
            f"{simulation.lookout.slivers} times a node was too light for the step, which lets the "
            f"{simulation.scene.method.basis} basis with stress_update: usl blow up: take basis: "
            "quadratic, or stress_update: musl."
        )
    return (
        f"A shorter time.step may help: steps were up to {longest:.3g} s, the {limit.name} limit "
        f"at the start is {limit.seconds:.3g} s ({limit.cause})."
    )


def write_trouble(attempts, failure) -> str:
    """Leave what tells of the trouble in the folder of the run; returns words that say so."""
    simulation, folder = attempts.simulation, attempts.folder / "trouble"
    limits = simulation.time_step.limits(simulation.time_step.motion)
    content = {
        "error": str(failure),
        "time": simulation.time,
        "step": simulation.step_count,
        "time_step": simulation.last_dt,
        "limits": [limit._asdict() for limit in limits],
        "from": None,
        "steps_shortened_to": attempts.reduction,
        "failures": attempts.failures,
    }
    if failure.particle is not None:
        content["particle"] = {"id": failure.particle} | _particle(simulation, failure.particle)
    try:
        folder.mkdir(exist_ok=True)
        for old in folder.iterdir():
            old.unlink()
        if attempts.checkpoint is not None:
            content["from"] = attempts.checkpoint.path.name
            for path in attempts.checkpoint.path.parent.glob(attempts.checkpoint.path.name + "*"):
                shutil.copy2(path, folder)
        write_json(folder / "trouble.json", content)
        if failure.particle is not None:
            _draw_surroundings(simulation, failure.particle, folder / "surroundings.png")
    except OSError as error:
        return f" (what tells more could not be written: {error})"
    return (
        f"\n{len(attempts.failures)} attempts failed so, the last with steps "
        f"{attempts.reduction:g} times as long as the rule allows. More in {folder}; to see it "
        f"again: python -m mpm_taichi replay {attempts.folder}"
    )


def _particle(simulation, particle: int) -> dict[str, Any]:
    body = simulation.scene.bodies[int(simulation.body_of_particle[particle])]
    names = {"body": body.name, "material": body.material}
    return names | particle_values(simulation.solver, particle)


def _draw_surroundings(simulation, particle: int, path: Path) -> None:
    """The particles within some cells of it, itself in gray: at the border where it is outside."""
    from .renderers.picture import Frame, draw
    from .renderers.png import write_png

    scene, particles = simulation.scene, simulation.solver.particles
    x, V0 = particles.to_numpy("x"), particles.to_numpy("V0")
    m, momentum = particles.to_numpy("m"), particles.to_numpy("rows")[:, 0, : particles.dim]
    size = np.array(scene.domain.size)
    center = np.where(np.isfinite(x[particle]), x[particle], size / 2)
    half = np.minimum(AROUND * scene.cell_size, size / 2)
    low = np.clip(center - half, 0, size - 2 * half)
    low = np.floor(low / scene.cell_size) * scene.cell_size
    cells = np.ceil(2 * half / scene.cell_size - 1e-9).astype(int)
    edge = cells * scene.cell_size
    x[particle] = np.clip(center, low, low + edge)
    with np.errstate(all="ignore"):
        near = ((x >= low) & (x <= low + edge)).all(axis=1)
        speed = np.linalg.norm(momentum / m[:, None], axis=1)
        speed[particle] = np.nan  # gray
        speed = speed[near]
    shown = speed[np.isfinite(speed)]
    frame = Frame(
        position=x[near] - low,
        radius=0.5 * V0[near] ** (1 / scene.dimension),
        body=simulation.body_of_particle[near],
        body_names=[body.name for body in scene.bodies],
        time=simulation.time,
        longest_time=simulation.end,
        title=f"particle {particle} (gray); corner at {_vector(low)} m",
        domain_size=tuple(edge.tolist()),
        cells=tuple(cells.tolist()),
        quantity="speed",
        value=speed,
        value_range=(0.0, float(shown.max()) if len(shown) else 1.0),
    )
    with contextlib.suppress(InputError):
        write_png(path, draw(frame, 0.5, 900), {"Title": frame.title})
