# SPDX-License-Identifier: Apache-2.0
"""Scenes of live VTK renderers, and how far VTK's own pictures of them are off.

    audit = pellucid.vtk.audit(render_window)
    print(audit)

VTK composites the numbers of its functions, whatever display they are meant for. So do scenes made
here: their "linear" colors are those numbers. VTK is not imported; the objects bring it with them.

    pellucid.vtk.use()                       # VTK's mappers that are made from here on draw by us
    mapper = vtkSmartVolumeMapper()
    pellucid.vtk.settings(mapper).tolerance = 1e-3

use() needs the plug-in for VTK (plugins/vtk), which imports VTK.
"""
from __future__ import annotations

import math
import sys
from dataclasses import dataclass, field
from typing import Any, List, Sequence, Tuple

import numpy

from . import _arrays, _ghosts, _meshes
from ._pellucid import (Channels, Error, Gaussians, GradientOpacity, Image, LabelTable, LabelVolume,
                        OpacityTable, Renderer, TransferFunction, Volume)
from .scene import (Camera, ClipPlane, DirectionalLight, HeadLight, Integration, Layer, PointLight,
                    Scene, Shading)

# Points that stand for a curve of VTK that is not straight, between two of its nodes.
_POINTS_PER_CURVE = 64
# vtkVolumeMapper's VTK_CROP_SUBVOLUME: the middle one of 27 regions is kept.
_CROP_SUBVOLUME = 0x0002000

Curve = List[Tuple[float, numpy.ndarray]]


@dataclass
class Audit:
    """How far VTK's picture is from the volume rendering integral of what it shows."""

    ours: Image
    """Within its tolerance of the integral; premultiplied numbers of VTK's functions."""
    theirs: Image
    """VTK's picture, premultiplied, in the same numbers."""
    scene: Scene
    largest: float
    """Largest difference of any channel of any pixel (red, green, blue, opacity)."""
    rms: float
    share_over_255: float
    """Share of pixels with a channel that is off by more than 1/255."""
    at: Tuple[int, int]
    """(row, column) of the largest difference."""
    difference: numpy.ndarray = field(repr=False)
    """float32 (height, width, 4), |ours - theirs|."""
    notes: List[str] = field(default_factory=list)
    """What was left out, or is known to differ."""

    def picture(self, scale: float = 1.0) -> Image:
        """Returns a grey picture of the largest difference of each pixel, times `scale`."""
        grey = numpy.clip(self.difference.max(axis=2) * scale, 0, 1)
        return Image(numpy.stack([grey, grey, grey, numpy.ones_like(grey)], axis=2))

    def __str__(self) -> str:
        row, column = self.at
        lines = [f"largest difference {self.largest:.3g} (row {row}, column {column}), RMS "
                 f"{self.rms:.3g}",
                 f"{100 * self.share_over_255:.2f} % of the pixels are off by more than 1/255",
                 f"the truth is known to within {self.ours.report['largest_error']:.2g}"]
        return "\n".join(lines + self.notes)


def _plugin() -> Any:
    try:
        from . import vtkPellucid
    except ImportError as error:
        raise Error("pellucid.vtk: the plug-in for VTK is not there; build Pellucid with VTK 9.1 "
                    f"for this Python (Debian: libvtk9-dev, python3-vtk9; {error})") from None
    return vtkPellucid


def use(on: bool = True) -> None:
    """Begins to draw by Pellucid where a program asks for VTK's mappers; use(False) ends it.

    These are vtkGPUVolumeRayCastMapper, vtkSmartVolumeMapper and vtkProjectedTetrahedraMapper that
    are made after the call. For vtkFixedPointVolumeRayCastMapper,
    vtkUnstructuredGridVolumeRayCastMapper and vtkUnstructuredGridVolumeZSweepMapper VTK 9.1 asks
    nobody: preload libvtkPellucidPreload.so. Raises Error if the plug-in is not there.
    """
    _plugin().vtkPellucidFactory.Use(on)


class MapperSettings:
    """Settings of a mapper that draws by Pellucid, and what is known of its last picture."""

    def __init__(self, mapper: Any) -> None:
        self._mapper = mapper
        self._factory = _plugin().vtkPellucidFactory

    def _set(self, name: str, value: float) -> None:
        if not self._factory.Set(self._mapper, name, value):
            raise Error(f"{name}: {value!r} is not taken")

    @property
    def tolerance(self) -> float:
        """The largest error that a pixel may have; limited to 1e-7 to 1."""
        return float(self._factory.Get(self._mapper, "Tolerance"))

    @tolerance.setter
    def tolerance(self, value: float) -> None:
        self._set("Tolerance", value)

    @property
    def grade(self) -> str:
        """What errors may rest on: "estimated" or "proved"."""
        return "proved" if self._factory.Get(self._mapper, "Grade") == 1 else "estimated"

    @grade.setter
    def grade(self, value: str) -> None:
        if value not in ("estimated", "proved"):
            raise Error(f"grade: {value!r} is neither \"estimated\" nor \"proved\"")
        self._set("Grade", 1 if value == "proved" else 0)

    @property
    def threads(self) -> int:
        """The number of threads; 0: one per core."""
        return int(self._factory.Get(self._mapper, "NumberOfThreads"))

    @threads.setter
    def threads(self, value: int) -> None:
        self._set("NumberOfThreads", value)

    @property
    def exact(self) -> bool:
        """Whether all pixels of the last picture were rendered; not so while the user interacts."""
        return bool(self._factory.Get(self._mapper, "Exact"))

    @property
    def largest_error(self) -> float:
        """The largest error of a pixel of the last picture; infinite if it is not exact."""
        return float(self._factory.Get(self._mapper, "LargestError"))

    @property
    def pixels_over(self) -> int:
        """How many pixels of the last picture may be over the tolerance."""
        return int(self._factory.Get(self._mapper, "PixelsOver"))

    @property
    def seconds(self) -> float:
        """How long the last picture took."""
        return float(self._factory.Get(self._mapper, "Seconds"))


def settings(mapper: Any) -> MapperSettings:
    """Returns the settings of a mapper that draws by Pellucid. Raises Error for others."""
    if not (_is_a(mapper, "vtkAbstractVolumeMapper")
            and _plugin().vtkPellucidFactory.Has(mapper)):
        if _is_a(mapper, "vtkSmartVolumeMapper") and mapper.GetRequestedRenderMode() not in (0, 2):
            raise Error(f"mapper: {mapper!r:.60} draws by another mapper in its render mode; call "
                        "SetRequestedRenderModeToDefault()")
        raise Error(f"mapper: {mapper!r:.60} does not draw by Pellucid; make it after "
                    "pellucid.vtk.use()")
    return MapperSettings(mapper)


def scene_of(renderer: Any, notes: Any = None) -> Scene:
    """Returns the Scene that a vtkRenderer shows: volumes, properties, camera, lights, clipping.

    renderer  a vtkRenderer, or a plotter of PyVista
    notes     a list that receives lines on what is left out; else these are warnings

    Volumes of vtkImageData or vtkRectilinearGrid take their opacities per unit distance, those of
    unstructured grids as extinctions. Clipping and cropping planes become clips. Other props are
    left out. Dependent components become Channels with a factor, and the nearest values of an unlit
    volume a LabelVolume. Raises Error for what has no counterpart: independent components, blend
    modes other than composite.

    The window and level of the final color are those of a picture: finished() applies them.
    """
    renderer = getattr(renderer, "renderer", renderer)
    if not _is_a(renderer, "vtkRenderer"):
        raise Error(f"renderer: expected a vtkRenderer, got {renderer!r:.60}")
    told: List[str] = []
    ambient = _has_ambient_light(renderer)
    layers = [_layer(prop, f"volume {i + 1}", ambient, told)
              for i, prop in enumerate(_items(renderer.GetVolumes()))]
    if not layers:
        raise Error("renderer: has no vtkVolume; add one before its scene is asked for")
    if len(layers) > 1:
        told.append("VTK draws volumes one over the other; here overlapping ones mix")
    others = sum(1 for prop in _items(renderer.GetViewProps())
                 if not _is_a(prop, "vtkVolume") and prop.GetVisibility())
    if others:
        told.append(f"{others} props that are no volumes are left out")
    width, height = renderer.GetSize()
    if width < 1 or height < 1:
        raise Error("renderer: has no size; add it to a window")
    scene = Scene(layers, size=(width, height), lights=_lights(renderer, told))
    scene.camera = _camera(renderer.GetActiveCamera(), width / height)
    if notes is None:
        _warn(told)
    else:
        notes.extend(told)
    return scene


def finished(renderer: Any, image: Image) -> Image:
    """Returns a picture of scene_of() with the window and level of the final color.

    They are those of the mapper of the renderer's first volume: colors from level - window / 2 to
    level + window / 2 become 0 to 1. Without them it is the image itself.
    """
    renderer = getattr(renderer, "renderer", renderer)
    for volume in _items(renderer.GetVolumes()):
        mapper = volume.GetMapper()
        if not hasattr(mapper, "GetFinalColorWindow"):
            break
        window, level = mapper.GetFinalColorWindow(), mapper.GetFinalColorLevel()
        if (window, level) == (1.0, 0.5) or not window or not math.isfinite(level / window):
            break
        rgba = numpy.array(image.rgba, dtype=numpy.float32)
        rgba[..., :3] = rgba[..., :3] / window + (0.5 - level / window) * rgba[..., 3:]
        return Image(rgba)
    return image


def audit(render_window: Any, tolerance: float = 1 / 4096, progress: Any = None) -> Audit:
    """Renders what a vtkRenderWindow shows to a tolerance, and compares VTK's own picture with it.

    render_window  a vtkRenderWindow whose first renderer with volumes is taken, or a plotter of
                   PyVista
    tolerance      of the picture that VTK's is held against

    VTK draws into a buffer of floats, without other props and without its background; the window is
    left as it was. Raises Error as scene_of() does.
    """
    window = getattr(render_window, "render_window", getattr(render_window, "ren_win",
                                                             render_window))
    if not _is_a(window, "vtkRenderWindow"):
        raise Error(f"render_window: expected a vtkRenderWindow, got {window!r:.60}")
    renderers = [each for each in _items(window.GetRenderers())
                 if each.GetVolumes().GetNumberOfItems() > 0]
    if not renderers:
        raise Error("render_window: none of its renderers has a volume")
    renderer = renderers[0]
    notes: List[str] = []
    theirs = Image(_picture(window, renderer))
    scene = scene_of(renderer, notes)
    scene.integration = Integration(tolerance=tolerance)
    ours = Renderer().render(scene, progress=progress)
    shown = finished(renderer, ours)
    if shown is not ours:
        notes.append("the final color has a window and a level; ours is without, for comparison "
                     "with them")
    found = shown.compare(theirs)
    if found.not_finite:
        notes.append(f"{found.not_finite} numbers of VTK's picture are not finite")
    return Audit(ours, theirs, scene, found.largest, found.rms, found.share_over_255, found.at,
                 found.difference, notes)


def _is_a(data: Any, name: str) -> bool:
    return callable(getattr(data, "IsA", None)) and bool(data.IsA(name))


def _items(collection: Any) -> List[Any]:
    return [collection.GetItemAsObject(i) for i in range(collection.GetNumberOfItems())]


def _warn(lines: Sequence[str]) -> None:
    import warnings

    from ._notes import Note

    for line in lines:
        warnings.warn(line, Note, stacklevel=3)


def _layer(volume: Any, what: str, ambient: bool, notes: List[str]) -> Layer:
    mapper, look = volume.GetMapper(), volume.GetProperty()
    if mapper is None:
        raise Error(f"{what}: has no mapper")
    mapper.Update()
    data = mapper.GetDataSetInput() if hasattr(mapper, "GetDataSetInput") else mapper.GetInput()
    if data is None:
        raise Error(f"{what}: its mapper has no input")
    is_grid = not _meshes.is_mesh(data)
    if is_grid and mapper.GetBlendMode() != 0:
        raise Error(f"{what}: its mapper blends by mode {mapper.GetBlendMode()}; only composite "
                    "(0) is an integral with absorption")
    matrix = _matrix(volume.GetMatrix())
    layer = (_grid_layer(data, look, matrix, what, notes) if is_grid
             else _mesh_layer(data, look, what, notes))
    layer.name, layer.visible = what, bool(volume.GetVisibility())
    layer.transform = matrix[:3].tolist()
    layer.clips = _clips(mapper, matrix, what, is_grid)
    if is_grid:
        _leave_out_ghosts(layer, data, matrix)
    if is_grid and mapper.GetCropping():
        notes.append(f"{what}: the GPU mapper of VTK 9.1 crops up to half a voxel outside of its "
                     "planes")
    if layer.shading is not None and not ambient:
        layer.shading.ambient = 0.0
    return layer


def _mesh_layer(data: Any, look: Any, what: str, notes: List[str]) -> Layer:
    """Unstructured mappers take opacity / unit distance for the extinction itself."""
    bounds = data.GetBounds()
    unit = _unit_distance(look, what, max(numpy.subtract(bounds[1::2], bounds[::2])), notes)
    points = _joined(_opacity_curve(look, what, notes), _color_curve(look, what, notes))
    return Layer(_meshes.mesh_of(data), TransferFunction(
        [(x, max(a[0], 0.0) / unit, tuple(c)) for x, a, c in points]))


def _grid_layer(data: Any, look: Any, matrix: numpy.ndarray, what: str,
                notes: List[str]) -> Layer:
    components = _arrays.vtk_components(data)
    if len(components) > 1 and look.GetIndependentComponents():
        raise Error(f"{what}: its array has {len(components)} independent components; extract one "
                    "(vtkImageExtractComponents)")
    volumes = [Volume(one.array, spacing=one.spacing, origin=one.origin, direction=one.direction,
                      coordinates=one.coordinates, centering=one.centering, name=what)
               for one in components]
    unit = _unit_distance(look, what, volumes[0].voxel_size, notes)
    # VTK's mappers measure the unit distance in the volume's own world, before its matrix.
    unit *= abs(numpy.linalg.det(matrix[:3, :3])) ** (1 / 3)
    scales = numpy.linalg.norm(matrix[:3, :3], axis=0)
    if scales.max() > 1.000001 * scales.min():
        notes.append(f"{what}: is scaled unevenly, and has opacities by the mean of its scales")
    opacities = [(x, numpy.clip(a, 0, 1)) for x, a in _opacity_curve(look, what, notes)]
    is_nearest = look.GetInterpolationType() != 1
    gradients = ([] if look.GetDisableGradientOpacity(0) or not look.HasGradientOpacity(0)
                 else _from_zero(_curve_of(look.GetGradientOpacity(0), what, notes)))
    if len(components) > 1:
        layer = _dependent_layer(volumes, look, opacities, unit, what, notes)
        if gradients:
            notes.append(f"{what}: gradient opacities of dependent components are left out")
        if is_nearest:
            notes.append(f"{what}: dependent components are trilinear")
    else:
        colors = _color_curve(look, what, notes)
        if is_nearest and not (look.GetShade(0) or gradients):
            return _nearest_layer(components[0].array, volumes[0], opacities, colors, unit)
        if is_nearest:
            notes.append(f"{what}: nearest values are shown without light and gradient opacity; "
                         "here the data are trilinear (SetInterpolationTypeToLinear())")
        points = _joined(opacities, colors)
        layer = Layer(volumes[0], OpacityTable([(x, a[0], tuple(c)) for x, a, c in points], unit))
        if gradients:
            layer.gradient_opacity = GradientOpacity([(x, max(y[0], 0.0)) for x, y in gradients],
                                                     unit="voxel")
            notes.append(f"{what}: gradients are measured at the data values here, and their "
                         "magnitudes interpolated; in VTK they are those of interpolated "
                         "gradients, which are smaller in sheets of one or two voxels")
    if look.GetShade(0):
        layer.shading = _shading(look, what, notes)
    return layer


def _dependent_layer(volumes: List[Volume], look: Any, opacities: Curve, unit: float, what: str,
                     notes: List[str]) -> Layer:
    """The last component has the opacity. The first of two has the color, of four the first three
    are red, green and blue: each of them a third of the particles, three times as bright."""
    if len(volumes) == 3:
        raise Error(f"{what}: has 3 dependent components, but VTK shows 2 or 4; add opacities")
    names = [str(c) for c in range(len(volumes))]
    if len(volumes) == 2:
        tables = {"0": TransferFunction([(x, 1.0, tuple(c))
                                         for x, c in _color_curve(look, what, notes)])}
    else:
        largest = {"u8": 255.0, "u16": 65535.0, "f32": 1.0, "f64": 1.0}.get(volumes[0].type)
        if largest is None:
            raise Error(f"{what}: has colors of the type {volumes[0].type}; give unsigned char, "
                        "from 0 to 255")
        tables = {names[c]: TransferFunction([(0, 1 / 3, (0, 0, 0)),
                                              (largest, 1 / 3, tuple(3.0 * (c == k)
                                                                     for k in range(3)))])
                  for c in range(3)}
    # Far within any tolerance that is asked for later.
    factors = OpacityTable([(x, a[0], (0, 0, 0)) for x, a in opacities],
                           unit).transfer_function(1e-6)
    factor = (names[-1], [(x, extinction) for x, extinction, _ in factors.points])
    return Layer(Channels(dict(zip(names, volumes))),
                 Gaussians([], channels=names, tables=tables, factor=factor))


def _nearest_layer(values: numpy.ndarray, volume: Volume, opacities: Curve, colors: Curve,
                   unit: float) -> Layer:
    """Each place has the nearest value: a segmentation, whose labels are the values' places in
    ascending order."""
    different, labels = numpy.unique(values, return_inverse=True)
    numbers = labels.reshape(values.shape).astype(numpy.float32)
    if values.dtype.kind == "f":
        numbers[numpy.isnan(values)] = numpy.nan
    looks = {}
    for label, value in enumerate(different.tolist()):
        opacity = _limits(opacities, value)[1][0]
        if not opacity > 0:
            continue
        depth = -math.log1p(-opacity) if opacity < 1 else 1e6
        looks[label] = (tuple(_limits(colors, value)[1]), min(depth, 1e6) / unit)
    place = Volume(numbers, spacing=volume.spacing, origin=volume.origin,
                   direction=volume.direction, coordinates=volume.coordinates,
                   centering=volume.centering)
    return Layer(LabelVolume(place), labels=LabelTable(looks or {0: ((0, 0, 0), 0.0)}))


def _unit_distance(look: Any, what: str, size: float, notes: List[str]) -> float:
    unit = look.GetScalarOpacityUnitDistance(0)
    if unit > 0 and math.isfinite(unit):
        return unit
    if unit == 0:
        notes.append(f"{what}: a unit distance of 0 makes all opaque that absorbs")
        return 1e-6 * size
    notes.append(f"{what}: a unit distance is no positive number, and taken as 1")
    return 1.0


def _shading(look: Any, what: str, notes: List[str]) -> Shading:
    """VTK's normals have length 1 wherever the gradient is not 0."""
    def number(value: float, least: float, most: float, otherwise: float) -> float:
        if least <= value <= most:
            return value
        notes.append(f"{what}: a number of the shading is beyond its range, and brought into it")
        return otherwise if math.isnan(value) else min(max(value, least), most)

    power = look.GetSpecularPower(0)
    return Shading(number(look.GetAmbient(0), 0, 1000, 0.1),
                   number(look.GetDiffuse(0), 0, 1000, 0.7),
                   number(look.GetSpecular(0), 0, 1000, 0.2),
                   1.0 if 0 <= power < 1 else number(power, 1, 1000, 10.0), flatness=0.0)


def _from_zero(curve: Curve) -> Curve:
    """Magnitudes begin at 0."""
    if curve[0][0] >= 0:
        return curve
    return [(0.0, _limits(curve, 0.0)[1]), *((x, y) for x, y in curve if x > 0)]


def _matrix(matrix: Any) -> numpy.ndarray:
    return numpy.array([[matrix.GetElement(row, column) for column in range(4)]
                        for row in range(4)])


def _curve(nodes: List[Sequence[float]], values: int, straight: bool, evaluate: Any,
           clamped: bool) -> Curve:
    """Points of a function with nodes (x, values, midpoint, sharpness): exact where it is straight
    between two nodes, else a chain of chords. Two points at one x are a jump."""
    zero = numpy.zeros(values)
    if not nodes:
        return [(0.0, zero)]
    points: Curve = []
    for i, node in enumerate(nodes):
        x, midpoint, sharpness = node[0], node[-2], node[-1]
        points.append((x, numpy.array(node[1:1 + values])))
        if i + 1 == len(nodes) or (straight and midpoint == 0.5 and sharpness == 0):
            continue
        for share in numpy.linspace(0, 1, _POINTS_PER_CURVE + 1)[1:-1]:
            between = x + share * (nodes[i + 1][0] - x)
            points.append((between, numpy.array(evaluate(between), dtype=float)))
    if not clamped:
        points = [(points[0][0], zero), *points, (points[-1][0], zero)]
    return points


def _are_numbers(node: List[float], what: str, notes: List[str]) -> bool:
    if not any(math.isnan(each) for each in node):
        return True
    line = f"{what}: nodes of functions that are no numbers are left out"
    if line not in notes:
        notes.append(line)
    return False


def _curve_of(function: Any, what: str, notes: List[str]) -> Curve:
    """A vtkPiecewiseFunction."""
    nodes = []
    for i in range(function.GetSize()):
        node = [0.0] * 4
        function.GetNodeValue(i, node)
        if _are_numbers(node, what, notes):
            nodes.append(node)
    straight = not function.GetUseLogScale()
    return _curve(nodes, 1, straight, lambda x: [function.GetValue(x)],
                  bool(function.GetClamping()))


def _opacity_curve(look: Any, what: str, notes: List[str]) -> Curve:
    return _curve_of(look.GetScalarOpacity(0), what, notes)


def _color_curve(look: Any, what: str, notes: List[str]) -> Curve:
    """Colors of the first component. A window shows what is below 0 as 0."""
    if look.GetColorChannels(0) == 1:
        grey = _curve_of(look.GetGrayTransferFunction(0), what, notes)
        return [(x, numpy.maximum(numpy.repeat(value, 3), 0)) for x, value in grey]
    function = look.GetRGBTransferFunction(0)
    nodes = []
    for i in range(function.GetSize()):
        node = [0.0] * 6
        function.GetNodeValue(i, node)
        if _are_numbers(node, what, notes):
            nodes.append(node)
    rgb, linear = 0, 0
    straight = function.GetColorSpace() == rgb and function.GetScale() == linear
    curve = _curve(nodes, 3, straight, function.GetColor, bool(function.GetClamping()))
    return [(x, numpy.maximum(value, 0)) for x, value in curve]


def _limits(curve: Curve, x: float) -> Tuple[numpy.ndarray, numpy.ndarray]:
    """The values of a curve just below and just above x."""
    places = numpy.array([point[0] for point in curve])
    values = numpy.array([point[1] for point in curve])

    def between(index: int) -> numpy.ndarray:
        """On the stretch in front of point `index`."""
        if index == 0:
            return values[0]
        if index == len(places):
            return values[-1]
        width = places[index] - places[index - 1]
        share = (x - places[index - 1]) / width
        return values[index - 1] + share * (values[index] - values[index - 1])

    first, end = numpy.searchsorted(places, x, "left"), numpy.searchsorted(places, x, "right")
    if first == end:  # between two points
        value = between(int(first))
        return value, value
    return values[first], values[end - 1]


def _joined(opacities: Curve, colors: Curve) -> List[Tuple[float, numpy.ndarray, numpy.ndarray]]:
    """Both curves at the points of each, where one of them jumps twice."""
    joined = []
    for x in sorted({point[0] for point in opacities} | {point[0] for point in colors}):
        below = (_limits(opacities, x)[0], _limits(colors, x)[0])
        above = (_limits(opacities, x)[1], _limits(colors, x)[1])
        joined.append((x, *below))
        if not (numpy.array_equal(below[0], above[0]) and numpy.array_equal(below[1], above[1])):
            joined.append((x, *above))
    return joined


def _clips(mapper: Any, matrix: numpy.ndarray, what: str, is_grid: bool) -> List[ClipPlane]:
    clips = []
    planes = mapper.GetClippingPlanes()
    for plane in _items(planes) if planes is not None else []:
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


def _camera(camera: Any, aspect: float) -> Camera:
    for name, default in (("GetWindowCenter", (0.0, 0.0)), ("GetViewShear", (0.0, 0.0, 1.0))):
        if tuple(getattr(camera, name)()) != default:
            raise Error(f"camera: its {name[3:]} is {getattr(camera, name)()}; set {default}")
    matrix = _matrix(camera.GetProjectionTransformMatrix(aspect, -1, 1))
    is_parallel = matrix[3, 2] == 0
    divisor = matrix[3, 3] if is_parallel else -matrix[3, 2]
    column = 3 if is_parallel else 2
    if divisor > 0:
        matrix /= divisor
    center = matrix[:2, column]
    lens = numpy.zeros((4, 4))
    lens[0, 0], lens[1, 1], lens[3, column] = matrix[0, 0], matrix[1, 1], matrix[3, column]
    lens[2, 2:], lens[:2, column] = matrix[2, 2:], center
    if not (divisor > 0 and numpy.abs(matrix - lens).max() <= 1e-9 and matrix[0, 0] > 0
            and matrix[1, 1] > 0):
        raise Error("camera: its projection is none of a pinhole or of parallel rays; take a "
                    "frustum")
    if center.any():
        raise Error(f"camera: its projection has the center {center.tolist()}; set [0.0, 0.0]")
    if abs(matrix[0, 0] * aspect / matrix[1, 1] - 1) > 1e-6:
        raise Error(f"camera: by its projection pixels are not square; take one of the aspect "
                    f"ratio {aspect:g}")
    half = 1 / matrix[1, 1]
    where = tuple(camera.GetPosition()), tuple(camera.GetFocalPoint()), tuple(camera.GetViewUp())
    if is_parallel:
        return Camera(*where, parallel_scale=half, projection="orthographic")
    return Camera(*where, vertical_angle=math.degrees(2 * math.atan(half)))


def _has_ambient_light(renderer: Any) -> bool:
    """Whether a property's ambient part is seen: VTK gives its color to it under one head light of
    intensity 1; under other lights it has their own ambient colors, black unless they are set."""
    lights = [light for light in _items(renderer.GetLights()) if light.GetSwitch()]
    return not lights or (len(lights) == 1 and bool(lights[0].LightTypeIsHeadlight())
                          and lights[0].GetIntensity() == 1)


def _lights(renderer: Any, notes: List[str]) -> List[Any]:
    """Lights as the GPU mapper has them. A head light alone is at the camera, also of parallel
    rays; beside others it shines along the camera's axis."""
    camera = renderer.GetActiveCamera()
    shining = [light for light in _items(renderer.GetLights()) if light.GetSwitch()]
    lights: List[Any] = []
    for light in shining:
        color = tuple(light.GetIntensity() * c for c in light.GetDiffuseColor())
        if any(light.GetAmbientColor()) and not _has_ambient_light(renderer):
            notes.append("the ambient color of lights is left out")
        if light.LightTypeIsHeadlight():
            if len(shining) > 1:
                lights.append(DirectionalLight(tuple(camera.GetDirectionOfProjection()), color))
            else:
                lights.append(_head_light(camera, color, notes))
        elif light.GetPositional():
            if tuple(light.GetAttenuationValues()) != (1.0, 0.0, 0.0) or light.GetConeAngle() < 90:
                notes.append("a light has a cone or an attenuation, which is left out")
            lights.append(PointLight(tuple(light.GetTransformedPosition()), color))
        else:
            lights.append(DirectionalLight(
                tuple(numpy.subtract(light.GetTransformedFocalPoint(),
                                     light.GetTransformedPosition()).tolist()), color))
    if not renderer.GetTwoSidedLighting():
        notes.append("both sides reflect light here, whatever TwoSidedLighting says")
    # VTK makes a head light of its own if none shines.
    if lights or not renderer.GetAutomaticLightCreation():
        return lights
    return [_head_light(camera, (1.0, 1.0, 1.0), notes)]


def _head_light(camera: Any, color: Any, notes: List[str]) -> Any:
    if not camera.GetParallelProjection():
        return HeadLight(color)
    notes.append("VTK sees its head light from where a ray enters the data, here it is seen from "
                 "each point")
    return PointLight(tuple(camera.GetPosition()), color)


def _picture(window: Any, renderer: Any) -> numpy.ndarray:
    """VTK's own picture of the volumes: float32 (height, width, 4), premultiplied, row 0 on top."""
    library = sys.modules.get("vtkmodules.vtkRenderingOpenGL2")
    if library is None or not _is_a(window, "vtkOpenGLRenderWindow"):
        raise Error("render_window: is no window of VTK's OpenGL; import "
                    "vtkmodules.vtkRenderingOpenGL2 before it is made")
    hidden = [prop for prop in _items(renderer.GetViewProps())
              if not _is_a(prop, "vtkVolume") and prop.GetVisibility()]
    colors = (renderer.GetBackground(), renderer.GetBackgroundAlpha(),
              renderer.GetGradientBackground())
    for prop in hidden:
        prop.SetVisibility(False)
    renderer.SetBackground(0, 0, 0)
    renderer.SetBackgroundAlpha(0)
    renderer.SetGradientBackground(False)
    try:
        window.Render()  # with its data and programs on the device, and its size known
        return _floats(window, renderer, library)
    finally:
        for prop in hidden:
            prop.SetVisibility(True)
        renderer.SetBackground(colors[0])
        renderer.SetBackgroundAlpha(colors[1])
        renderer.SetGradientBackground(colors[2])
        window.Render()


def _floats(window: Any, renderer: Any, library: Any) -> numpy.ndarray:
    float_type = 10  # VTK_FLOAT
    width, height = window.GetSize()
    buffer = library.vtkOpenGLFramebufferObject()
    buffer.SetContext(window)
    state = window.GetState()
    state.PushFramebufferBindings()
    try:
        if not buffer.PopulateFramebuffer(width, height, True, 1, float_type, True, 32, 0):
            raise Error("render_window: OpenGL gives no framebuffer of floats")
        buffer.Bind()
        buffer.ActivateDrawBuffer(0)
        renderer.Render()
        window.WaitForCompletion()
        buffer.ActivateReadBuffer(0)
        pixels = buffer.DownloadColor4([0, width - 1, 0, height - 1], float_type)
        picture = numpy.empty((height, width, 4), dtype=numpy.float32)
        pixels.Download2D(float_type, picture, [width, height], 4, [0, 0])
    finally:
        state.PopFramebufferBindings()
        buffer.ReleaseGraphicsResources(window)
    columns, rows = renderer.GetSize()
    left, bottom = renderer.GetOrigin()
    return numpy.ascontiguousarray(picture[bottom:bottom + rows, left:left + columns][::-1])
