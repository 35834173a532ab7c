"""A moment of a simulation as a Frame, and the values that its colors show."""

from math import inf

import numpy as np

from .picture import Frame


def value_of(snapshot, quantity: str) -> np.ndarray | None:
    """[n] of one of QUANTITIES; None for the bodies."""
    return {
        "body": lambda: None,
        "speed": lambda: snapshot.speed,
        "pressure": lambda: snapshot.pressure,
        "stress": lambda: snapshot.von_mises_stress,
        "density": lambda: snapshot.density,
        "plastic_strain": lambda: snapshot.plastic_strain,
    }[quantity]()


def narrowest(quantity: str) -> tuple[float, float]:
    """The range of the colors before anything is seen: it holds 0 but for density, where 990 to
    1010 kg/m^3 would be one color."""
    return (inf, -inf) if quantity == "density" else (0.0, 0.0)


def frame_of(simulation, snapshot, quantity: str, value, value_range: tuple[float, float]) -> Frame:
    """`value`: as `value_of` has it."""
    scene = simulation.scene
    return Frame(
        position=snapshot.visible_position,
        radius=0.5 * snapshot.initial_volume ** (1 / scene.dimension),
        body=simulation.body_of_particle,
        body_names=[body.name for body in scene.bodies],
        time=snapshot.time,
        longest_time=simulation.end,
        title=scene.title,
        domain_size=tuple(scene.domain.size),
        cells=tuple(scene.domain.cells),
        quantity=quantity,
        value=value,
        value_range=value_range,
    )
