# SPDX-License-Identifier: Apache-2.0
"""The data that a mapper of VTK shows, handed over to the translation (src/io/vtk_scene)."""
from __future__ import annotations

import sys
from typing import Any, List, NamedTuple, Optional, Tuple

import numpy

from . import _arrays, _meshes, _vtk_meshes
from ._pellucid import Error, Volume
from ._pellucid import _vtk_grid_layers, _vtk_mesh_layers  # type: ignore[attr-defined]
from .scene import Layer

# vtkVolumeMapper's ADDITIVE_BLEND, vtkSmartVolumeMapper's VectorModeType, and VTK_CTF_LOG10.
_ADDITIVE = 4
_MAGNITUDE, _ONE_COMPONENT = 0, 1
_LOG10 = 1


def is_a(data: Any, name: str) -> bool:
    return callable(getattr(data, "IsA", None)) and bool(data.IsA(name))


def items(collection: Any) -> List[Any]:
    return [collection.GetItemAsObject(i) for i in range(collection.GetNumberOfItems())]


class Part(NamedTuple):
    """A vtkVolume with the mapper that shows it and the data set that is shown."""

    what: str
    volume: Any
    mapper: Any
    data: Any


def parts_of(volume: Any, what: str) -> List[Part]:
    """Returns a vtkVolume, or the parts of a vtkMultiVolume."""
    mapper = volume.GetMapper()
    if mapper is None:
        raise Error(f"{what}: has no mapper")
    mapper.Update()
    if not volume.IsA("vtkMultiVolume"):
        data = (mapper.GetDataSetInput() if hasattr(mapper, "GetDataSetInput")
                else mapper.GetInput())
        if data is None and mapper.GetNumberOfInputConnections(0) > 0:
            data = mapper.GetInputDataObject(0, 0)
        return [Part(what, volume, mapper, data)]
    ports = [port for port in range(mapper.GetNumberOfInputPorts())
             if mapper.GetNumberOfInputConnections(port) > 0 and volume.GetVolume(port) is not None]
    return [Part(f"{what}, part {port + 1}", volume.GetVolume(port), mapper,
                 mapper.GetInputDataObject(port, 0)) for port in ports]


def layers_of(part: Part, tolerance: float, ambient: bool, notes: List[str]) -> List[Layer]:
    """Returns the layers of a part: none if there is nothing of it but ghosts."""
    what, _, mapper, data = part
    if data is None:
        raise Error(f"{what}: its mapper has no input")
    if not data.IsA("vtkDataSet"):
        raise Error(f"{what}: its data are a {data.GetClassName()}; give each block a volume of "
                    "its own")
    if mapper.GetBlendMode() == _ADDITIVE:
        raise Error(f"{what}: its mapper blends by adding, which no scene does; take the plug-in "
                    "(pellucid.vtk.use())")
    of_cells = sys.modules["vtkmodules.vtkCommonCore"].reference(0)
    array = mapper.GetScalars(data, mapper.GetScalarMode(), mapper.GetArrayAccessMode(),
                              mapper.GetArrayId(), mapper.GetArrayName(), of_cells)
    centering = "cell" if int(of_cells) else "point"
    if _meshes.is_mesh(data):
        return _vtk_mesh_layers(
            what, part.volume, mapper, data,
            0 if array is None else array.GetNumberOfComponents(),
            lambda: _vtk_meshes.shown_mesh(data, array, centering), tolerance, notes)
    components, ranges, volumes = _shown(part, array, centering)
    image = getattr(mapper, "GetMaskInput", lambda: None)()
    layers = _vtk_grid_layers(
        what, part.volume, mapper, data, array, components, ranges, volumes,
        _arrays.vtk_flags(data.GetCellData()), None if image is None else Volume(image), tolerance,
        ambient, notes)
    notes.extend(f"{what}: {line}" for line in _known_differences(part))
    return layers


def _shown(part: Part, array: Any, centering: str
           ) -> Tuple[List[int], List[Tuple[float, float]], List[Volume]]:
    """The components of the property that are shown, with their ranges and volumes."""
    if array is None:
        return [], [], []
    mapper, count = part.mapper, array.GetNumberOfComponents()
    values = _arrays.vtk_values(array, part.what).reshape(-1, count)
    numbers = list(range(count))
    find = getattr(array, "GetFiniteRange", array.GetRange)
    ranges = [find(c) for c in numbers]
    is_smart = mapper.IsA("vtkSmartVolumeMapper") and count > 1
    if is_smart and mapper.GetVectorMode() == _MAGNITUDE:
        values = numpy.linalg.norm(values.astype(numpy.float64), axis=1)[:, numpy.newaxis]
        finite = values[numpy.isfinite(values)]
        numbers, ranges = [0], [(finite.min(initial=numpy.inf), finite.max(initial=-numpy.inf))]
    elif is_smart and mapper.GetVectorMode() == _ONE_COMPONENT:
        one = min(max(mapper.GetVectorComponent(), 0), count - 1)
        values, numbers, ranges = values[:, [one]], [one], [ranges[one]]
    placed = _arrays.vtk_components(part.data, values, centering)
    return numbers, ranges, [Volume(*each._replace(name=part.what)) for each in placed]


def _known_differences(part: Part) -> List[str]:
    """What VTK's own pictures of a grid are known to show otherwise."""
    look, found = part.volume.GetProperty(), []
    if part.mapper.GetCropping():
        found.append("the GPU mapper of VTK 9.1 crops up to half a voxel outside of its planes")
    if part.data.IsA("vtkRectilinearGrid"):
        found.append("VTK 9.1 shows rectilinear grids up to a voxel aside, and those with axes "
                     "that descend not at all")
    if look.HasGradientOpacity(0) and not look.GetDisableGradientOpacity(0):
        found.append("gradients are measured at the data values here, and their magnitudes "
                     "interpolated; in VTK they are those of interpolated gradients, which are "
                     "smaller in sheets of one or two voxels")
    if look.GetColorChannels(0) != 1:
        colors = look.GetRGBTransferFunction(0)
        if colors.GetScale() == _LOG10 and colors.GetSize() and colors.GetRange()[0] > 0:
            found.append("logarithmic colors are those of GetColor(); the GPU mapper of VTK 9.1 "
                         "looks them up at other values")
    return found
