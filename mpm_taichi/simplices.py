"""Triangles and tetrahedra as material points."""

from math import factorial

import numpy as np

from .errors import InputError
from .points import Points

PLURAL = {2: "triangles", 3: "tetrahedra"}
FLAT = 1e-12
ORIENTATION = {
    2: "their nodes run clockwise (in gmsh, `ReverseMesh Surface{...};` turns them)",
    3: "their first three nodes do not point at the fourth by the right-hand rule",
}


def simplex_points(corners: np.ndarray, source: str) -> Points:
    """Centroids [m] and volumes V0 = det(edges) / dim! [m^dim] for corners [n, dim + 1, dim] [m].

    Each V0 is finite and positive, above FLAT times the median; an element for which it is not is
    an InputError that begins with `source`."""
    dimension = corners.shape[2]
    with np.errstate(all="ignore"):
        x = corners.mean(axis=1)
        V0 = np.linalg.det(corners[:, 1:] - corners[:, :1]) / factorial(dimension)
        finite = np.isfinite(x).all(axis=1) & np.isfinite(V0)
        flat = np.abs(V0) <= FLAT * np.median(np.abs(V0))
    refuse(~finite, "have coordinates that are not finite, or far too large", x, source)
    refuse(flat, "have zero volume", x, source)
    refuse(V0 < 0, f"are inverted: {ORIENTATION[dimension]}", x, source)
    return Points(x, V0)


def refuse(bad: np.ndarray, why: str, x: np.ndarray, source: str):
    """InputError that counts the `bad` elements [n] and locates the first, if there are any."""
    if bad.any():
        first = int(bad.argmax())
        place = ", ".join(f"{coordinate:g}" for coordinate in x[first])
        raise InputError(
            f"{source}: {bad.sum()} of {len(bad)} {PLURAL[x.shape[1]]} {why}; "
            f"the first is number {first + 1}, at ({place})"
        )
