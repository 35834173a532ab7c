"""What a run adds up for its audit, step by step and where it arises."""

import numpy as np

from .kernels.tally import TURNS


class Tally:
    """Sums since the start, by the names of mpm_taichi/tally.py; `wall_mass` [kg] is what particles
    have given to the nodes where a wall can act."""

    def __init__(self, grid, walls, transfer, gravity, force):
        dim, turns = grid.dim, len(TURNS[grid.dim])
        self.walls, self.increment = walls, transfer.increment
        self.falls, self.force = bool(np.any(gravity)), force
        self.lets_go = any(wall.rule.lets_go for wall in walls)
        self.wall_mass = np.zeros(grid.shape)
        sizes = {"given": 1, "held": 1, "end": 1, "cut": 1, "lost": dim, "work": 1}
        sizes |= {"kinetics": not self.increment, "kinetic": not self.increment}
        sizes |= {"path": dim * self.falls, "moment": dim * self.falls}
        sizes |= {"push": dim * force, "twist": turns * force, "pushing": force}
        sizes |= {"impulse": dim, "turn": turns, "images": self.lets_go} if walls else {}
        self.sums = {name: np.zeros(int(size)) for name, size in sizes.items()}

    def totals(self):
        return self.sums
