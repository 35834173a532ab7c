"""A second opinion: the Material Point Method in plain NumPy, from the equations alone.

It shares no line with `mpm_taichi`, so an error made there, in the fast kernels and in their twin
alike, shows against it.  One method only: 2D plane strain, linear (hat) basis, FLIP, stress
updated last, small strain accumulated without rotation, no walls, no gravity."""

from typing import NamedTuple

import numpy as np

CORNERS = np.array([[0, 0], [1, 0], [0, 1], [1, 1]])


class History(NamedTuple):
    """States of a run, row 0 the initial one.  R rows, B bodies.

    t         (R,)       time
    K         (R,)       kinetic energy, sum m v.v / 2
    U         (R,)       strain energy, sum V sigma:eps / 2, with the current volume V
    momentum  (R, 2)     sum m v
    centers   (R, B, 2)  center of mass of each body"""

    t: np.ndarray
    K: np.ndarray
    U: np.ndarray
    momentum: np.ndarray
    centers: np.ndarray


def hat(x, h):
    """Linear basis on a grid of cell size h that just encloses the points x (P, 2).

    Returns the node numbers (P, 4), the weights w = N(xi) N(eta) (P, 4), their gradients
    (P, 4, 2) in 1/length, and the number of nodes; N(s) = 1 - |s|, s the distance in cells.
    The numbers hold for these x only: the grid follows the points, and has no edge."""
    cell = np.floor(x / h).astype(int)
    s = (x / h - cell)[:, None, :]
    cell -= cell.min(0)
    size = cell.max(0) + 2
    N = np.where(CORNERS == 1, s, 1 - s)
    sign = 2 * CORNERS - 1
    node = (cell[:, None, :] + CORNERS) @ np.array([1, size[0]])
    return node, N[..., 0] * N[..., 1], sign * N[..., ::-1] / h, size.prod()


def to_grid(node, share, count):
    """Sum of the particles' shares (P, 4) or (P, 4, 2) at each of `count` nodes."""
    if share.ndim == 2:
        return np.bincount(node.ravel(), share.ravel(), count)
    return np.stack([to_grid(node, share[..., k], count) for k in range(2)], axis=1)


def run(x, v, V0, body, *, E, nu, rho, h, dt, end, cutoff=1e-8, every=1):
    """Free flight and collision of elastic bodies; returns a `History` of every `every`-th step.

        m_i = sum w m_p,  v_i = sum w m_p v_p / m_i,  a_i = -sum V sigma grad w / m_i
        v_p += dt sum w a_i,  x_p += dt sum w (v_i + dt a_i),  L = sum (v_i + dt a_i) (x) grad w
        eps += dt sym L,  J *= det(I + dt L),  V = J V0,  sigma = lam tr(eps) I + 2 mu eps

    x, v (P, 2), V0 (P,) volume per unit thickness, body (P,) numbers 0 ... B - 1; any one set of
    consistent units.  Nodes whose mass is not above `cutoff` neither move nor push."""
    lam, mu = E * nu / ((1 + nu) * (1 - 2 * nu)), E / (2 * (1 + nu))
    x, v, m = x.copy(), v.copy(), rho * V0
    eps, sigma, J = np.zeros((len(x), 2, 2)), np.zeros((len(x), 2, 2)), np.ones(len(x))
    share = (body == np.arange(body.max() + 1)[:, None]) * m
    share /= share.sum(1, keepdims=True)
    rows = []

    def note(step):
        K = 0.5 * (m * (v * v).sum(1)).sum()
        U = 0.5 * (J * V0 * (sigma * eps).sum((1, 2))).sum()
        rows.append((step * dt, K, U, m @ v, share @ x))

    note(0)
    for step in range(1, round(end / dt) + 1):
        node, w, dw, count = hat(x, h)
        mass = to_grid(node, w * m[:, None], count)
        p = to_grid(node, (w * m[:, None])[..., None] * v[:, None, :], count)
        f = to_grid(node, -(J * V0)[:, None, None] * (dw @ sigma), count)  # sigma is symmetric
        carries = mass > cutoff
        per_mass = np.divide(1, mass, out=np.zeros(count), where=carries)[:, None]
        a, v_new = f * per_mass, (p + dt * f) * per_mass
        v += dt * np.einsum("pi,pik->pk", w, a[node])
        x += dt * np.einsum("pi,pik->pk", w, v_new[node])
        if not dt * np.abs(v).max() < h:
            raise FloatingPointError(f"a particle crosses a cell within step {step}")
        L = v_new[node].swapaxes(1, 2) @ dw
        eps += 0.5 * dt * (L + L.swapaxes(1, 2))
        J *= (1 + dt * L[:, 0, 0]) * (1 + dt * L[:, 1, 1]) - dt**2 * L[:, 0, 1] * L[:, 1, 0]
        sigma = lam * np.trace(eps, axis1=1, axis2=2)[:, None, None] * np.eye(2) + 2 * mu * eps
        if step % every == 0:
            note(step)
    return History(*(np.array(column) for column in zip(*rows, strict=True)))


def lattice_disk(center, r, spacing):
    """The points (P, 2) of a square lattice, first point at spacing / 2, inside a circle."""
    line = (np.arange(np.ceil((max(center) + r) / spacing)) + 0.5) * spacing
    points = np.stack(np.meshgrid(line, line), axis=-1).reshape(-1, 2)
    return points[((points - center) ** 2).sum(1) < r**2]


def two_disks(dt=1e-3, end=3.5, shifts=((0.0, 0.0), (0.0, 0.0)), **options):
    """Two elastic disks that meet head on (Sulsky 1994; Sinaie et al. 2017, sec. 4.1): `History`.

    `shifts`, a length per disk and axis, moves each disk off its published place."""
    disks = [lattice_disk(c, 0.2, 0.025) for c in ((0.2, 0.2), (0.8, 0.8))]
    body = np.repeat([0, 1], [len(points) for points in disks])
    x = np.concatenate([p + shift for p, shift in zip(disks, shifts, strict=True)])
    v = np.where(body[:, None] == 0, 0.1, -0.1) * np.ones(2)
    V0 = np.full(len(x), 0.025**2)
    return run(x, v, V0, body, E=1000, nu=0.3, rho=1000, h=0.05, dt=dt, end=end, **options)
