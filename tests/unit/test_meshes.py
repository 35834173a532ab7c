"""Meshes of gmsh's and of files: volumes, first moments, and a plain error for everything bad."""

import os
import resource
import signal
import subprocess
import sys
import threading
from itertools import permutations, product
from math import pi
from pathlib import Path

import gmsh
import meshio
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mpm_taichi.errors import InputError
from mpm_taichi.gmsh_session import SYSTEM_LIBRARIES, gmsh_session
from mpm_taichi.meshes import GmshMesh, MeshFile
from mpm_taichi.shapes import Ball, Box

DISK = Ball(type="ball", center=[0.2, 0.3], radius=0.2)
BALL = Ball(type="ball", center=[0.2, 0.3, -0.1], radius=0.2)
SHEET = Box(type="box", min=[-0.1, 0.2], max=[0.5, 0.5])
BLOCK = Box(type="box", min=[-0.1, 0.2, 0.0], max=[0.5, 0.5, 0.2])
SOLID = {2: "triangle", 3: "tetra"}
FACE = {2: "line", 3: "triangle"}
FORMATS = {
    "msh22_ascii": (".msh", {"file_format": "gmsh22", "binary": False}),
    "msh22_binary": (".msh", {"file_format": "gmsh22", "binary": True}),
    "msh41_ascii": (".msh", {"file_format": "gmsh", "binary": False}),
    "msh41_binary": (".msh", {"file_format": "gmsh", "binary": True}),
    "vtu_ascii": (".vtu", {"binary": False}),
    "vtu_binary": (".vtu", {"binary": True}),
    "vtk_binary": (".vtk", {"binary": True}),
    "vtk_ascii": (".vtk", {"file_format": "vtk42", "binary": False}),
}
every_dimension = pytest.mark.parametrize("dim", [2, 3])


def mesh(shape, size):
    return GmshMesh(type="gmsh", size=size).points(shape, 0.05, shape.dimension)


def read(path, dim, **given):
    return MeshFile(type="mesh", file=str(path), **given).points(None, 0.05, dim)


def refused(path, dim, words, **given):
    """The words of the InputError, which name the file."""
    with pytest.raises(InputError, match=words) as caught:
        read(path, dim, **given)
    assert path.name in str(caught.value)


def write(path, nodes, *blocks, **options):
    """A mesh file; nodes of a 2D mesh get z = 0.  What meshio says on the way is left unsaid."""
    nodes = np.asarray(nodes, dtype=float)
    nodes = np.pad(nodes, ((0, 0), (0, 3 - nodes.shape[1])))
    meshio.write(path, meshio.Mesh(nodes, list(blocks)), **options)
    return path


def cube_mesh(dim, rng, cells=3):
    """Nodes [n, dim], simplices [m, dim + 1] of a bent unit cube, and the corners of its elements.

    Each cell is cut along its diagonal (Kuhn): one simplex per order of the axes, with orientation
    that of the permutation, so every other one is turned over."""
    index = np.arange((cells + 1) ** dim).reshape((cells + 1,) * dim)
    nodes = np.stack(np.meshgrid(*[np.linspace(0, 1, cells + 1)] * dim, indexing="ij"), axis=-1)
    nodes = nodes.reshape(-1, dim) + rng.uniform(-0.04, 0.04, ((cells + 1) ** dim, dim))
    simplices = []
    for corner in product(range(cells), repeat=dim):
        for order in permutations(range(dim)):
            path = [np.array(corner)]
            for axis in order:
                path.append(path[-1] + (np.arange(dim) == axis))
            simplex = [index[tuple(point)] for point in path]
            inversions = sum(a > b for k, a in enumerate(order) for b in order[k + 1 :])
            if inversions % 2:
                simplex[0], simplex[1] = simplex[1], simplex[0]
            simplices.append(simplex)
    simplices = np.array(simplices)
    return nodes, simplices, nodes[simplices]


def volumes(corners):
    """Area by the shoelace formula, volume by the triple product, written out."""
    if corners.shape[2] == 2:
        (ax, ay), (bx, by), (cx, cy) = np.moveaxis(corners, 0, -1)
        return (ax * (by - cy) + bx * (cy - ay) + cx * (ay - by)) / 2
    a, b, c, d = np.moveaxis(corners, 1, 0)
    return np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) / 6


@pytest.mark.parametrize("shape, size", [(SHEET, 0.05), (BLOCK, 0.1), (SHEET, 5.0)])
def test_gmsh_fills_a_box_exactly(shape, size):
    """Sum V0 is the volume, sum V0 x the first moment, whatever the mesh: rounding of the sums.

    The centroid rule is exact for linear functions."""
    x, V0 = mesh(shape, size)
    assert x.shape == (len(V0), shape.dimension)
    assert V0.sum() == pytest.approx(shape.volume(), rel=1e-12)
    center = np.mean(shape.bounds(), axis=0)
    np.testing.assert_allclose(V0 @ x, shape.volume() * center, rtol=0, atol=1e-12)


def test_gmsh_meshes_the_polygon_in_a_disk():
    """n nodes on the circle, about 2 pi r / size: the area lacks (2 pi / n)^2 / 6 of the disk's."""
    for size in (0.06, 0.03):
        V0 = mesh(DISK, size).V0
        deficit = 1 - V0.sum() / (pi * 0.2**2)
        assert deficit == pytest.approx((size / 0.2) ** 2 / 6, rel=0.15)


def test_gmsh_meshes_the_polyhedron_in_a_ball():
    """All volume is inside the ball, and halving the size leaves about a quarter of the deficit."""
    deficits = []
    for size in (0.06, 0.03):
        x, V0 = mesh(BALL, size)
        assert (BALL.signed_distance(x) < 0).all()
        deficits.append(1 - V0.sum() / BALL.volume())
    assert deficits[1] > 0
    assert 2.5 < deficits[0] / deficits[1] < 6


@pytest.mark.parametrize("shape, regular", [(DISK, np.sqrt(3) / 4), (BALL, 1 / np.sqrt(72))])
def test_gmsh_honors_the_size(shape, regular):
    """The mean element is the regular one of that edge within a factor of two."""
    size = 0.04
    mean = mesh(shape, size).V0.mean()
    assert 0.5 < mean / (regular * size**shape.dimension) < 2


def test_gmsh_repeats_itself():
    """The same body gives the same bits, with another body meshed in between."""
    first = mesh(DISK, 0.05)
    mesh(BLOCK, 0.1)
    again = mesh(DISK, 0.05)
    np.testing.assert_array_equal(first.x, again.x)
    np.testing.assert_array_equal(first.V0, again.V0)


def test_gmsh_leaves_no_trace(tmp_path):
    """No output, no files in the folder or at home, no configuration read, and Ctrl-C as before.

    A process of its own: were SIGINT back at the system, it would end the test run."""
    (tmp_path / ".gmshrc").write_text("Mesh.MeshSizeFactor = 5;\n")
    (tmp_path / ".petscrc").write_text("-help\n")
    code = (
        "import signal\n"
        "from mpm_taichi.meshes import GmshMesh\n"
        "from mpm_taichi.shapes import Ball\n"
        "before = signal.getsignal(signal.SIGINT)\n"
        "ball = Ball(type='ball', center=[0.2, 0.3], radius=0.2)\n"
        "count = len(GmshMesh(type='gmsh', size=0.05).points(ball, 0.05, 2).V0)\n"
        "assert signal.getsignal(signal.SIGINT) is before\n"
        "try:\n"
        "    signal.raise_signal(signal.SIGINT)\n"
        "except KeyboardInterrupt:\n"
        "    print(count)\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", code],
        cwd=tmp_path,
        env={**os.environ, "HOME": str(tmp_path), "TMPDIR": str(tmp_path)},
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert (done.stdout, done.stderr) == (f"{len(mesh(DISK, 0.05).V0)}\n", "")
    assert {path.name for path in tmp_path.iterdir()} == {".gmshrc", ".petscrc"}


def test_gmsh_works_in_a_thread():
    """Without a hand on signals, it need not be the main thread."""
    found = []
    thread = threading.Thread(target=lambda: found.append(mesh(SHEET, 0.1)))
    thread.start()
    thread.join()
    assert found[0].V0.sum() == pytest.approx(SHEET.volume(), rel=1e-12)


THREAD = Box(type="box", min=[0, 0], max=[1e6, 1e-6])


@pytest.mark.parametrize(
    "shape, size", [(DISK, 1e-5), (BALL, 1e-3), (BALL, 1e-300), (THREAD, 1e-2)]
)
def test_too_many_elements_are_refused_before_meshing(shape, size, monkeypatch):
    """More than 20 million, by volume or by length: said without a start of gmsh."""
    monkeypatch.setitem(sys.modules, "gmsh", None)
    with pytest.raises(InputError, match="larger size"):
        mesh(shape, size)


def test_a_failure_of_gmsh_is_an_input_error():
    """A box below the tolerance of its geometry (1e-7): in words, and gmsh is closed after it."""
    with pytest.raises(InputError, match="gmsh mesh of the box at size 1e-09: gmsh failed"):
        mesh(Box(type="box", min=[0, 0], max=[1e-8, 1e-8]), 1e-9)
    assert not gmsh.isInitialized()
    assert mesh(SHEET, 0.1).V0.sum() == pytest.approx(SHEET.volume(), rel=1e-12)


def test_gmsh_in_use_is_left_alone(monkeypatch):
    """A session of the caller's own keeps its model."""
    monkeypatch.setenv("HOME", os.devnull)
    gmsh.initialize(readConfigFiles=False, interruptible=False)
    try:
        gmsh.model.add("mine")
        with pytest.raises(InputError, match="in use"):
            mesh(DISK, 0.1)
        assert gmsh.model.getCurrent() == "mine"
    finally:
        gmsh.finalize()


def test_missing_libraries_name_the_packages(tmp_path, monkeypatch):
    """`import gmsh` fails with OSError on a bare system: the message is the line to type."""
    (tmp_path / "gmsh.py").write_text(
        "raise OSError('libGLU.so.1: cannot open shared object file')\n"
    )
    monkeypatch.delitem(sys.modules, "gmsh")
    monkeypatch.syspath_prepend(tmp_path)
    with pytest.raises(InputError, match=r"libGLU\.so\.1") as caught:
        mesh(DISK, 0.1)
    assert f"apt-get install {SYSTEM_LIBRARIES}" in str(caught.value)


def test_missing_packages_are_named(tmp_path, monkeypatch):
    """Without gmsh or meshio: what to install."""
    path = write(tmp_path / "a.vtu", [[0, 0], [1, 0], [0, 1]], ("triangle", [[0, 1, 2]]))
    monkeypatch.setitem(sys.modules, "gmsh", None)
    monkeypatch.setitem(sys.modules, "meshio", None)
    with pytest.raises(InputError, match="pip install gmsh"):
        mesh(DISK, 0.1)
    refused(path, 2, "pip install meshio")


@every_dimension
@pytest.mark.parametrize("name", FORMATS)
def test_files_give_centroids_and_volumes(name, dim, tmp_path, rng, capfd):
    """Each simplex in the file's order, without the boundary: to the digits of the format.

    meshio writes no boundary to MSH 4.1 (gmsh does, below), and 12 digits to an ASCII .vtu."""
    suffix, options = FORMATS[name]
    nodes, cells, corners = cube_mesh(dim, rng)
    path = tmp_path / f"cube{suffix}"
    blocks = [(SOLID[dim], cells)]
    if not name.startswith("msh41"):
        faces = (FACE[dim], cells[:4, :dim])
        blocks = [
            ("vertex", cells[:1, :1]),
            (SOLID[dim], cells[:5]),
            faces,
            (SOLID[dim], cells[5:]),
        ]
    write(path, nodes, *blocks, **options)
    digits = 1e-11 if name == "vtu_ascii" else 1e-15
    capfd.readouterr()
    x, V0 = read(path, dim)
    assert capfd.readouterr() == ("", "")
    np.testing.assert_allclose(V0, volumes(corners), rtol=0, atol=digits)
    np.testing.assert_allclose(x, corners.sum(axis=1) / (dim + 1), rtol=0, atol=digits)


@pytest.mark.parametrize("version, binary", [(2.2, 0), (2.2, 1), (4.1, 0), (4.1, 1)])
@pytest.mark.parametrize("shape", [DISK, BALL], ids=["disk", "ball"])
def test_files_of_gmsh_equal_its_mesh(shape, version, binary, tmp_path):
    """gmsh's own file, read back, and the mesh made here: the same points in the same order."""
    path = tmp_path / "part.msh"
    with gmsh_session() as gmsh:
        shape.add_to_gmsh(gmsh)
        gmsh.model.occ.synchronize()
        gmsh.option.setNumber("Mesh.MeshSizeMin", 0.08)
        gmsh.option.setNumber("Mesh.MeshSizeMax", 0.08)
        gmsh.model.mesh.generate(shape.dimension)
        gmsh.option.setNumber("Mesh.MshFileVersion", version)
        gmsh.option.setNumber("Mesh.Binary", binary)
        gmsh.write(str(path))
    here, there = mesh(shape, 0.08), read(path, shape.dimension)
    np.testing.assert_allclose(there.x, here.x, rtol=0, atol=1e-14)
    np.testing.assert_allclose(there.V0, here.V0, rtol=1e-10)


@every_dimension
def test_move_is_added(dim, tmp_path, rng):
    """x + move, volumes as they were to the rounding of the shifted coordinates."""
    nodes, cells, _ = cube_mesh(dim, rng)
    path = write(tmp_path / "cube.vtu", nodes, (SOLID[dim], cells))
    still = read(path, dim)
    moved = read(path, dim, move=[2.0, -1.0, 0.5][:dim])
    np.testing.assert_allclose(moved.x, still.x + [2.0, -1.0, 0.5][:dim], atol=1e-15)
    np.testing.assert_allclose(moved.V0, still.V0, rtol=1e-12)


def test_a_move_of_the_wrong_length_is_refused(tmp_path):
    """Three numbers in 2D."""
    refused(tmp_path / "a.vtu", 2, r"move needs 2 coordinates \(got 3\)", move=[1.0, 2.0, 3.0])


def test_a_flat_mesh_may_lie_at_any_height(tmp_path):
    """z = 7 throughout is a 2D mesh; a corner at another z is not."""
    corners = np.array([[0, 0, 7.0], [1, 0, 7.0], [0, 1, 7.0]])
    path = write(tmp_path / "a.vtu", corners, ("triangle", [[0, 1, 2]]))
    assert read(path, 2).V0.tolist() == [0.5]
    corners[2, 2] = 7.01
    refused(write(path, corners, ("triangle", [[0, 1, 2]])), 2, r"z runs from 7 to 7\.01")


def test_missing_files_are_named(tmp_path):
    """The message has the place looked at; a folder is no file."""
    refused(tmp_path / "none.msh", 2, "no such file")
    (tmp_path / "folder.msh").mkdir()
    refused(tmp_path / "folder.msh", 2, "no such file")


@pytest.mark.parametrize("suffix", [".geo", ".geo_unrolled", ".STEP", ".stp", ".brep", ".igs"])
def test_geometry_is_refused_with_the_way_round(suffix, tmp_path):
    """gmsh is never given a file of the user's: he runs it himself."""
    marker = tmp_path / "ran"
    path = tmp_path / f"part{suffix}"
    path.write_text(f'SystemCall "touch {marker}";\nPoint(1) = {{0, 0, 0, 1}};\n')
    refused(path, 3, rf"geometry.*`gmsh -3 part{suffix} -o part\.msh`")
    refused(path, 2, rf"`gmsh -2 part{suffix} -o part\.msh`")
    assert not marker.exists()


@pytest.mark.parametrize("name", ["part.stl", "part.inp", "part.msh.txt", "part"])
def test_other_formats_are_refused_with_the_way_round(name, tmp_path):
    """meshio's other readers may never end on a damaged file; its converter makes a .vtu."""
    path = tmp_path / name
    path.write_text("solid\n")
    refused(path, 3, rf"`meshio convert {name} \S+\.vtu`")


@pytest.mark.parametrize("suffix", [".msh", ".vtu", ".vtk"])
def test_geometry_text_in_a_mesh_file_is_not_run(suffix, tmp_path, capfd):
    """gmsh would carry out the command whatever the name of the file: nobody does here."""
    marker = tmp_path / "ran"
    path = tmp_path / f"part{suffix}"
    path.write_text(f'SystemCall "touch {marker}";\nPoint(1) = {{0, 0, 0, 1}};\n')
    refused(path, 2, "damaged")
    assert not marker.exists()
    assert capfd.readouterr() == ("", "")


QUAD = ([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1]], "quad", [[0, 1, 2, 3]])
TETRA = (QUAD[0], "tetra", [[0, 1, 3, 4]])
SURFACE = (QUAD[0], "triangle", [[0, 1, 3], [1, 2, 3]])
CURVED = (np.eye(6, 3), "triangle6", [[0, 1, 2, 3, 4, 5]])
LINES = (QUAD[0], "line", [[0, 1], [1, 2]])


@pytest.mark.parametrize(
    "content, dim, words",
    [
        (QUAD, 2, "type quad; a body in 2D is made of triangles"),
        (CURVED, 2, "type triangle6.*straight edges"),
        (TETRA, 2, "type tetra; a body in 2D is made of triangles"),
        (SURFACE, 3, r"no tetrahedra in it \(but 2 triangle\).*-3"),
        (LINES, 2, r"no triangles in it \(but 2 line\).*-2.*physical groups"),
    ],
)
def test_other_elements_are_refused(content, dim, words, tmp_path):
    """Quads, curved elements, the wrong dimension, and a boundary without an inside."""
    nodes, kind, cells = content
    refused(write(tmp_path / "a.vtu", nodes, (kind, cells)), dim, words)


def test_an_empty_mesh_is_refused(tmp_path):
    """Nodes without elements."""
    refused(write(tmp_path / "a.vtu", QUAD[0]), 2, "no elements|damaged")


@every_dimension
def test_flat_elements_are_refused(dim, tmp_path, rng):
    """An element whose last node lies on the others: counted, numbered, and located."""
    nodes, cells, corners = cube_mesh(dim, rng)
    flat = corners[6].copy()
    flat[-1] = flat[:-1].mean(axis=0)
    nodes = np.vstack([nodes, flat])
    cells[6] = len(nodes) - dim - 1 + np.arange(dim + 1)
    path = write(tmp_path / "a.vtu", nodes, (SOLID[dim], cells))
    place = ", ".join(f"{value:g}" for value in flat.mean(axis=0))
    refused(path, dim, rf"1 of {len(cells)} t\w+ have zero volume.* number 7, at \({place}\)")


@every_dimension
def test_inverted_elements_are_refused(dim, tmp_path, rng):
    """One of them, or all: a mesh that is turned over is told how to be turned back."""
    nodes, cells, _ = cube_mesh(dim, rng)
    turned = cells.copy()
    turned[3, :2] = turned[3, 1::-1]
    path = write(tmp_path / "a.vtu", nodes, (SOLID[dim], turned))
    refused(path, dim, rf"1 of {len(cells)} t\w+ are inverted.*number 4")
    cells[:, :2] = cells[:, 1::-1]
    write(path, nodes, (SOLID[dim], cells))
    refused(path, dim, rf"{len(cells)} of {len(cells)} t\w+ are inverted")


@every_dimension
@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_coordinates_that_are_no_places_are_refused(value, dim, tmp_path, rng):
    """nan and infinity; a node of no element may be anything."""
    nodes, cells, _ = cube_mesh(dim, rng)
    path = write(tmp_path / "a.vtu", [*nodes, [value] * dim], (SOLID[dim], cells))
    assert len(read(path, dim).V0) == len(cells)
    nodes[cells[5, 1], dim - 1] = value
    write(path, nodes, (SOLID[dim], cells))
    refused(path, dim, "not finite, or far too large")


@every_dimension
def test_volumes_that_are_no_numbers_are_refused(dim, tmp_path, rng):
    """Edges of 1e200 overflow, edges of 1e-200 vanish."""
    nodes, cells, _ = cube_mesh(dim, rng)
    path = write(tmp_path / "a.vtu", 1e200 * nodes, (SOLID[dim], cells))
    refused(path, dim, rf"{len(cells)} of {len(cells)} t\w+ have.*far too large")
    write(path, 1e-200 * nodes, (SOLID[dim], cells))
    refused(path, dim, "zero volume")


@pytest.mark.parametrize("node", [-1, 4, 2**40])
def test_nodes_that_are_not_there_are_refused(node, tmp_path):
    """-1 would be the last node to NumPy."""
    square = [[0, 0], [1, 0], [1, 1], [0, 1]]
    path = write(tmp_path / "a.vtu", square, ("triangle", [[0, 1, 2], [0, 2, node]]), binary=False)
    refused(path, 2, "not in the file")


@every_dimension
def test_elements_listed_twice_are_refused(dim, tmp_path, rng):
    """MSH 2.2 lists an element once per physical group: its mass would count twice."""
    nodes, cells, _ = cube_mesh(dim, rng)
    again = np.roll(cells[2:4], 1 if dim == 2 else 2, axis=1)
    if dim == 3:
        assert (volumes(nodes[again]) > 0).all()
    path = write(tmp_path / "a.vtu", nodes, (SOLID[dim], np.vstack([cells, again])))
    refused(path, dim, rf"2 of {len(cells) + 2} t\w+ are listed twice")


@every_dimension
@pytest.mark.parametrize("name", FORMATS)
def test_truncated_files_are_refused(name, dim, tmp_path, rng):
    """Cut anywhere in its first nine tenths, a file has lost elements."""
    suffix, options = FORMATS[name]
    nodes, cells, _ = cube_mesh(dim, rng)
    path = write(tmp_path / f"a{suffix}", nodes, (SOLID[dim], cells), **options)
    data = path.read_bytes()
    end = len(data) if suffix != ".vtk" else data.index(b"CELL_TYPES")
    for share in rng.uniform(0, 0.9, 10):
        path.write_bytes(data[: int(share * end)])
        refused(path, dim, "damaged|no t")


def test_the_last_number_of_a_truncated_file_is_not_believed(tmp_path, rng):
    """12 cut to 1 is a number, too: a MSH file must end where it says."""
    nodes, cells, _ = cube_mesh(2, rng)
    path = write(tmp_path / "a.msh", nodes, ("triangle", cells), **FORMATS["msh41_ascii"][1])
    data = path.read_bytes()
    path.write_bytes(data[: data.index(b"\n$EndElements")])
    refused(path, 2, "ends early")


@pytest.fixture
def bounded_memory():
    """2 GiB more than now: a damaged count makes meshio ask for far more, here in vain."""
    pages = int(Path("/proc/self/statm").read_text().split()[0])
    limit, most = resource.getrlimit(resource.RLIMIT_AS)
    resource.setrlimit(resource.RLIMIT_AS, (pages * resource.getpagesize() + 2**31, most))
    yield
    resource.setrlimit(resource.RLIMIT_AS, (limit, most))


@every_dimension
def test_damage_gives_points_or_an_input_error(dim, tmp_path, rng, capfd, bounded_memory):
    """Flipped bytes and lost ends: valid points or words, no other exception, nothing printed."""
    nodes, cells, _ = cube_mesh(dim, rng, cells=2)
    intact = []
    for name, (suffix, options) in FORMATS.items():
        path = tmp_path / f"{name}{suffix}"
        write(path, nodes, (SOLID[dim], cells), **options)
        intact.append((suffix, path.read_bytes()))
    share = st.floats(0, 1, exclude_max=True)
    flips = st.lists(st.tuples(share, st.integers(0, 255)), max_size=4)

    @settings(max_examples=150, deadline=None, database=None)
    @given(st.sampled_from(intact), flips, st.none() | share)
    def damaged(original, flips, cut):
        suffix, data = original[0], bytearray(original[1])
        for place, byte in flips:
            data[int(place * len(data))] = byte
        path = tmp_path / f"damaged{suffix}"
        path.write_bytes(data if cut is None else data[: int(cut * len(data))])
        try:
            x, V0 = read(path, dim)
        except InputError as error:
            assert str(path) in str(error)
        else:
            assert x.shape == (len(V0), dim) and len(V0) > 0
            assert np.isfinite(x).all() and np.isfinite(V0).all() and (V0 > 0).all()

    before = signal.getsignal(signal.SIGINT)
    capfd.readouterr()
    damaged()
    assert capfd.readouterr() == ("", "")
    assert signal.getsignal(signal.SIGINT) is before


def test_a_broken_pipe_raises_after_gmsh():
    """gmsh sets SIGPIPE to end the process: after a session a pipe without a reader is an error of
    Python's again, as for `| head` and for ffmpeg that has given up."""
    with gmsh_session():
        pass
    reader, writer = os.pipe()
    os.close(reader)
    with pytest.raises(BrokenPipeError):
        os.write(writer, b"x")
    os.close(writer)
