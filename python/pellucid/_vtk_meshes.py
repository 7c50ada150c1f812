# SPDX-License-Identifier: Apache-2.0
"""Unstructured and structured grids of VTK as the cells and arrays that Mesh() takes."""
from __future__ import annotations

from typing import Any, Dict, List, Optional, Sequence

import numpy

from . import _arrays, _meshes
from ._pellucid import Error, Mesh
from ._pellucid import _vtk_shown_cells  # type: ignore[attr-defined]

_POLYHEDRON = 42


def mesh_of(grid: Any, channels: Optional[Sequence[str]]) -> Mesh:
    """Returns the Mesh of a grid, without the cells that are hidden or another block's."""
    name = grid.GetClassName()
    if grid.GetNumberOfCells() == 0 or grid.GetPoints() is None:
        raise Error(f"{name}: has no cells; Update() the pipeline that makes it")
    point_data = _arrays_of(grid.GetPointData(), name)
    cell_data = _arrays_of(grid.GetCellData(), name)
    mesh = _mesh(grid, point_data, cell_data, channels, _active(grid, point_data))
    if mesh is None:
        raise Error(f"{name}: all of its cells are hidden or ghosts (vtkGhostType)")
    return mesh


def shown_mesh(grid: Any, array: Any, centering: str) -> Optional[Mesh]:
    """Returns the Mesh of a grid with one array; None if all of its cells are hidden."""
    values = {"value": _arrays.vtk_values(array, grid.GetClassName())}
    return _mesh(grid, values if centering == "point" else {},
                 values if centering == "cell" else {}, None, "value")


def _mesh(grid: Any, point_data: Dict[str, numpy.ndarray], cell_data: Dict[str, numpy.ndarray],
          channels: Optional[Sequence[str]], active: Optional[str]) -> Optional[Mesh]:
    name = grid.GetClassName()
    points = _arrays.vtk_values(grid.GetPoints().GetData(), name)
    cells = _structured_cells(grid) if grid.IsA("vtkStructuredGrid") else _cells(grid)
    shown = _shown(grid, cells)
    if not shown.all():
        kept = numpy.flatnonzero(shown)
        if not len(kept):
            return None
        cells = _meshes.chosen(cells, kept)
        cell_data = {key: values[kept] for key, values in cell_data.items()}
    return Mesh(points, cells.parts(), point_data, cell_data, channels, name=name, active=active)


def _is_left_out(array: Any, attributes: Any) -> bool:
    """Whether an array is no data but ghosts, numbers of points, or the orders of cells."""
    return (array.GetName() in _arrays.VTK_MARKS or array.GetNumberOfComponents() < 1
            or any(array is each for each in (attributes.GetGlobalIds(),
                                              attributes.GetPedigreeIds(), _orders(attributes))))


def _orders(attributes: Any) -> Any:
    get = getattr(attributes, "GetHigherOrderDegrees", None)
    found = None if get is None else get()
    return attributes.GetArray("HIGHER_ORDER_DEGREES") if found is None else found


def _name_of(array: Any, index: int) -> str:
    return array.GetName() or f"array_{index}"


def _arrays_of(attributes: Any, name: str) -> Dict[str, numpy.ndarray]:
    """Arrays of numbers by their names; a second one of a name is left out, as VTK finds it."""
    found: Dict[str, numpy.ndarray] = {}
    for index in range(attributes.GetNumberOfArrays()):
        array = attributes.GetArray(index)  # None for text
        if array is None or _is_left_out(array, attributes):
            continue
        found.setdefault(_name_of(array, index), _arrays.vtk_values(array, name))
    return found


def _active(grid: Any, point_data: Dict[str, numpy.ndarray]) -> Optional[str]:
    """The name in Mesh() of the active scalars, of points or else of cells, if any."""
    attributes = [grid.GetPointData(), grid.GetCellData()]
    if _arrays.means_cells(grid):
        attributes.reverse()
    for each in attributes:
        scalars = each.GetScalars()
        if scalars is None or _is_left_out(scalars, each):
            continue
        index = next(i for i in range(each.GetNumberOfArrays()) if each.GetArray(i) is scalars)
        name = _name_of(scalars, index)
        return name + "_cell" if each is grid.GetCellData() and name in point_data else name
    return None


def _shown(grid: Any, cells: _meshes.Cells) -> numpy.ndarray:
    """bool (cells,): which are neither duplicates, refined, hidden nor have a hidden point."""
    # Of polyhedra the points stand among counts: VTK's own lists have the points alone.
    lists = cells if grid.IsA("vtkStructuredGrid") else _lists(grid)
    flags, levels = (_arrays.vtk_flags(grid.GetCellData()),
                     grid.GetCellData().GetArray(_arrays.VTK_MARKS[1]))
    if levels is not None:  # of files before VTK 6.3: above 0 is a duplicate
        duplicates = (_arrays.vtk_values(levels, "ghost levels") > 0).astype(numpy.uint8)
        flags = duplicates if flags is None else flags | duplicates
    return _vtk_shown_cells(_arrays.vtk_flags(grid.GetPointData()), flags, lists.offsets,
                            lists.connectivity, grid.GetNumberOfPoints(), grid.GetClassName())


def _structured_cells(grid: Any) -> _meshes.Cells:
    x, y, z = grid.GetDimensions()
    if min(x, y, z) < 2:
        raise Error("vtkStructuredGrid: an axis has a single point, so that no cell has a "
                    "volume")
    if x * y * z != grid.GetNumberOfPoints():
        raise Error(f"vtkStructuredGrid: has {grid.GetNumberOfPoints()} points for {x} x {y} x {z}")
    index = numpy.arange(x * y * z, dtype=numpy.int64).reshape(z, y, x)
    corner = index[:-1, :-1, :-1].ravel()[:, numpy.newaxis]
    square = numpy.array([0, 1, 1 + x, x])
    hexahedra = corner + numpy.concatenate([square, square + x * y])
    return _meshes.Cells(*_meshes.cells({"hexahedron": hexahedra}, "vtkStructuredGrid"))


def _lists(grid: Any) -> _meshes.Cells:
    """VTK's own arrays of cells, where polyhedra have their points without faces."""
    array = grid.GetCells()

    def integers(part: Any, what: str) -> numpy.ndarray:
        return _arrays.vtk_values(part, what).astype(numpy.int64)

    return _meshes.Cells(integers(grid.GetCellTypesArray(), "cell types"),
                         integers(array.GetOffsetsArray(), "offsets"),
                         integers(array.GetConnectivityArray(), "cells"))


def _cells(grid: Any) -> _meshes.Cells:
    cells = _lists(grid)
    orders = _orders(grid.GetCellData())
    if orders is not None and orders.GetNumberOfComponents() == 3:
        cells = cells._replace(orders=_arrays.vtk_values(orders, "orders").astype(numpy.int64))
    return _with_faces(grid, cells) if (cells.types == _POLYHEDRON).any() else cells


def _with_faces(grid: Any, cells: _meshes.Cells) -> _meshes.Cells:
    """The entries of polyhedra are their faces: how many, and of each its points after their
    number."""
    if grid.GetFaces() is None or grid.GetFaceLocations() is None:
        raise Error(f"{grid.GetClassName()}: its polyhedra come without their faces; cut them into "
                    "tetrahedra (vtkDataSetTriangleFilter)")
    faces = _arrays.vtk_values(grid.GetFaces(), "faces")
    places = _arrays.vtk_values(grid.GetFaceLocations(), "face locations")
    parts: List[numpy.ndarray] = []
    for cell, kind in enumerate(cells.types):
        part = cells.connectivity[cells.offsets[cell]:cells.offsets[cell + 1]]
        if kind == _POLYHEDRON:
            first = end = int(places[cell])
            end += 1
            for _ in range(int(faces[first])):
                end += 1 + int(faces[end])
            part = faces[first:end].astype(numpy.int64)
        parts.append(part)
    return cells._replace(offsets=_meshes.offsets_of([len(part) for part in parts]),
                          connectivity=numpy.concatenate(parts))
