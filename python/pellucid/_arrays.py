# SPDX-License-Identifier: Apache-2.0
"""What lies behind objects that hold arrays: the array, and where it is in the world.

Objects of other libraries are recognized by what they offer; none of those libraries is imported
for it. Everything here has the order of an array's axes, (z, y, x).
"""
from __future__ import annotations

import math
import sys
from typing import Any, List, Optional

import numpy

from . import _labelled, _nibabel
from ._masks import as_array
from ._notes import tell
from ._pellucid import Error
from ._pellucid import _vtk_hidden_places, _vtk_placement  # type: ignore[attr-defined]
from ._places import Placed, three_axes

# Arrays of VTK's data sets that are no data.
VTK_MARKS = ("vtkGhostType", "vtkGhostLevels")


def placed(data: Any, spacing: Any, origin: Any, direction: Any, coordinates: Any,
           centering: Optional[str], name: Optional[str]) -> Placed:
    """Returns the array behind `data` and its place; what is given replaces what `data` says."""
    found = _found(data, name or "array")
    name = name or found.name
    if spacing is not None:
        if numpy.ndim(spacing) == 0:
            spacing = (spacing, spacing, spacing)
        found = found._replace(spacing=spacing, coordinates=(None, None, None))
    if origin is not None:
        found = found._replace(origin=origin)
    if direction is not None:
        found = found._replace(direction=direction)
    if coordinates is not None:
        if not isinstance(coordinates, (list, tuple)) or len(coordinates) != 3:
            raise Error(f"{name}: coordinates: expected a list of three arrays (z, y, x), each or "
                        "None for an axis with a spacing")
        found = found._replace(coordinates=tuple(
            None if each is None else as_array(each, f"{name}: coordinates along {axis}")
            for axis, each in zip("zyx", coordinates)))
    if centering is not None:
        if centering not in ("point", "cell"):
            raise Error(f"{name}: centering: expected \"point\" or \"cell\", got {centering!r:.60}")
        found = found._replace(centering=centering)
    faces = 1 if found.centering == "cell" else 0
    for axis, positions in enumerate(found.coordinates):
        if positions is None:
            continue
        expected = found.array.shape[axis] + faces
        if numpy.shape(positions) != (expected,):
            raise Error(f"{name}: the coordinates along {'zyx'[axis]} have the shape "
                        f"{numpy.shape(positions)}, but the array of shape {found.array.shape} "
                        f"needs ({expected},)")
    return found._replace(name=name)


def _found(data: Any, name: str) -> Placed:
    _nibabel.refuse_proxy(data)
    if _nibabel.is_image(data):
        return _nibabel.placed(data)
    if callable(getattr(data, "IsA", None)) and hasattr(data, "GetClassName"):
        return _of_vtk(data)
    if all(hasattr(data, each) for each in ("GetSpacing", "GetOrigin", "GetDirection")):
        return _of_itk(data)
    if all(hasattr(data, each) for each in ("dims", "coords", "values")):
        return _labelled.of_xarray(data)
    if _labelled.is_netcdf4(data):
        return _labelled.of_netcdf4(data)
    labelled = None
    if _labelled.is_hdf5(data):
        labelled = _labelled.of_hdf5(data, name)
    elif _labelled.is_zarr(data):
        labelled = _labelled.of_zarr(data, name)
    if labelled is not None:
        return labelled
    places = [each for each in ("affine", "spacing", "origin", "direction") if hasattr(data, each)]
    if places:
        tell(f"{name}: the {places[0]} of a {type(data).__name__} is not read; give spacing, "
             "origin and direction")
    return Placed(three_axes(as_array(data, name), name), name=name)


def _of_itk(image: Any) -> Placed:
    """ITK and SimpleITK say spacing, origin and direction as (x, y, z)."""
    library = sys.modules.get(type(image).__module__.partition(".")[0])
    view = (getattr(library, "GetArrayViewFromImage", None)
            or getattr(library, "array_view_from_image", None)
            or getattr(sys.modules.get("itk"), "array_view_from_image", None))
    if view is None:
        raise Error(f"{type(image).__name__}: looks like an image of ITK, but its library gives no "
                    "array; convert it with GetArrayFromImage")
    name = "ITK image"
    array = three_axes(numpy.asarray(view(image)), name)
    spacing, origin = tuple(image.GetSpacing()), tuple(image.GetOrigin())
    direction, sides = image.GetDirection(), len(spacing)
    if hasattr(direction, "GetVnlMatrix"):
        matrix = direction.GetVnlMatrix()
        direction = [matrix.get(row, column) for row in range(sides) for column in range(sides)]
    direction = numpy.asarray(direction, dtype=float).reshape(sides, sides)[:3, :3]
    return Placed(array, spacing[2::-1], origin[2::-1], direction[::-1, ::-1], name=name)


def vtk_array(attributes: Any, wanted: Optional[str], name: str) -> Any:
    """The array of point or cell data that a reader of VTK's files takes; None if there is none."""
    if wanted is not None:
        return attributes.GetAbstractArray(wanted)
    if attributes.GetScalars() is not None:
        return attributes.GetScalars()
    arrays = [attributes.GetArray(i) for i in range(attributes.GetNumberOfArrays())]
    arrays = [array for array in arrays
              if array is not None and array.GetName() not in VTK_MARKS]
    single = [array for array in arrays if array.GetNumberOfComponents() == 1]
    return (single or arrays or [None])[0]


def _numbers_of(array: Any) -> numpy.ndarray:
    """The memory of a vtkDataArray as numbers: VTK calls that of a vtkCharArray text."""
    values = numpy.asarray(memoryview(array))
    return values.view(numpy.int8) if values.dtype.kind == "S" else values


def vtk_values(array: Any, name: str) -> numpy.ndarray:
    """The memory of a vtkDataArray, or a copy: (n,), or (n, components)."""
    if array.GetClassName() == "vtkBitArray":
        bits = numpy.array([array.GetValue(i) for i in range(array.GetNumberOfValues())],
                           dtype=numpy.uint8)
        components = array.GetNumberOfComponents()
        return bits if components == 1 else bits.reshape(-1, components)
    try:
        return _numbers_of(array)
    except TypeError:
        pass  # its memory is in another order
    try:
        copy = array.CreateDataArray(array.GetDataType())
        copy.DeepCopy(array)
        return _numbers_of(copy)
    except (AttributeError, TypeError):
        raise Error(f"{name}: its array is a {array.GetClassName()}, whose memory is not an "
                    "array; convert it (vtkImageCast)") from None


def _of_vtk(data: Any) -> Placed:
    components = vtk_components(data)
    if len(components) != 1:
        raise Error(f"{data.GetClassName()}: its array has {len(components)} components; extract "
                    "one (vtkImageExtractComponents)")
    return components[0]


def means_cells(data: Any) -> bool:
    """Whether data is PyVista's, and says that its active scalars are those of cells."""
    association = getattr(getattr(data, "active_scalars_info", None), "association", None)
    return getattr(association, "name", "") == "CELL"


def vtk_flags(attributes: Any) -> Optional[numpy.ndarray]:
    """The flags of vtkGhostType of points or cells; None if there are none."""
    array = attributes.GetArray(VTK_MARKS[0])
    return None if array is None else numpy.asarray(memoryview(array)).ravel()


def vtk_components(data: Any, values: Optional[numpy.ndarray] = None,
                   centering: str = "point") -> List[Placed]:
    """Returns each component of a grid's array, and its place. What is hidden is NaN.

    values  (n, components), in the place of the values that a reader of files takes
    """
    name = data.GetClassName()
    if data.IsA("vtkCompositeDataSet"):
        raise Error(f"{name}: is a list of data; give one of its blocks")
    if data.IsA("vtkPolyData"):
        raise Error(f"{name}: is a surface, which has no volume; give the data that it is of")
    if not (data.IsA("vtkImageData") or data.IsA("vtkRectilinearGrid")):
        raise Error(f"{name}: expected a vtkImageData or a vtkRectilinearGrid (meshes: "
                    "pellucid.mesh_of); for a pipeline give its GetOutput() after Update()")
    if values is None:
        array, centering = vtk_array(data.GetPointData(), None, name), "point"
        if array is None or (means_cells(data) and data.GetCellData().GetScalars() is not None):
            array, centering = vtk_array(data.GetCellData(), None, name), "cell"
        if array is None:
            raise Error(f"{name}: has no values; give it scalars, or Update() its pipeline")
        values = vtk_values(array, name).reshape(-1, array.GetNumberOfComponents())
    cells = [side - 1 for side in data.GetDimensions()]
    shape = tuple(side + (centering == "point") for side in cells)[::-1]
    if len(values) != math.prod(shape):
        raise Error(f"{name}: has {len(values)} values for {math.prod(shape)} places")
    hidden = _vtk_hidden_places(vtk_flags(data.GetPointData()), vtk_flags(data.GetCellData()),
                                cells, centering == "cell", name)
    if hidden is not None:
        wide = values.dtype.itemsize > 2 and values.dtype != numpy.float32
        values = values.astype(numpy.float64 if wide else numpy.float32)
        values[hidden] = numpy.nan
    values = values.reshape(*shape, -1)
    parts = [values[..., c] for c in range(values.shape[-1])]
    if data.IsA("vtkRectilinearGrid"):
        axes = (data.GetZCoordinates(), data.GetYCoordinates(), data.GetXCoordinates())
        coordinates = tuple(vtk_values(axis, name) for axis in axes)
        return [Placed(one, coordinates=coordinates, centering=centering, name=name)
                for one in parts]
    origin, spacing, direction = _vtk_placement(data, centering == "cell")
    return [Placed(one, spacing[::-1], origin[::-1], direction[::-1, ::-1], centering=centering,
                   name=name) for one in parts]
