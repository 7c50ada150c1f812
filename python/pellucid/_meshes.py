# SPDX-License-Identifier: Apache-2.0
"""Cells of meshes as users have them: meshio's, VTK's, or an array."""
from __future__ import annotations

from typing import Any, Optional, Sequence

import numpy

from . import _arrays, _ghosts
from ._pellucid import Error, Mesh

# meshio's names of cells with a volume whose points VTK numbers alike, and VTK's numbers.
_NUMBERS = {
    "tetra": 10, "voxel": 11, "hexahedron": 12, "wedge": 13, "pyramid": 14, "penta_prism": 15,
    "hexa_prism": 16, "tetra10": 24, "hexahedron20": 25, "wedge15": 26, "pyramid13": 27,
    "hexahedron27": 29, "wedge12": 31, "wedge18": 32, "hexahedron24": 33,
    "VTK_LAGRANGE_TETRAHEDRON": 71, "VTK_LAGRANGE_HEXAHEDRON": 72, "VTK_LAGRANGE_WEDGE": 73,
}
# Cells without a volume, which are left out.
_FLAT = {"vertex": 1, "line": 3, "triangle": 5, "quad": 9, "polygon": 7, "line3": 21,
         "triangle6": 22, "quad8": 23, "quad9": 28}
# Of a bare array the number of columns says the shape.
_BY_COLUMNS = {4: "tetra", 5: "pyramid", 6: "wedge", 8: "hexahedron"}


def _integers(what: str, value: Any) -> numpy.ndarray:
    array = numpy.asarray(value)
    if array.dtype.kind not in "iu" and array.size > 0:
        raise Error(f"{what}: expected whole numbers, got an array of {array.dtype}")
    return array.astype(numpy.int64, copy=False)


def _number(kind: Any, name: str) -> int:
    if isinstance(kind, str):
        number = _NUMBERS.get(kind, _FLAT.get(kind))
        if number is None:
            raise Error(f"{name}: cells of the type \"{kind}\" are not read; give one of "
                        + ", ".join(_NUMBERS))
        return number
    return int(kind)


def cells(given: Any, name: str) -> tuple[numpy.ndarray, numpy.ndarray, numpy.ndarray]:
    """Returns VTK's types, offsets and connectivity of cells in any of the forms of Mesh()."""
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
    types, sizes, points = [], [], []
    if not isinstance(given, (list, tuple)):
        raise Error(f"{name}: cells: expected a dict, a list of (type, array) or an array, got "
                    f"{given!r:.60}")
    for block in given:
        if isinstance(block, (tuple, list)) and len(block) == 2:
            kind, entries = block
        elif hasattr(block, "type") and hasattr(block, "data"):  # meshio.CellBlock
            kind, entries = block.type, block.data
        else:
            raise Error(f"{name}: cells: expected (type, array), got {block!r:.60}")
        array = _integers(f"{name}: cells of the type {kind}", entries)
        if array.ndim != 2:
            raise Error(f"{name}: cells of the type {kind}: expected an array (cells, points), got "
                        f"the shape {array.shape}")
        types.append(numpy.full(len(array), _number(kind, name), dtype=numpy.int64))
        sizes.append(numpy.full(len(array), array.shape[1], dtype=numpy.int64))
        points.append(array.ravel())
    empty = numpy.zeros(0, dtype=numpy.int64)
    counts = numpy.concatenate(sizes or [empty])
    offsets = numpy.concatenate([[0], numpy.cumsum(counts)]).astype(numpy.int64)
    return (numpy.concatenate(types or [empty]), offsets, numpy.concatenate(points or [empty]))


def _checked(types: numpy.ndarray, offsets: numpy.ndarray, connectivity: numpy.ndarray,
             name: str) -> tuple[numpy.ndarray, numpy.ndarray, numpy.ndarray]:
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
    scalars, else the first of points with one component. Raises Error for other objects.
    """
    if not is_mesh(data):
        raise Error(f"mesh: expected a vtkUnstructuredGrid, a vtkStructuredGrid or a mesh of "
                    f"meshio, got {data!r:.60}")
    if callable(getattr(data, "IsA", None)):
        return _of_vtk(data, channels)
    cell_data = {key: numpy.concatenate([numpy.asarray(part) for part in parts])
                 for key, parts in getattr(data, "cell_data", {}).items()}
    return Mesh(_three_columns(data.points), list(data.cells), dict(data.point_data), cell_data,
                channels, name="meshio mesh")


def _three_columns(points: Any) -> numpy.ndarray:
    points = numpy.asarray(points, dtype=float)
    if points.ndim == 2 and points.shape[1] == 2:
        points = numpy.hstack([points, numpy.zeros((len(points), 1))])
    return points


def _of_vtk(grid: Any, channels: Optional[Sequence[str]]) -> Mesh:
    name = grid.GetClassName()
    if grid.GetNumberOfCells() == 0:
        raise Error(f"{name}: has no cells; Update() the pipeline that makes it")
    points = _arrays.vtk_values(grid.GetPoints().GetData(), name)
    arrays = []
    for attributes in (grid.GetPointData(), grid.GetCellData()):
        found = [attributes.GetArray(i) for i in range(attributes.GetNumberOfArrays())]
        arrays.append({array.GetName() or "values": _arrays.vtk_values(array, name)
                       for array in found if array is not None})
    if channels is None:
        active = grid.GetPointData().GetScalars() or grid.GetCellData().GetScalars()
        if active is not None and active.GetNumberOfComponents() == 1:
            channels = ["value=" + (active.GetName() or "values")]
    blank = _blank_cells(grid)
    kept = None if blank is None else numpy.flatnonzero(~blank)
    given = _vtk_cells(grid)
    if kept is not None:
        given = _chosen(given, kept)
        arrays[1] = {key: values[kept] for key, values in arrays[1].items()}
    for hidden in ("vtkGhostType",):
        for part in arrays:
            part.pop(hidden, None)
    return Mesh(points, given, arrays[0], arrays[1], channels, name=name)


def _blank_cells(grid: Any) -> Optional[numpy.ndarray]:
    """Which cells are duplicates or hidden; None if none is."""
    flags = _ghosts.flags_of(grid.GetCellData())
    if flags is None:
        return None
    blank = (flags & (_ghosts.DUPLICATE_CELL | _ghosts.HIDDEN_CELL)) != 0
    return blank if blank.any() else None


def _vtk_cells(grid: Any) -> tuple[numpy.ndarray, numpy.ndarray, numpy.ndarray]:
    if grid.IsA("vtkStructuredGrid"):
        x, y, z = grid.GetDimensions()
        if min(x, y, z) < 2:
            raise Error("vtkStructuredGrid: an axis has a single point, so that no cell has a "
                        "volume")
        index = numpy.arange(x * y * z, dtype=numpy.int64).reshape(z, y, x)
        corner = index[:-1, :-1, :-1].ravel()[:, numpy.newaxis]
        square = numpy.array([0, 1, 1 + x, x])
        hexahedra = corner + numpy.concatenate([square, square + x * y])
        return cells({"hexahedron": hexahedra}, "vtkStructuredGrid")
    array = grid.GetCells()
    types = _arrays.vtk_values(grid.GetCellTypesArray(), "cell types").astype(numpy.int64)
    offsets = _arrays.vtk_values(array.GetOffsetsArray(), "offsets").astype(numpy.int64)
    connectivity = _arrays.vtk_values(array.GetConnectivityArray(), "cells").astype(numpy.int64)
    if not (types == 42).any():
        return types, offsets, connectivity
    return _with_faces(grid, types, offsets, connectivity)


def _with_faces(grid: Any, types: numpy.ndarray, offsets: numpy.ndarray,
                connectivity: numpy.ndarray) -> tuple[numpy.ndarray, numpy.ndarray, numpy.ndarray]:
    """The entries of polyhedra are their faces: how many, and of each its points after their
    number."""
    faces = _arrays.vtk_values(grid.GetFaces(), "faces")
    places = _arrays.vtk_values(grid.GetFaceLocations(), "face locations")
    parts, sizes = [], []
    for cell, kind in enumerate(types):
        part = connectivity[offsets[cell]:offsets[cell + 1]]
        if kind == 42:
            first = end = int(places[cell])
            end += 1
            for _ in range(int(faces[first])):
                end += 1 + int(faces[end])
            part = faces[first:end].astype(numpy.int64)
        parts.append(part)
        sizes.append(len(part))
    return (types, numpy.concatenate([[0], numpy.cumsum(sizes)]).astype(numpy.int64),
            numpy.concatenate(parts))


def _chosen(given: tuple[numpy.ndarray, numpy.ndarray, numpy.ndarray],
            kept: numpy.ndarray) -> tuple[numpy.ndarray, numpy.ndarray, numpy.ndarray]:
    types, offsets, connectivity = given
    parts = [connectivity[offsets[cell]:offsets[cell + 1]] for cell in kept]
    sizes = [len(part) for part in parts]
    return (types[kept], numpy.concatenate([[0], numpy.cumsum(sizes)]).astype(numpy.int64),
            numpy.concatenate(parts or [connectivity[:0]]))
