# SPDX-License-Identifier: Apache-2.0
"""The array of a data set of VTK that a mapper shows."""
from __future__ import annotations

import sys
from dataclasses import dataclass
from typing import Any, Optional

import numpy

from . import _arrays
from ._pellucid import Error
from ._vtk_functions import Range

# What cells mean beside their values.
_KEPT = ("vtkGhostType", "HIGHER_ORDER_DEGREES", "HigherOrderDegrees")
_CHAR = 2  # VTK_CHAR
# vtkSmartVolumeMapper's VectorModeType.
_MAGNITUDE, _ONE_COMPONENT = 0, 1


@dataclass
class Chosen:
    """A data set with the one array that a mapper shows."""

    data: Any
    array: Any

    def ramp(self, mapper: Any, component: int) -> Range:
        """Returns the range over which VTK puts a ramp into a function without nodes. Its
        fixed-point mapper leaves such a function as it is."""
        if mapper.IsA("vtkFixedPointVolumeRayCastMapper") or (
                mapper.IsA("vtkSmartVolumeMapper") and mapper.GetRequestedRenderMode() == 1):
            return None
        first, last = (self.array.GetFiniteRange(component)
                       if hasattr(self.array, "GetFiniteRange") else self.array.GetRange(component))
        return (first, last) if first <= last else None


    def vector_component(self, mapper: Any) -> Optional[int]:
        """Returns the component that a smart mapper shows alone; None if it shows several."""
        if not mapper.IsA("vtkSmartVolumeMapper") or mapper.GetVectorMode() != _ONE_COMPONENT:
            return None
        return min(max(mapper.GetVectorComponent(), 0), self.array.GetNumberOfComponents() - 1)


def chosen_data(mapper: Any, data: Any, what: str) -> Chosen:
    """Returns what a mapper shows of a data set, as its scalar mode and selected array say."""
    of_cells = sys.modules["vtkmodules.vtkCommonCore"].reference(0)
    array = mapper.GetScalars(data, mapper.GetScalarMode(), mapper.GetArrayAccessMode(),
                              mapper.GetArrayId(), mapper.GetArrayName(), of_cells)
    if array is None:
        raise Error(f"{what}: has no values to show; give it scalars, or select one of its arrays")
    bare = data.NewInstance()
    bare.CopyStructure(data)
    for part, given in ((bare.GetPointData(), data.GetPointData()),
                        (bare.GetCellData(), data.GetCellData())):
        for name in _KEPT:
            if given.GetArray(name) is not None:
                part.AddArray(given.GetArray(name))
    degrees = getattr(data.GetCellData(), "GetHigherOrderDegrees", lambda: None)()
    if degrees is not None:
        bare.GetCellData().SetHigherOrderDegrees(degrees)
    shown = _in_memory(array)
    if (mapper.IsA("vtkSmartVolumeMapper") and mapper.GetVectorMode() == _MAGNITUDE
            and array.GetNumberOfComponents() > 1):
        shown = _magnitudes(shown)
    (bare.GetCellData() if int(of_cells) else bare.GetPointData()).SetScalars(shown)
    return Chosen(bare, shown)


def _magnitudes(array: Any) -> Any:
    made = sys.modules["vtkmodules.vtkCommonCore"].vtkDoubleArray()
    made.SetNumberOfTuples(array.GetNumberOfTuples())
    vectors = _arrays.vtk_values(array, "vectors").astype(numpy.float64)
    numpy.asarray(memoryview(made))[...] = numpy.linalg.norm(vectors, axis=1)
    made.SetName("value")
    return made


def _in_memory(array: Any) -> Any:
    """Returns the array under a plain name, as numbers that lie side by side in memory.

    Numbers of the type char, which numpy's int8 becomes, are signed char.
    """
    library = sys.modules["vtkmodules.vtkCommonCore"]
    if array.GetDataType() == _CHAR:
        made = library.vtkSignedCharArray()
        made.SetNumberOfComponents(array.GetNumberOfComponents())
        made.SetNumberOfTuples(array.GetNumberOfTuples())
        if array.GetNumberOfValues() > 0:
            numpy.asarray(memoryview(made)).reshape(-1)[...] = numpy.asarray(
                memoryview(array)).reshape(-1).view(numpy.int8)
    else:
        made = array.NewInstance()
        try:
            memoryview(array)
            made.ShallowCopy(array)
        except TypeError:
            if array.GetClassName() == "vtkBitArray":
                made.DeepCopy(array)
            else:
                made = library.vtkDataArray.CreateDataArray(array.GetDataType())
                made.DeepCopy(array)
    made.SetName("value")
    return made
