"""Particles as plain arrays, in the order of the scene."""

from types import SimpleNamespace

import numpy as np

from . import materials


class Particles:
    """x [m], v [m/s], C [1/s], H = F - I, m [kg], V0 [m^dim]; T = - dt V0 tau [kg m^2/s^2] and
    A [kg/s], what the next P2G scatters; v_pic, dv, B, S, what the last G2P gathered."""

    def __init__(self, bodies, transfer, dx):
        self.x = np.concatenate([body.x for body in bodies])
        self.v = np.concatenate([body.v for body in bodies])
        self.V0 = np.concatenate([body.V0 for body in bodies])
        self.m = np.concatenate([body.material.density * body.V0 for body in bodies])
        self.count, self.dim = self.x.shape
        self.H, self.A, self.T, self.B, self.S = np.zeros((5, self.count, self.dim, self.dim))
        self.v_pic, self.dv = self.v.copy(), np.zeros_like(self.v)
        self.lost = self.count
        self.groups = []
        kind = np.repeat(range(len(bodies)), [len(body.x) for body in bodies])
        for material in dict.fromkeys(body.material for body in bodies):
            mine = [number for number, body in enumerate(bodies) if body.material == material]
            law = getattr(materials, type(material).__name__)
            members = np.flatnonzero(np.isin(kind, mine))
            start = {name: np.array(value) for name, value in material.state(self.dim).items()}
            state = {p: SimpleNamespace(**{n: a.copy() for n, a in start.items()}) for p in members}
            c = SimpleNamespace(**material.constants(dx))
            self.groups.append(SimpleNamespace(law=law, constants=c, members=members, state=state))
