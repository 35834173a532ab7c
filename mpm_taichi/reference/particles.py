"""Particles as plain arrays, in the order of the scene."""

from types import SimpleNamespace

import numpy as np

from . import materials


class Particles:
    """x [m], v [m/s], H = F - I, m [kg], V0 [m^dim], X [m]; A [kg/s], T = - dt V0 tau [kg m^2/s],
    and the impulse `force` [kg m/s], which P2G scatters; free_A [kg/s], which is A without the
    stress, and V0_tau [J]; v_pic, dv, B, S, which the last G2P has gathered; R, the residual
    velocity of a filter."""

    def __init__(self, bodies, basis, transfer, dx):
        self.x = np.concatenate([body.x for body in bodies])
        self.X = np.concatenate([body.undeformed for body in bodies])
        self.v = np.concatenate([body.v for body in bodies])
        self.V0 = np.concatenate([body.V0 for body in bodies])
        self.m = np.concatenate([body.material.density * body.V0 for body in bodies])
        self.H = np.concatenate([body.displacement_gradient for body in bodies])
        self.count, self.dim = self.x.shape
        self.half_width = 0.5 * self.V0 ** (1 / self.dim) / dx
        self.A, self.T, self.free_A, self.V0_tau = np.zeros((4, self.count, self.dim, self.dim))
        self.S = np.concatenate([body.velocity_gradient for body in bodies])
        self.B = self.S * dx**2 / (basis.inverse_moment or 1.0)
        self.v_pic = self.v.copy()
        self.dv, self.force, self.R = np.zeros((3, self.count, self.dim))
        self.lost = self.count
        self.groups = []
        kind = np.repeat(range(len(bodies)), [len(body.x) for body in bodies])
        for material in dict.fromkeys(body.material for body in bodies):
            mine = [number for number, body in enumerate(bodies) if body.material == material]
            law = getattr(materials, type(material).__name__)
            members = np.flatnonzero(np.isin(kind, mine))
            start = material.start(self.H[members])
            state = {
                p: SimpleNamespace(**{name: start[name][k].copy() for name in start})
                for k, p in enumerate(members)
            }
            c = SimpleNamespace(**material.constants(dx))
            self.groups.append(SimpleNamespace(law=law, constants=c, members=members, state=state))
