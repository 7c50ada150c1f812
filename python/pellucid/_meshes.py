# SPDX-License-Identifier: Apache-2.0
"""Cells of meshes as users have them: meshio's, VTK's, or an array."""
from __future__ import annotations

import re
from typing import Any, List, NamedTuple, Optional, Sequence, Tuple

import numpy

from . import _masks
from ._pellucid import Error, Mesh

# meshio's names of cells with a volume whose points VTK numbers alike, and VTK's numbers.
_NUMBERS = {
    "tetra": 10, "voxel": 11, "hexahedron": 12, "wedge": 13, "pyramid": 14, "penta_prism": 15,
    "hexa_prism": 16, "tetra10": 24, "hexahedron20": 25, "wedge15": 26, "pyramid13": 27,
    "hexahedron27": 29, "wedge12": 31, "wedge18": 32, "hexahedron24": 33,
    "VTK_LAGRANGE_TETRAHEDRON": 71, "VTK_LAGRANGE_HEXAHEDRON": 72, "VTK_LAGRANGE_WEDGE": 73,
}
# Cells without a volume, of any order, which are left out: VTK's number of polylines stands for
# all of them.
_FLAT = re.compile(r"(empty|vertex|poly_?vertex|line|poly_?line|triangle|triangle_?strip|quad|pixel"
                   r"|polygon)\d*|VTK_(LAGRANGE|BEZIER)_(CURVE|TRIANGLE|QUADRILATERAL)")
_ANY_FLAT = 4
_POLYHEDRON = 42
# Of a bare array the number of columns says the shape.
_BY_COLUMNS = {4: "tetra", 5: "pyramid", 6: "wedge", 8: "hexahedron"}


class Cells(NamedTuple):
    """VTK's arrays of cells; the orders of Lagrange cells are (cells, 3), where they are known."""

    types: numpy.ndarray
    offsets: numpy.ndarray
    connectivity: numpy.ndarray
    orders: Optional[numpy.ndarray] = None

    def parts(self) -> Tuple[numpy.ndarray, ...]:
        """Returns a form that Mesh() takes."""
        return tuple(part for part in self if part is not None)


def offsets_of(sizes: Any) -> numpy.ndarray:
    """Returns where each cell of these sizes begins, and the end."""
    return numpy.concatenate([[0], numpy.cumsum(sizes, dtype=numpy.int64)]).astype(numpy.int64)


def chosen(cells: Cells, kept: numpy.ndarray) -> Cells:
    """Returns the cells of these numbers."""
    sizes = numpy.diff(cells.offsets)[kept]
    offsets = offsets_of(sizes)
    places = numpy.arange(offsets[-1]) + numpy.repeat(cells.offsets[kept] - offsets[:-1], sizes)
    return Cells(cells.types[kept], offsets, cells.connectivity[places],
                 None if cells.orders is None else cells.orders[kept])


def _integers(what: str, value: Any) -> numpy.ndarray:
    array = numpy.asanyarray(value)
    if numpy.ma.getmaskarray(array).any():
        raise Error(f"{what}: some are masked; give whole numbers, in a block for each shape")
    array = numpy.asarray(array)
    if array.dtype.kind not in "iu" and array.size > 0:
        raise Error(f"{what}: expected whole numbers, got an array of {array.dtype}")
    return array.astype(numpy.int64, copy=False)


def _number(kind: Any, name: str) -> int:
    if not isinstance(kind, str):
        return int(kind)
    if kind not in _NUMBERS:
        raise Error(f"{name}: cells of the type \"{kind}\" are not read; give one of "
                    + ", ".join(_NUMBERS))
    return _NUMBERS[kind]


def cells(given: Any, name: str) -> Tuple[numpy.ndarray, ...]:
    """Returns VTK's types, offsets and connectivity of cells in any of the forms of Mesh().

    The orders of Lagrange cells follow where they are given behind these.
    """
    if isinstance(given, (tuple, list)) and len(given) == 4 and isinstance(
            given[3], numpy.ndarray) and given[3].ndim == 2:
        return (*cells(given[:3], name), given[3])
    if isinstance(given, (tuple, list)) and len(given) == 3 and all(
            isinstance(part, numpy.ndarray) and part.ndim == 1 for part in given):
        return _checked(*(_integers(f"{name}: cells", part) for part in given), name=name)
    if isinstance(given, numpy.ndarray):
        kind = _BY_COLUMNS.get(given.shape[1] if given.ndim == 2 else -1)
        if kind is None:
            raise Error(f"{name}: cells: an array of shape {given.shape} does not say which cells "
                        "it holds; give {\"hexahedron\": array}")
        given = {kind: given}
    if hasattr(given, "items"):
        given = list(given.items())
    if not isinstance(given, (list, tuple)):
        raise Error(f"{name}: cells: expected a dict, a list of (type, array) or an array, got "
                    f"{given!r:.60}")
    blocks = [_block(*_kind_and_entries(block, name), name) for block in given]
    empty = numpy.zeros(0, dtype=numpy.int64)
    types, sizes, points = (numpy.concatenate([block[part] for block in blocks] or [empty])
                            for part in range(3))
    return types, offsets_of(sizes), points


def _kind_and_entries(block: Any, name: str) -> Tuple[Any, Any]:
    if isinstance(block, (tuple, list)) and len(block) == 2:
        return block[0], block[1]
    if hasattr(block, "type") and hasattr(block, "data"):  # meshio.CellBlock
        return block.type, block.data
    raise Error(f"{name}: cells: expected (type, array), got {block!r:.60}")


def _block(kind: Any, entries: Any,
           name: str) -> Tuple[numpy.ndarray, numpy.ndarray, numpy.ndarray]:
    """The type and the size of each cell of a block, and the entries of all."""
    what = f"{name}: cells of the type {kind}"
    none = numpy.zeros(0, dtype=numpy.int64)
    if isinstance(kind, str) and kind.startswith("polyhedron"):
        lists = [_faces(what, cell) for cell in entries]
        return (numpy.full(len(lists), _POLYHEDRON, dtype=numpy.int64),
                numpy.array([len(each) for each in lists], dtype=numpy.int64),
                numpy.concatenate(lists or [none]))
    if isinstance(kind, str) and _FLAT.fullmatch(kind):  # which are left out, points and all
        count = len(entries)
        return numpy.full(count, _ANY_FLAT, dtype=numpy.int64), numpy.zeros(count, "i8"), none
    array = _integers(what, entries)
    if array.ndim != 2:
        raise Error(f"{what}: expected an array (cells, points), got the shape {array.shape}")
    return (numpy.full(len(array), _number(kind, name), dtype=numpy.int64),
            numpy.full(len(array), array.shape[1], dtype=numpy.int64), array.ravel())


def _faces(what: str, cell: Any) -> numpy.ndarray:
    """The number of a polyhedron's faces, and of each its points after their number."""
    faces = [_integers(what, face).ravel() for face in cell]
    return numpy.concatenate([[len(faces)], *([len(face), *face] for face in faces)]).astype(
        numpy.int64)


def _checked(types: numpy.ndarray, offsets: numpy.ndarray, connectivity: numpy.ndarray,
             name: str) -> Tuple[numpy.ndarray, numpy.ndarray, numpy.ndarray]:
    if len(offsets) != len(types) + 1:
        raise Error(f"{name}: cells: {len(types)} types need {len(types) + 1} offsets, got "
                    f"{len(offsets)}")
    if offsets[0] != 0 or offsets[-1] > len(connectivity) or (numpy.diff(offsets) < 0).any():
        raise Error(f"{name}: cells: the offsets must ascend from 0 to at most the "
                    f"{len(connectivity)} entries of the connectivity")
    return types, offsets, connectivity


def is_mesh(data: Any) -> bool:
    """Whether mesh_of() takes an object."""
    if callable(getattr(data, "IsA", None)):
        return bool(data.IsA("vtkUnstructuredGrid") or data.IsA("vtkStructuredGrid"))
    return hasattr(data, "points") and hasattr(data, "cells") and hasattr(data, "point_data")


def mesh_of(data: Any, channels: Optional[Sequence[str]] = None) -> Mesh:
    """Returns the Mesh of a vtkUnstructuredGrid, a vtkStructuredGrid or a meshio.Mesh.

    channels are the arrays to show, as "ARRAY", "ARRAY:C" or "NAME=ARRAY"; default: the active
    scalars, else the first of points with one component. Hidden cells, ghosts, and cells without a
    volume are left out. Raises Error for other objects.
    """
    if not is_mesh(data):
        raise Error(f"mesh: expected a vtkUnstructuredGrid, a vtkStructuredGrid or a mesh of "
                    f"meshio, got {data!r:.60}")
    if callable(getattr(data, "IsA", None)):
        from . import _vtk_meshes

        return _vtk_meshes.mesh_of(data, channels)
    name = "meshio mesh"
    blocks = list(data.cells.items()) if hasattr(data.cells, "items") else list(data.cells)
    sizes = [len(_kind_and_entries(block, name)[1]) for block in blocks]
    cell_data = {key: _joined(key, parts, sizes, name)
                 for key, parts in (getattr(data, "cell_data", None) or {}).items()}
    return Mesh(_three_columns(data.points, name), blocks, dict(data.point_data), cell_data,
                channels, name=name)


def _joined(key: str, parts: Any, sizes: List[int], name: str) -> numpy.ndarray:
    """The values of all cells of meshio's list of an array for each block."""
    what = f"{name}: array \"{key}\""
    arrays = [_masks.as_array(part, what) for part in parts]
    counts = [len(array) if array.ndim else 0 for array in arrays]
    if counts != sizes:
        raise Error(f"{what} has blocks of {counts} values, but the cells have {sizes}")
    if len({array.shape[1:] for array in arrays}) > 1:
        raise Error(f"{what} has another number of components in each block; leave it out")
    return numpy.concatenate(arrays) if arrays else numpy.zeros(0)


def _three_columns(points: Any, name: str) -> numpy.ndarray:
    points = _masks.as_array(points, f"{name}: points")
    if points.ndim == 2 and points.shape[1] == 2:
        points = numpy.hstack([points, numpy.zeros((len(points), 1))])
    return points
