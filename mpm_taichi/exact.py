"""The exact solution that a scene gives, and how far a run is from it.

Symplectic Euler has positions at t and velocities at t - dt/2: each is compared at its own time."""

from typing import NamedTuple

import numpy as np

from . import diagnostics
from .errors import InputError, RunError
from .kernels.respond import respond
from .materials import FixedCorotated, Hencky, Hypoelastic, LinearElastic, NeoHookean
from .particles import groups_of

ELASTIC = (LinearElastic, Hypoelastic, NeoHookean, FixedCorotated, Hencky)
"""Laws whose stress and energy follow from the gradient of the displacement.  For a linear elastic
material the strain is its symmetric part: right as long as it is small."""


class Error(NamedTuple):
    """Of one quantity at one moment, in its unit: the norm of the error, that of the exact field,
    and the largest error of a particle (None for a sum over all)."""

    error: float
    scale: float
    largest: float | None = None


class ExactSolution:
    """The section `exact` of a scene, at the particles of its run.

    displacement, velocity  sqrt(sum V0 |f - f_ex|^2 / sum V0)  [m], [m/s]
    stress                  sum V0 |sigma - sigma_ex| / sum V0, Frobenius, of the Cauchy stress or
                            of the components that the scene gives; L1: noise hides in L2  [Pa]
    energy                  |E - E_ex| of kinetic and elastic energy  [J], in 2D [J/m]

    From the displacement u follow the velocity du/dt, H = grad u, and by the law of each material
    stress and energy.  Displacements along a periodic axis are taken to the nearest image.

    `omitted` says why stress and energy are not compared, where the laws are not elastic."""

    def __init__(self, simulation):
        scene = simulation.scene
        self.simulation, self.X = simulation, simulation.initial_position
        self.displacement = scene.field(scene.exact.displacement)
        self.velocity = scene.field(scene.exact.velocity)
        self.components = scene.exact.stress or {}
        self.stress = scene.field(list(self.components.values()))
        used = {body.material: scene.materials[body.material] for body in scene.bodies}
        others = [name for name, law in used.items() if not isinstance(law, ELASTIC)]
        self.omitted, self.groups = None, []
        if self.displacement is not None and others:
            self.omitted = (
                "stress and energy follow from the displacement for elastic laws alone, and "
                f"{', '.join(others)} has another"
            )
        elif self.displacement is not None:
            self.groups = [self._group(material) for material in dict.fromkeys(used.values())]

    def describe(self) -> str:
        """What is compared."""
        compared = f"compared with the exact solution: {', '.join(self.errors())}"
        return f"{compared}; {self.omitted}" if self.omitted else compared

    def errors(self) -> dict[str, Error]:
        """Of the present moment, by quantity: those of displacement, velocity, stress, energy that
        the scene gives or that follow."""
        now, V0, found = self.simulation.snapshot, self.simulation.snapshot.initial_volume, {}
        if self.displacement is not None:
            u = self._field("displacement", self.displacement.value(self.X, t=now.time))
            found["displacement"] = _root_mean_square(
                self._nearest(now.position - self.X - u), u, V0
            )
        v = self._velocity(now.time - 0.5 * self.simulation.last_dt)
        if v is not None:
            found["velocity"] = _root_mean_square(now.velocity - v, v, V0)
        sigma, psi = self._response(now.time) if self.groups else (None, None)
        compared = np.ones((3, 3))
        if self.components:
            sigma, compared = self._given_stress(now.time)
        if sigma is not None:
            found["stress"] = _mean(compared * (now.cauchy_stress - sigma), compared * sigma, V0)
        if psi is not None and v is not None:
            E = diagnostics.kinetic_energy(now) + diagnostics.elastic_energy(now)
            E_exact = 0.5 * now.mass @ (v**2).sum(axis=1) + V0 @ psi
            found["energy"] = Error(float(abs(E - E_exact)), float(abs(E_exact)))
        return found

    def _group(self, material):
        """Particles of a material, with a history of their own, and their numbers."""
        scene = self.simulation.scene
        mine = [scene.materials[body.material] == material for body in scene.bodies]
        members = np.flatnonzero(np.array(mine)[self.simulation.body_of_particle])
        undeformed = np.zeros((len(members), scene.dimension, scene.dimension))
        (group,) = groups_of([material], scene.dimension, scene.cell_size, [undeformed])
        return group, members

    def _nearest(self, d):
        domain = self.simulation.scene.domain
        for axis in domain.periodic:
            d[:, axis] -= domain.size[axis] * np.round(d[:, axis] / domain.size[axis])
        return d

    def _velocity(self, t):
        if self.velocity is not None:
            return self._field("velocity", self.velocity.value(self.X, t=t))
        if self.displacement is not None:
            return self._field("displacement", self.displacement.rate(self.X, t))
        return None

    def _response(self, t):
        """sigma [n, 3, 3] and psi [n] of the exact displacement."""
        H = self._field("displacement", self.displacement.gradient(self.X, t))
        n, dim = H.shape[:2]
        sigma, psi = np.zeros((n, 3, 3)), np.zeros(n)
        for group, members in self.groups:
            mine = H[members].astype(self.simulation.solver.particles.dtype)
            tau, psi[members], tau_zz = respond(group, mine, group.material.start(mine))
            sigma[members, :dim, :dim] = tau
            if dim == 2:
                sigma[members, 2, 2] = tau_zz
        with np.errstate(all="ignore"):
            sigma /= np.linalg.det(H + np.eye(dim))[:, None, None]
        return self._field("displacement", sigma, "stress"), psi

    def _given_stress(self, t):
        """sigma [n, 3, 3] with the components that the scene gives, and 1 at their places."""
        values = self._field("stress", self.stress.value(self.X, t=t))
        sigma, compared = np.zeros((len(values), 3, 3)), np.zeros((3, 3))
        for name, value in zip(self.components, values.T, strict=True):
            a, b = map("xyz".index, name)
            sigma[:, a, b] = sigma[:, b, a] = value
            compared[a, b] = compared[b, a] = 1
        return sigma, compared

    def _field(self, key, values, what="number"):
        """The values, if they are numbers."""
        wrong = ~np.isfinite(values.reshape(len(values), -1)).all(axis=1)
        if wrong.any():
            first = self.X[wrong][0].tolist()
            kind = RunError if self.simulation.step_count else InputError
            raise kind(f"exact.{key}: gives no {what} at {first}, t = {self.simulation.time:g} s")
        return values


def _root_mean_square(difference, exact, V0) -> Error:
    """Of vectors [n, dim]."""
    norm, largest = _norms(difference), _norms(exact)
    return Error(
        float(np.sqrt(V0 @ norm**2 / V0.sum())),
        float(np.sqrt(V0 @ largest**2 / V0.sum())),
        float(norm.max()),
    )


def _mean(difference, exact, V0) -> Error:
    """Of tensors [n, 3, 3]."""
    norm = _norms(difference)
    return Error(
        float(V0 @ norm / V0.sum()), float(V0 @ _norms(exact) / V0.sum()), float(norm.max())
    )


def _norms(values):
    """Euclidean or Frobenius, of each particle [n]."""
    return np.sqrt((values.reshape(len(values), -1) ** 2).sum(axis=1))
