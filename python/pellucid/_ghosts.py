# SPDX-License-Identifier: Apache-2.0
"""Places of VTK's grids that vtkGhostType marks: hidden ones, and those of another block."""
from __future__ import annotations

from typing import Any, List, Optional, Tuple

import numpy

from ._pellucid import Error

DUPLICATE_CELL, REFINED_CELL, HIDDEN_CELL = 1, 8, 32
HIDDEN_POINT = 2
_FLAGS, _LEVELS = "vtkGhostType", "vtkGhostLevels"
NAMES = (_FLAGS, _LEVELS)


def flags_of(attributes: Any) -> Optional[numpy.ndarray]:
    """The flags of points or cells, one each; None if there are none.

    Files of VTK before 6.3 have levels in their place: above 0 is a duplicate.
    """
    array = attributes.GetArray(_FLAGS)
    if array is not None:
        return numpy.asarray(memoryview(array)).ravel().astype(numpy.int64)
    array = attributes.GetArray(_LEVELS)
    if array is None:
        return None
    return (numpy.asarray(memoryview(array)).ravel() > 0) * numpy.int64(DUPLICATE_CELL)


def _marked(attributes: Any, shape: Tuple[int, ...], flags: int,
            name: str) -> Optional[numpy.ndarray]:
    """bool (z, y, x): which places have one of the flags; None if none has."""
    found = flags_of(attributes)
    if found is None:
        return None
    if found.size != numpy.prod(shape):
        raise Error(f"{name}: vtkGhostType has {found.size} flags for {numpy.prod(shape)} places")
    marked = (found.reshape(shape) & flags) != 0
    return marked if marked.any() else None


def _corners(shape: Tuple[int, ...]) -> List[Tuple[slice, ...]]:
    """Where, among points, each of the eight corners of cells lies."""
    return [tuple(slice(first, first + side) for first, side in zip(corner, shape))
            for corner in numpy.ndindex(2, 2, 2)]


def hidden_places(data: Any, centering: str) -> Optional[numpy.ndarray]:
    """bool (z, y, x): which values of an image or a rectilinear grid are hidden; None if none is.

    A cell is hidden with one of its points, and a value at a point with all of its cells. Raises
    Error if a cell is hidden between cells that are not, which values at points cannot show.
    """
    name = data.GetClassName()
    at_points = tuple(data.GetDimensions())[::-1]
    in_cells = tuple(side - 1 for side in at_points)
    points = _marked(data.GetPointData(), at_points, HIDDEN_POINT, name)
    cells = _marked(data.GetCellData(), in_cells, HIDDEN_CELL | REFINED_CELL, name)
    if centering == "cell":
        if points is None:
            return cells
        hidden = numpy.zeros(in_cells, dtype=bool) if cells is None else cells.copy()
        for corner in _corners(in_cells):
            hidden |= points[corner]
        return hidden
    if cells is None:
        return points
    seen = numpy.zeros(at_points, dtype=bool)
    for corner in _corners(in_cells):
        seen[corner] |= ~cells
    hidden = ~seen if points is None else ~seen | points
    gone = numpy.zeros(in_cells, dtype=bool)
    for corner in _corners(in_cells):
        gone |= hidden[corner]
    if (cells & ~gone).any():
        raise Error(f"{name}: hides cells between others (vtkGhostType), which values at points "
                    "cannot show; hide points (BlankPoint()), or give the values to cells")
    return hidden


def own_box(data: Any) -> Optional[Tuple[List[int], List[int]]]:
    """The first and one beyond the last own cell along x, y and z; None if none is a duplicate.

    Without own cells both are 0. Raises Error if the own cells do not fill a box.
    """
    name = data.GetClassName()
    shape = tuple(side - 1 for side in data.GetDimensions())[::-1]
    duplicates = _marked(data.GetCellData(), shape, DUPLICATE_CELL, name)
    if duplicates is None:
        return None
    own = numpy.argwhere(~duplicates)[:, ::-1]
    if not len(own):
        return [0, 0, 0], [0, 0, 0]
    first, end = own.min(axis=0), own.max(axis=0) + 1
    if numpy.prod(end - first) != len(own):
        raise Error(f"{name}: its cells that are no ghosts do not fill a box; remove vtkGhostType")
    return first.tolist(), end.tolist()
