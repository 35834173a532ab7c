"""Meshes: one material point per triangle or tetrahedron, at its centroid and with its volume.

gmsh and meshio are imported only when a scene asks for them.  No file of the user's is ever handed
to gmsh, which would run shell commands found in it: files are read by meshio."""

import warnings
from contextlib import redirect_stderr, redirect_stdout
from io import StringIO
from pathlib import Path
from typing import ClassVar, Literal

import numpy as np
from pydantic import Field

from .errors import InputError
from .gmsh_session import gmsh_session
from .model import Model, Positive, Vector
from .points import Points
from .shapes import Shape
from .simplices import PLURAL, refuse, simplex_points

LARGEST_MESH = 20_000_000
ELEMENTS_PER_CUBE = {2: 2.3, 3: 8.5}  # of the edge length: 4 / sqrt(3) and 6 sqrt(2), regular ones
GMSH_TYPE = {2: 2, 3: 4}
MESHIO_TYPE = {2: "triangle", 3: "tetra"}
MESHES = {".msh", ".vtu", ".vtk"}  # formats whose readers end on damaged files, too
GEOMETRY = {".geo", ".geo_unrolled", ".step", ".stp", ".iges", ".igs", ".brep"}


class GmshMesh(Model):
    """The shape, meshed by gmsh at one edge length.

    The volumes add up to that of the polygon or polyhedron, for a ball a little below the exact
    one.  One version of gmsh always makes the same mesh."""

    type: Literal["gmsh"] = "gmsh"
    size: Positive = Field(description="edge length of the elements [m]")

    needs_shape: ClassVar[bool] = True

    def points(self, shape: Shape, cell_size: float, dimension: int) -> Points:
        source = f"gmsh mesh of the {shape.type} at size {self.size:g}"
        expected = _expected_elements(shape, self.size)
        if not expected <= LARGEST_MESH:
            raise InputError(
                f"{source}: about {expected:.1g} {PLURAL[dimension]} to make, "
                f"{LARGEST_MESH:.0e} at most: take a larger size"
            )
        corners = _gmsh_simplices(shape, self.size, source)
        if len(corners) == 0:
            raise InputError(f"{source}: gmsh made no {PLURAL[dimension]}")
        return simplex_points(corners, source)


class MeshFile(Model):
    """The triangles (2D) or tetrahedra (3D) in a file, without the elements of their boundary.

    Each is listed once, nodes counter-clockwise (2D) or right-handed (3D)."""

    type: Literal["mesh"] = "mesh"
    file: str = Field(min_length=1, description="mesh: .msh (2.2 or 4.1), .vtu or .vtk")
    move: Vector | None = Field(
        default=None, description="added to the coordinates of the file [m]"
    )

    needs_shape: ClassVar[bool] = False

    def points(self, shape: None, cell_size: float, dimension: int) -> Points:
        move = [0.0] * dimension if self.move is None else self.move
        if len(move) != dimension:
            raise InputError(f"{self.file}: move needs {dimension} coordinates (got {len(move)})")
        path = Path(self.file)
        _refuse_format(path, dimension)
        if not path.is_file():
            raise InputError(f"{path}: no such file (looked for {path.absolute()})")
        nodes, blocks = _read(path)
        cells = _simplex_cells(blocks, dimension, path)
        if cells.shape[1] != dimension + 1 or cells.min() < 0 or cells.max() >= len(nodes):
            raise InputError(f"{path}: damaged: elements have nodes that are not in the file")
        corners = nodes[cells]
        if dimension == 2:
            _refuse_depth(corners, path)
        points = simplex_points(corners[:, :, :dimension] + np.array(move), str(path))
        _refuse_repeated(cells, points, path)
        return points


def _expected_elements(shape: Shape, size: float) -> float:
    """From the volume; for shapes thinner than one element, from their extent."""
    low, high = shape.bounds()
    with np.errstate(all="ignore"):
        by_volume = np.float64(shape.volume()) / np.float64(size) ** shape.dimension
        by_extent = np.prod(np.ceil((high - low) / size))
    return float(max(ELEMENTS_PER_CUBE[shape.dimension] * by_volume, by_extent))


def _gmsh_simplices(shape: Shape, size: float, source: str) -> np.ndarray:
    """Corners [n, dim + 1, dim] [m] of the triangles or tetrahedra that fill the shape."""
    with gmsh_session() as gmsh:
        try:
            shape.add_to_gmsh(gmsh)
            gmsh.model.occ.synchronize()
            gmsh.option.setNumber("Mesh.MeshSizeMin", size)
            gmsh.option.setNumber("Mesh.MeshSizeMax", size)
            gmsh.model.mesh.generate(shape.dimension)
            tags, coordinates, _ = gmsh.model.mesh.getNodes()
            _, cells = gmsh.model.mesh.getElementsByType(GMSH_TYPE[shape.dimension])
        except Exception as error:  # the only class that gmsh raises
            raise InputError(f"{source}: gmsh failed: {error}") from error
    nodes = np.zeros((int(np.max(tags)) + 1, 3))
    nodes[tags] = np.reshape(coordinates, (-1, 3))
    return nodes[np.reshape(cells, (-1, shape.dimension + 1)), : shape.dimension]


def _refuse_format(path: Path, dimension: int):
    """Only meshes, and only in formats that are read safely; how to come by one otherwise."""
    suffix = path.suffix.lower()
    if suffix in GEOMETRY:
        raise InputError(
            f"{path} is geometry, not yet a mesh: run "
            f"`gmsh -{dimension} {path.name} -o {path.stem}.msh` and name the .msh here"
        )
    if suffix not in MESHES:
        raise InputError(
            f"{path}: a mesh is read from {', '.join(sorted(MESHES))}: run "
            f"`meshio convert {path.name} {path.stem}.vtu` and name the .vtu here"
        )


def _read(path: Path) -> tuple[np.ndarray, list[tuple[str, int, np.ndarray]]]:
    """Nodes [m], float64 [n, 3], and blocks of elements: type, dimension, nodes int64 [m, k]."""
    try:
        import meshio
    except ImportError as error:
        raise InputError(f"{path}: reading it needs meshio: pip install meshio") from error
    reasons, remarks = StringIO(), StringIO()
    try:
        with redirect_stdout(reasons), redirect_stderr(remarks), warnings.catch_warnings():
            warnings.simplefilter("ignore")
            mesh = meshio.read(path)
            nodes = np.zeros((len(mesh.points), 3))
            nodes[:, : mesh.points.shape[1]] = mesh.points
            blocks = [(b.type, b.dim, np.asarray(b.data).astype(np.int64)) for b in mesh.cells]
    except (SystemExit, Exception) as error:  # meshio leaves the program over some bad files
        why = reasons.getvalue() if isinstance(error, SystemExit) else repr(error)
        why = " ".join(why.split()) or "meshio cannot read it"
        raise InputError(f"{path}: damaged, or not such a file inside: {why}") from error
    if "not closed by" in " ".join(remarks.getvalue().split()):
        raise InputError(f"{path}: damaged: the file ends early")
    return nodes, blocks


def _simplex_cells(blocks, dimension: int, path: Path) -> np.ndarray:
    """Nodes [n, dim + 1], n >= 1, of the triangles or tetrahedra among the blocks."""
    wanted = MESHIO_TYPE[dimension]
    counts = {kind: 0 for kind, _, _ in blocks}
    for kind, dim, cells in blocks:
        counts[kind] += len(cells)
        if len(cells) and dim >= dimension and kind != wanted:
            raise InputError(
                f"{path}: has elements of type {kind}; a body in {dimension}D is made of "
                f"{PLURAL[dimension]} with straight edges (type {wanted}) alone"
            )
    if not counts.get(wanted):
        found = ", ".join(f"{count} {kind}" for kind, count in counts.items()) or "no elements"
        raise InputError(
            f"{path}: no {PLURAL[dimension]} in it (but {found}); gmsh writes them with "
            f"-{dimension}, and where it has physical groups only those"
        )
    return np.concatenate([cells for kind, _, cells in blocks if kind == wanted and len(cells)])


def _refuse_depth(corners: np.ndarray, path: Path):
    """The triangles [n, 3, 3] must lie at one z, to 1e-9 of their extent."""
    low, high = corners.min(axis=(0, 1)), corners.max(axis=(0, 1))
    if high[2] - low[2] > 1e-9 * (high - low)[:2].max():
        raise InputError(
            f"{path}: z runs from {low[2]:g} to {high[2]:g}; a body in 2D needs a mesh at one z"
        )


def _refuse_repeated(cells: np.ndarray, points: Points, path: Path):
    """An element that is listed twice would count its mass twice."""
    _, first = np.unique(np.sort(cells, axis=1), axis=0, return_index=True)
    repeated = np.ones(len(cells), dtype=bool)
    repeated[first] = False
    refuse(repeated, "are listed twice, in two physical groups perhaps", points.x, str(path))
