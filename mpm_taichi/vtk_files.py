"""Writes the XML files of VTK that ParaView reads: particles (.vtp), grids (.vti), series (.pvd).

The numbers lie behind the XML as raw bytes, little-endian; a file appears whole.  Source: VTK File
Formats, docs.vtk.org (VTK 9.5)."""

from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import NamedTuple
from xml.sax.saxutils import quoteattr

import numpy as np

from .whole_files import beside, write_text

SYMMETRIC = ((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2))
"""VTK's order of the components of a symmetric tensor."""

NAMES = {"<f4": "Float32", "<i4": "Int32"}


class Column(NamedTuple):
    """An array [n] or [n, components], made when it is written: one at a time takes memory."""

    name: str
    components: int
    kind: str  # of NAMES
    make: Callable[[], np.ndarray]


def scalar(name: str, values: np.ndarray) -> Column:
    """[n]"""
    return Column(name, 1, "<f4", lambda: values)


def whole(name: str, values: np.ndarray) -> Column:
    """Whole numbers [n]."""
    return Column(name, 1, "<i4", lambda: values)


def vector(name: str, values: np.ndarray) -> Column:
    """[n, dim]; z is 0 in 2D."""
    missing = 3 - values.shape[1]
    return Column(name, 3, "<f4", lambda: np.pad(values, ((0, 0), (0, missing))))


def symmetric_tensor(name: str, values: np.ndarray) -> Column:
    """[n, 3, 3]"""
    return Column(name, 6, "<f4", lambda: np.stack([values[:, i, j] for i, j in SYMMETRIC], axis=1))


def tensor(name: str, values: np.ndarray) -> Column:
    """[n, dim, dim], row by row; zz is 1 in 2D, where nothing is stretched out of the plane."""

    def make():
        padded = np.broadcast_to(np.eye(3, dtype="<f4"), (len(values), 3, 3)).copy()
        dim = values.shape[1]
        padded[:, :dim, :dim] = values
        return padded

    return Column(name, 9, "<f4", make)


def write_vtp(path: Path, time: float, position: np.ndarray, columns: Sequence[Column]) -> None:
    """Particles at position [n, dim] (m), each a point and a cell, without which ParaView would not
    show it."""
    n = len(position)
    file = _Appended(n)
    cells = (
        whole("connectivity", np.arange(n)),
        whole("offsets", np.arange(1, n + 1)),
    )
    points = [vector("position [m]", position)]
    file.write(
        path, "PolyData", "", time,
        f'<Piece NumberOfPoints="{n}" NumberOfVerts="{n}" NumberOfLines="0" NumberOfStrips="0" '
        f'NumberOfPolys="0">{file.tags("PointData", columns)}{file.tags("Points", points)}'
        f'{file.tags("Verts", cells)}</Piece>',
    )  # fmt: skip


def write_vti(
    path: Path, time: float, nodes: Sequence[int], spacing: float, columns: Sequence[Column]
) -> None:
    """nodes[0] x nodes[1] (x nodes[2]) nodes from the origin on, those along x side by side."""
    counts = (*nodes, 1)[:3]
    file = _Appended(int(np.prod(counts)))
    extent = " ".join(f"0 {count - 1}" for count in counts)
    place = f' WholeExtent="{extent}" Origin="0 0 0" Spacing="{" ".join([repr(spacing)] * 3)}"'
    piece = f'<Piece Extent="{extent}">{file.tags("PointData", columns)}</Piece>'
    file.write(path, "ImageData", place, time, piece)


def write_pvd(path: Path, files: Iterable[tuple[float, str]]) -> None:
    """Times [s] and the files beside `path` that show them."""
    sets = "\n".join(
        f'<DataSet timestep="{float(time)!r}" file={quoteattr(f)}/>' for time, f in files
    )
    write_text(
        path,
        '<?xml version="1.0"?>\n<VTKFile type="Collection" version="1.0" '
        f'byte_order="LittleEndian"><Collection>\n{sets}\n</Collection></VTKFile>\n',
    )


class _Appended:
    """A file under way: columns of n rows, whose numbers follow the XML."""

    def __init__(self, n: int):
        self.n, self.offset = n, 0
        self.columns: list[Column] = []

    def tags(self, section: str, columns: Sequence[Column]) -> str:
        text = ""
        for column in columns:
            text += (
                f'<DataArray type="{NAMES[column.kind]}" Name={quoteattr(column.name)} '
                f'NumberOfComponents="{column.components}" format="appended" '
                f'offset="{self.offset}"/>'
            )
            self.columns.append(column)
            self.offset += 8 + self._size(column)
        return f"<{section}>{text}</{section}>"

    def write(self, path: Path, kind: str, attributes: str, time: float, piece: str) -> None:
        with beside(path) as part, part.open("wb") as file:
            file.write(
                f'<?xml version="1.0"?>\n<VTKFile type="{kind}" version="1.0" byte_order='
                f'"LittleEndian" header_type="UInt64"><{kind}{attributes}><FieldData><DataArray '
                'type="Float64" Name="TimeValue" NumberOfTuples="1" format="ascii">'
                f"{float(time)!r}</DataArray></FieldData>{piece}</{kind}>"
                '<AppendedData encoding="raw">_'.encode()
            )
            for column in self.columns:
                file.write(np.array(self._size(column), "<u8").tobytes())
                file.write(np.ascontiguousarray(column.make(), column.kind).data)
            file.write(b"</AppendedData></VTKFile>\n")

    def _size(self, column):
        return self.n * column.components * np.dtype(column.kind).itemsize
