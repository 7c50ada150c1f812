# SPDX-License-Identifier: Apache-2.0
"""Volumes of VTK as layers of a Scene."""
from __future__ import annotations

import math
from typing import Any, List

import numpy

from . import _arrays, _ghosts, _meshes
from ._pellucid import (Channels, Error, Gaussians, GradientOpacity, LabelTable, LabelVolume,
                        OpacityTable, TransferFunction, Volume)
from ._vtk_data import Chosen, chosen_data
from ._vtk_functions import FunctionReader, Range, joined
from ._vtk_view import items, matrix_of, power_factor
from .scene import ClipPlane, Layer, Shading

# vtkVolumeMapper's VTK_CROP_SUBVOLUME: the middle one of 27 regions is kept.
_CROP_SUBVOLUME = 0x0002000
# Fits of functions whose deviation nothing counts are within this part of any tolerance.
_FINEST = 1e-6


class LayerMaker:
    """Makes the layers of one renderer's volumes."""

    def __init__(self, tolerance: float, has_ambient_light: bool, notes: List[str]) -> None:
        self._tolerance, self._ambient, self._notes = tolerance, has_ambient_light, notes

    def layers(self, volume: Any, what: str) -> List[Layer]:
        """Returns the layers of a vtkVolume, or of the parts of a vtkMultiVolume."""
        mapper = volume.GetMapper()
        if mapper is None:
            raise Error(f"{what}: has no mapper")
        mapper.Update()
        if not volume.IsA("vtkMultiVolume"):
            data = (mapper.GetDataSetInput() if hasattr(mapper, "GetDataSetInput")
                    else mapper.GetInput())
            return self._layers_of_data(data, mapper, volume, what)
        layers: List[Layer] = []
        for port in range(mapper.GetNumberOfInputPorts()):
            part = (volume.GetVolume(port) if mapper.GetNumberOfInputConnections(port) > 0
                    else None)
            if part is not None:
                data = mapper.GetInputDataObject(port, 0)
                layers += self._layers_of_data(data, mapper, part, f"{what}, part {port + 1}")
        for layer in layers:
            layer.visible = layer.visible and bool(volume.GetVisibility())
        return layers

    def _layers_of_data(self, data: Any, mapper: Any, volume: Any, what: str) -> List[Layer]:
        if data is None and mapper.GetNumberOfInputConnections(0) > 0:
            data = mapper.GetInputDataObject(0, 0)
        if data is None:
            raise Error(f"{what}: its mapper has no input")
        if not data.IsA("vtkDataSet"):
            raise Error(f"{what}: its data are a {data.GetClassName()}; give each block a volume "
                        "of its own")
        is_grid, look = not _meshes.is_mesh(data), volume.GetProperty()
        self._refuse_others(mapper, look, is_grid, what)
        matrix = matrix_of(volume.GetMatrix())
        chosen = chosen_data(mapper, data, what)
        layers = (self._grid_layers(chosen, mapper, look, matrix, what) if is_grid
                  else [self._mesh_layer(chosen, look, what)])
        for layer in layers:
            layer.name, layer.visible = what, bool(volume.GetVisibility())
            layer.transform = matrix[:3].tolist()
            layer.clips = _clips(mapper, matrix, what, is_grid)
            if is_grid:
                _leave_out_ghosts(layer, data, matrix)
            if layer.shading is not None and not self._ambient:
                layer.shading.ambient = 0.0
        if is_grid and mapper.GetCropping():
            self._notes.append(f"{what}: the GPU mapper of VTK 9.1 crops up to half a voxel "
                               "outside of its planes")
        return layers

    def _refuse_others(self, mapper: Any, look: Any, is_grid: bool, what: str) -> None:
        if mapper.GetBlendMode() != 0:
            raise Error(f"{what}: its mapper blends by mode {mapper.GetBlendMode()}; only "
                        "composite (0) is an integral with absorption")
        if is_grid and look.GetTransferFunctionMode() != 0:
            raise Error(f"{what}: its functions are of two variables; take "
                        "SetTransferFunctionModeTo1D()")
        if is_grid and getattr(mapper, "GetMaskInput", lambda: None)() is not None:
            raise Error(f"{what}: its mapper has a mask; SetMaskInput(None), or take the plug-in "
                        "(pellucid.vtk.use())")

    def _reader(self, look: Any, what: str, share: float = 1.0) -> FunctionReader:
        return FunctionReader(look, share * self._tolerance, what, self._notes)

    def _mesh_layer(self, chosen: Chosen, look: Any, what: str) -> Layer:
        """Unstructured mappers take opacity / unit distance for the extinction itself."""
        if chosen.array.GetNumberOfComponents() != 1:
            raise Error(f"{what}: its array has {chosen.array.GetNumberOfComponents()} "
                        "components; one is shown, extract it")
        bounds = chosen.data.GetBounds()
        unit = self._unit_distance(look, what, max(numpy.subtract(bounds[1::2], bounds[::2])))
        reader = self._reader(look, what)
        opacities, colors = reader.opacities(0, math.inf, None), reader.colors(0, None)
        if look.GetShade(0):
            self._notes.append(f"{what}: volumes of unstructured grids have no light")
        points = [(x, a / unit, c) for x, a, c in joined(opacities, colors)]
        return Layer(_meshes.mesh_of(chosen.data),
                     TransferFunction(points, opacities.deviation, colors.deviation))

    def _grid_layers(self, chosen: Chosen, mapper: Any, look: Any, matrix: numpy.ndarray,
                     what: str) -> List[Layer]:
        components = _arrays.vtk_components(chosen.data)
        volumes = [Volume(one.array, spacing=one.spacing, origin=one.origin,
                          direction=one.direction, coordinates=one.coordinates,
                          centering=one.centering, name=what) for one in components]
        if chosen.data.IsA("vtkRectilinearGrid"):
            self._notes.append(f"{what}: VTK 9.1 shows rectilinear grids up to a voxel aside, and "
                               "those with axes that descend not at all")
        # VTK's mappers measure the unit distance in the volume's own world, before its matrix.
        scale = abs(numpy.linalg.det(matrix[:3, :3])) ** (1 / 3)
        scales = numpy.linalg.norm(matrix[:3, :3], axis=0)
        if scales.max() > 1.000001 * scales.min():
            self._notes.append(f"{what}: is scaled unevenly, and has opacities by the mean of its "
                               "scales")
        ramps = [chosen.ramp(mapper, component) for component in range(len(components))]
        if len(components) > 1 and not look.GetIndependentComponents():
            return [self._dependent_layer(volumes, look, scale, ramps, what)]
        shown = [c for c in range(len(components))
                 if len(components) == 1 or look.GetComponentWeight(c) > 0]
        single = chosen.vector_component(mapper)
        if single is not None and len(components) > 1:
            shown = [single]
        if len(shown) > 1:
            self._notes.append(f"{what}: components mix as particles do; VTK adds their colors")
        if len(components) > 4:
            raise Error(f"{what}: its array has {len(components)} components; VTK shows up to 4, "
                        "extract some")
        layers = []
        for c in shown:
            weight = (look.GetComponentWeight(c)
                      if len(components) > 1 and single is None else 1.0)
            unit = self._unit_distance(look, what, volumes[c].voxel_size, c) * scale / weight
            share = 0.5 / len(shown) if len(shown) > 1 else 1.0
            layers.append(self._component_layer(components[c].array, volumes[c], look, c, unit,
                                                ramps[c], self._reader(look, what, share), what))
        return layers

    def _component_layer(self, values: numpy.ndarray, volume: Volume, look: Any, component: int,
                         unit: float, ramp: Range, reader: FunctionReader, what: str) -> Layer:
        gradients = reader.gradients(component, ramp)
        is_nearest = look.GetInterpolationType() != 1
        if is_nearest and not (look.GetShade(component) or gradients):
            return _nearest_layer(values, volume, reader, component, ramp, unit)
        if is_nearest:
            self._notes.append(f"{what}: nearest values are shown without light and gradient "
                               "opacity; here the data are trilinear "
                               "(SetInterpolationTypeToLinear())")
        opacities, colors = reader.opacities(component, 1.0, ramp), reader.colors(component, ramp)
        # A factor's ratio is one of the extinction.
        deviation = opacities.deviation + (gradients.deviation if gradients else 0.0)
        layer = Layer(volume, OpacityTable(joined(opacities, colors), unit, deviation,
                                           colors.deviation))
        if gradients:
            layer.gradient_opacity = GradientOpacity(
                list(zip(gradients.x.tolist(), gradients.y[:, 0].tolist())), unit="voxel")
            self._notes.append(f"{what}: gradients are measured at the data values here, and their "
                               "magnitudes interpolated; in VTK they are those of interpolated "
                               "gradients, which are smaller in sheets of one or two voxels")
        if look.GetShade(component):
            layer.shading = self._shading(look, component, what)
        return layer

    def _dependent_layer(self, volumes: List[Volume], look: Any, scale: float,
                         ramps: List[Range], what: str) -> Layer:
        """The last component has the opacity. The first of two has the color, of four the first
        three are red, green and blue: each a third of the particles, three times as bright."""
        if len(volumes) not in (2, 4):
            raise Error(f"{what}: has {len(volumes)} dependent components, but VTK shows 2 or 4; "
                        "add opacities")
        reader = FunctionReader(look, _FINEST, what, self._notes)
        unit = self._unit_distance(look, what, volumes[-1].voxel_size) * scale
        names = [str(c) for c in range(len(volumes))]
        if len(volumes) == 2:
            colors = reader.colors(0, ramps[0])
            tables = {"0": TransferFunction([(x, 1.0, tuple(c)) for x, c
                                             in zip(colors.x.tolist(), colors.y.tolist())])}
        else:
            largest = {"u8": 255.0, "u16": 65535.0, "f32": 1.0, "f64": 1.0}.get(volumes[0].type)
            if largest is None:
                raise Error(f"{what}: has colors of the type {volumes[0].type}; give unsigned "
                            "char, from 0 to 255")
            tables = {names[c]: TransferFunction([(0, 1 / 3, (0, 0, 0)),
                                                  (largest, 1 / 3, tuple(3.0 * (c == k)
                                                                         for k in range(3)))])
                      for c in range(3)}
        opacities = reader.opacities(0, 1.0, ramps[-1])
        # Far within any tolerance that is asked for later.
        factors = OpacityTable([(x, a, (0, 0, 0)) for x, a
                                in zip(opacities.x.tolist(), opacities.y[:, 0].tolist())],
                               unit).transfer_function(_FINEST)
        factor = (names[-1], [(x, extinction) for x, extinction, _ in factors.points])
        layer = Layer(Channels(dict(zip(names, volumes))),
                      Gaussians([], channels=names, tables=tables, factor=factor))
        if look.HasGradientOpacity(0) and not look.GetDisableGradientOpacity(0):
            self._notes.append(f"{what}: gradient opacities of dependent components are left out")
        if look.GetInterpolationType() != 1:
            self._notes.append(f"{what}: dependent components are trilinear")
        if look.GetShade(0):
            layer.shading = self._shading(look, 0, what)
        return layer

    def _unit_distance(self, look: Any, what: str, size: float, component: int = 0) -> float:
        unit = look.GetScalarOpacityUnitDistance(component)
        if unit > 0 and math.isfinite(unit):
            return min(max(unit, 1e-20), 1e30)
        if unit == 0:
            self._notes.append(f"{what}: a unit distance of 0 makes all opaque that absorbs")
            return 1e-6 * size
        self._notes.append(f"{what}: a unit distance is no positive number, and taken as 1")
        return 1.0

    def _shading(self, look: Any, component: int, what: str) -> Shading:
        """VTK's normals have length 1 wherever the gradient is not 0."""
        def number(value: float, least: float, most: float, otherwise: float) -> float:
            if least <= value <= most:
                return value
            self._notes.append(f"{what}: a number of the shading is beyond its range, and brought "
                               "into it")
            return otherwise if math.isnan(value) else min(max(value, least), most)

        power = power_factor() * look.GetSpecularPower(component)
        return Shading(number(look.GetAmbient(component), 0, 1000, 0.1),
                       number(look.GetDiffuse(component), 0, 1000, 0.7),
                       number(look.GetSpecular(component), 0, 1000, 0.2),
                       1.0 if 0 <= power < 1 else number(power, 1, 1000, 10.0), flatness=0.0)


def _nearest_layer(values: numpy.ndarray, volume: Volume, reader: FunctionReader, component: int,
                   ramp: Range, unit: float) -> Layer:
    """Each place has the nearest value: a segmentation, whose labels are the values' places in
    ascending order."""
    different, labels = numpy.unique(values, return_inverse=True)
    numbers = labels.reshape(values.shape).astype(numpy.float32)
    if values.dtype.kind == "f":
        numbers[numpy.isnan(values)] = numpy.nan
        different = different[~numpy.isnan(different)]
    looks = {}
    for label, (opacity, color) in enumerate(reader.looks(component, different.tolist(), ramp)):
        if not opacity > 0:
            continue
        depth = -math.log1p(-opacity) if opacity < 1 else 1e6
        looks[label] = (color, min(depth, 1e6) / unit)
    place = Volume(numbers, spacing=volume.spacing, origin=volume.origin,
                   direction=volume.direction, coordinates=volume.coordinates,
                   centering=volume.centering)
    return Layer(LabelVolume(place), labels=LabelTable(looks or {0: ((0, 0, 0), 0.0)}))


def _clips(mapper: Any, matrix: numpy.ndarray, what: str, is_grid: bool) -> List[ClipPlane]:
    clips = []
    planes = mapper.GetClippingPlanes()
    for plane in items(planes) if planes is not None else []:
        clips.append(ClipPlane(tuple(plane.GetOrigin()), tuple(plane.GetNormal())))
    if not (is_grid and mapper.GetCropping()):
        return clips
    if mapper.GetCroppingRegionFlags() != _CROP_SUBVOLUME:
        raise Error(f"{what}: is cropped to other regions than the middle one; use "
                    "SetCroppingRegionFlagsToSubVolume() or clipping planes")
    bounds = mapper.GetCroppingRegionPlanes()
    # Normals go to the world by the inverse transpose of what brings points there.
    normals = numpy.linalg.inv(matrix[:3, :3]).T
    for axis in range(3):
        for side, sign in ((2 * axis, 1.0), (2 * axis + 1, -1.0)):
            point = numpy.zeros(3)
            point[axis] = bounds[side]
            clips.append(ClipPlane(tuple(matrix[:3, :3] @ point + matrix[:3, 3]),
                                   tuple(sign * normals[:, axis])))
    return clips


def _leave_out_ghosts(layer: Layer, data: Any, matrix: numpy.ndarray) -> None:
    """Clips a layer at the cells of its grid that are another block's."""
    box = _ghosts.own_box(data)
    if box is None:
        return
    first, end = box
    if first == end:
        layer.visible = False
        return
    sides = [side - 1 for side in data.GetDimensions()]

    def place(i: int, j: int, k: int) -> numpy.ndarray:
        point = numpy.array(data.GetPoint(i + (sides[0] + 1) * (j + (sides[1] + 1) * k)))
        return matrix[:3, :3] @ point + matrix[:3, 3]

    near, far = place(*first), place(*end)
    edges = [place(*(end[a] if a == axis else first[a] for a in range(3))) - near
             for axis in range(3)]
    for axis in range(3):
        normal = numpy.cross(edges[axis - 2], edges[axis - 1])
        normal *= numpy.sign(normal @ edges[axis])
        if first[axis] > 0:
            layer.clips.append(ClipPlane(tuple(near), tuple(normal)))
        if end[axis] < sides[axis]:
            layer.clips.append(ClipPlane(tuple(far), tuple(-normal)))


