# SPDX-License-Identifier: Apache-2.0
"""What lies behind objects that hold arrays: the array, and where it is in the world.

Objects of other libraries are recognized by what they offer; none of those libraries is imported
for it. Everything here has the order of an array's axes, (z, y, x).
"""
from __future__ import annotations

import math
import sys
import warnings
from typing import Any, List, NamedTuple, Optional

import numpy

from . import _ghosts
from ._notes import Note
from ._pellucid import Error


class Placed(NamedTuple):
    """An array of three axes and its place, as Volume() takes them."""

    array: numpy.ndarray
    spacing: Any = (1.0, 1.0, 1.0)
    origin: Any = (0.0, 0.0, 0.0)
    direction: Any = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
    coordinates: Any = (None, None, None)
    centering: str = "point"
    name: str = "array"


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
        found = found._replace(coordinates=tuple(coordinates))
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


def as_array(data: Any, name: str) -> numpy.ndarray:
    """Returns data as a numpy array, without a copy where that is possible. Masked is NaN."""
    if isinstance(data, numpy.ma.MaskedArray):
        return _unmasked(data)
    if isinstance(data, numpy.ndarray):
        return data
    if data is None or isinstance(data, (str, dict, set)):
        raise Error(f"{name}: expected an array, got {data!r:.60}")
    if hasattr(data, "__dlpack__") and not (hasattr(data, "__array_interface__")
                                            or hasattr(data, "__array__")):
        try:
            return numpy.from_dlpack(data)
        except (RuntimeError, TypeError, BufferError) as failure:
            raise Error(f"{name}: its DLPack memory cannot be read ({failure}); move it to the "
                        "memory of the processor") from None
    try:
        return numpy.asanyarray(data)
    except (TypeError, ValueError) as failure:
        raise Error(f"{name}: expected an array, got {type(data).__name__} ({failure})") from None


def _unmasked(data: numpy.ma.MaskedArray) -> numpy.ndarray:
    mask = numpy.ma.getmaskarray(data)
    if not mask.any():
        return data.data
    values = data.data
    if values.dtype.kind not in "biuf":
        return values  # refused by its type
    if values.dtype.kind != "f":
        exact = 2 ** 53
        if values.dtype.itemsize == 8 and (values.max() > exact or values.min() < -exact):
            warnings.warn("masked integers beyond 2^53 are rounded to f64", Note, stacklevel=4)
        values = values.astype(numpy.float32 if values.dtype.itemsize <= 2 else numpy.float64)
    return numpy.where(mask, values.dtype.type(numpy.nan), values)


def three_axes(array: numpy.ndarray, name: str) -> numpy.ndarray:
    """Returns the array without axes of one entry in front and behind. Throws for others."""
    given = array.shape
    while array.ndim > 3 and array.shape[0] == 1:
        array = array[0]
    while array.ndim > 3 and array.shape[-1] == 1:
        array = array[..., 0]
    if array.ndim != 3:
        advice = ("choose one of its volumes, as in a[..., 0], or give several as Channels"
                  if array.ndim > 3 else "give three axes (z, y, x), as in a[numpy.newaxis] with "
                  "centering=\"cell\" for a single slice" if array.ndim == 2
                  else "give an array with three axes (z, y, x)")
        raise Error(f"{name}: an array of shape {given} has {len(given)} axes; {advice}")
    return array


def _found(data: Any, name: str) -> Placed:
    if hasattr(data, "dataobj") and hasattr(data, "affine"):
        return _of_nibabel(data)
    if callable(getattr(data, "IsA", None)) and hasattr(data, "GetClassName"):
        return _of_vtk(data)
    if all(hasattr(data, each) for each in ("GetSpacing", "GetOrigin", "GetDirection")):
        return _of_itk(data)
    if all(hasattr(data, each) for each in ("dims", "coords", "values")):
        return _of_xarray(data)
    return Placed(three_axes(as_array(data, name), name), name=name)


def _of_columns(array: numpy.ndarray, columns: numpy.ndarray, origin: Any, name: str) -> Placed:
    """An array (z, y, x) whose axes step by columns[a], all given as (x, y, z)."""
    spacing, direction = [], numpy.empty((3, 3))
    for axis, (x, y, z) in enumerate(columns):
        length = math.sqrt(x * x + y * y + z * z)
        spacing.append(length)
        inverse = 1 / length if length > 0 else 0.0
        direction[:, axis] = (z * inverse, y * inverse, x * inverse)
    return Placed(array, tuple(spacing), tuple(origin)[::-1], direction, name=name)


def _of_nibabel(image: Any) -> Placed:
    """RAS becomes LPS, and the axes (i, j, k) of its array are x, y, z."""
    file = image.get_filename() if hasattr(image, "get_filename") else None
    name = str(file or "nibabel image")
    if image.affine is None:
        raise Error(f"{name}: its affine is None, so that its place is not known; give the image "
                    "an affine")
    array = three_axes(_nibabel_values(image.dataobj, name), name)
    affine = numpy.array(image.affine, dtype=float)
    affine[:2] *= -1
    return _of_columns(array.T, affine[:3, 2::-1].T, affine[:3, 3], name)


def _nibabel_values(dataobj: Any, name: str) -> numpy.ndarray:
    """The values as our own reader scales them: in float from 16 bits and less."""
    if not hasattr(dataobj, "get_unscaled"):
        return as_array(dataobj, name)
    stored = numpy.asanyarray(dataobj.get_unscaled())
    slope, intercept = float(dataobj.slope), float(dataobj.inter)
    if slope == 1 and intercept == 0:
        return stored
    narrow = stored.dtype.itemsize <= 2 or stored.dtype.name == "float32"
    return (slope * stored.astype(numpy.float64) + intercept).astype(
        numpy.float32 if narrow else numpy.float64)


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
    direction = image.GetDirection()
    if hasattr(direction, "GetVnlMatrix"):
        matrix = direction.GetVnlMatrix()
        direction = [matrix.get(row, column) for row in range(3) for column in range(3)]
    direction = numpy.asarray(direction, dtype=float).reshape(3, 3)
    return Placed(array, tuple(image.GetSpacing())[::-1], tuple(image.GetOrigin())[::-1],
                  direction[::-1, ::-1], name=name)


def _of_xarray(data: Any) -> Placed:
    """Dimensions named x, y and z are taken by their names, others in their order."""
    name = str(getattr(data, "name", None) or "xarray")
    if hasattr(data, "data_vars"):
        raise Error(f"{name}: is a Dataset; choose one variable, as in data[\"density\"], or give "
                    "several as Channels")
    if len(data.dims) > 3:
        data = data.squeeze()
    if set(data.dims) == {"x", "y", "z"}:
        data = data.transpose("z", "y", "x")
    array = three_axes(as_array(data.values, name), name)
    coordinates = []
    for dimension in data.dims:
        positions = data.coords[dimension].values if dimension in data.coords else None
        usable = positions is not None and positions.dtype.kind in "iuf" and positions.ndim == 1
        coordinates.append(positions if usable else None)
    return Placed(array, coordinates=tuple(coordinates), name=name)


def vtk_array(attributes: Any, wanted: Optional[str], name: str) -> Any:
    """The array of point or cell data that a reader of VTK's files takes; None if there is none."""
    if wanted is not None:
        return attributes.GetAbstractArray(wanted)
    if attributes.GetScalars() is not None:
        return attributes.GetScalars()
    arrays = [attributes.GetArray(i) for i in range(attributes.GetNumberOfArrays())]
    arrays = [array for array in arrays
              if array is not None and array.GetName() != "vtkGhostType"]
    single = [array for array in arrays if array.GetNumberOfComponents() == 1]
    return (single or arrays or [None])[0]


def vtk_values(array: Any, name: str) -> numpy.ndarray:
    """The memory of a vtkDataArray: (n,), or (n, components)."""
    if array.GetClassName() == "vtkBitArray":
        return numpy.array([array.GetValue(i) for i in range(array.GetNumberOfValues())],
                           dtype=numpy.uint8).reshape(array.GetNumberOfTuples(), -1).squeeze()
    try:
        return numpy.asarray(memoryview(array))
    except TypeError:
        raise Error(f"{name}: its array is a {array.GetClassName()}, whose memory is not an "
                    "array; convert it (vtkImageCast)") from None


def _of_vtk(data: Any) -> Placed:
    components = vtk_components(data)
    if len(components) != 1:
        raise Error(f"{data.GetClassName()}: its array has {len(components)} components; extract "
                    "one (vtkImageExtractComponents)")
    return components[0]


def vtk_components(data: Any) -> List[Placed]:
    """Returns each component of a grid's array, and its place. What is hidden is NaN."""
    name = data.GetClassName()
    if not (data.IsA("vtkImageData") or data.IsA("vtkRectilinearGrid")):
        raise Error(f"{name}: expected a vtkImageData or a vtkRectilinearGrid (meshes: "
                    "pellucid.mesh_of); for a pipeline give its GetOutput() after Update()")
    array, centering = vtk_array(data.GetPointData(), None, name), "point"
    if array is None:
        array, centering = vtk_array(data.GetCellData(), None, name), "cell"
    if array is None:
        raise Error(f"{name}: has no values; give it scalars, or Update() its pipeline")
    cells = 1 if centering == "cell" else 0
    shape = tuple(side - cells for side in data.GetDimensions())[::-1]
    count = array.GetNumberOfComponents()
    if array.GetNumberOfTuples() != math.prod(shape):
        raise Error(f"{name}: has {array.GetNumberOfTuples()} values for {math.prod(shape)} places")
    all_values = vtk_values(array, name).reshape(*shape, count)
    hidden = _ghosts.hidden_places(data, centering)
    if hidden is not None:
        wide = all_values.dtype.itemsize > 2 and all_values.dtype != numpy.float32
        all_values = all_values.astype(numpy.float64 if wide else numpy.float32)
        all_values[hidden] = numpy.nan
    values = [all_values[..., c] for c in range(count)]
    if data.IsA("vtkRectilinearGrid"):
        axes = (data.GetZCoordinates(), data.GetYCoordinates(), data.GetXCoordinates())
        coordinates = tuple(vtk_values(axis, name) for axis in axes)
        return [Placed(one, coordinates=coordinates, centering=centering, name=name)
                for one in values]
    matrix = data.GetDirectionMatrix()
    direction = numpy.array([[matrix.GetElement(row, column) for column in range(3)]
                             for row in range(3)])
    spacing, origin = list(data.GetSpacing()), numpy.array(data.GetOrigin())
    for axis, first in enumerate(data.GetExtent()[::2]):
        origin = origin + direction[:, axis] * (spacing[axis] * first)
        if spacing[axis] < 0:
            spacing[axis], direction[:, axis] = -spacing[axis], -direction[:, axis]
    for axis in range(3 * cells):
        origin = origin + direction[:, axis] * (spacing[axis] / 2)
    return [Placed(one, tuple(spacing)[::-1], tuple(origin)[::-1], direction[::-1, ::-1],
                   centering=centering, name=name) for one in values]
