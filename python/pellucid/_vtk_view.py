# SPDX-License-Identifier: Apache-2.0
"""Cameras and lights of VTK's renderers as those of a Scene."""
from __future__ import annotations

import math
from typing import Any, List, Tuple

import numpy

from ._pellucid import Error
from .scene import Camera, ClipPlane, DirectionalLight, HeadLight, PointLight


def is_a(data: Any, name: str) -> bool:
    return callable(getattr(data, "IsA", None)) and bool(data.IsA(name))


def items(collection: Any) -> List[Any]:
    return [collection.GetItemAsObject(i) for i in range(collection.GetNumberOfItems())]


def matrix_of(matrix: Any) -> numpy.ndarray:
    return numpy.array([[matrix.GetElement(row, column) for column in range(4)]
                        for row in range(4)])


def _refuse_others(renderer: Any) -> None:
    """Raises Error for what of a view has no counterpart, as the plug-in does."""
    camera, window = renderer.GetActiveCamera(), renderer.GetRenderWindow()
    if camera.GetUseOffAxisProjection():
        raise Error("camera: its projection is off-axis by a screen; set UseOffAxisProjectionOff()")
    if camera.GetUserViewTransform() is not None or camera.GetUserTransform() is not None:
        raise Error("camera: has a transform of the view; move the camera instead")
    model = camera.GetModelTransformMatrix()
    if model is not None and not numpy.array_equal(matrix_of(model), numpy.eye(4)):
        raise Error("camera: has a transform of the model; move the volumes instead")
    if window is not None and window.GetStereoRender():
        raise Error("window: shows two eyes; call StereoRenderOff()")
    if window is not None and tuple(window.GetTileScale()) != (1, 1):
        raise Error("window: is a tile of a larger picture; call SetTileScale(1, 1)")
    if renderer.GetUseDepthPeeling() and renderer.GetUseDepthPeelingForVolumes():
        raise Error("renderer: peels volumes; call UseDepthPeelingForVolumesOff()")
    across, up = renderer.GetPixelAspect()
    if across != up:
        raise Error("renderer: its pixels are not square; set PixelAspect 1 1")


def view_of(renderer: Any, bounds: Any) -> Tuple[Camera, List[ClipPlane]]:
    """Returns the camera of a renderer, and those of its clipping planes that cut a box off.

    bounds are the box's (xmin, xmax, ymin, ...) in the world.
    """
    _refuse_others(renderer)
    camera = renderer.GetActiveCamera()
    width, height = renderer.GetSize()
    aspect = width / height
    for name, default in (("GetWindowCenter", (0.0, 0.0)), ("GetViewShear", (0.0, 0.0, 1.0))):
        if tuple(getattr(camera, name)()) != default:
            raise Error(f"camera: its {name[3:]} is {getattr(camera, name)()}; set {default}")
    matrix = matrix_of(camera.GetProjectionTransformMatrix(aspect, -1, 1))
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
    slope, constant = matrix[2, 2:]

    def distance(z: float) -> float:
        if is_parallel:
            return (constant - z) / slope
        return math.inf if slope + z == 0 else constant / (slope + z)

    clips = _depth_clips(camera, distance(-1), distance(1), bounds)
    half = 1 / matrix[1, 1]
    where = tuple(camera.GetPosition()), tuple(camera.GetFocalPoint()), tuple(camera.GetViewUp())
    if is_parallel:
        return Camera(*where, parallel_scale=half, projection="orthographic"), clips
    return Camera(*where, vertical_angle=math.degrees(2 * math.atan(half))), clips


def _depth_clips(camera: Any, near: float, far: float, bounds: Any) -> List[ClipPlane]:
    if not near < far:
        raise Error("camera: its projection shows nothing from near to far; take a frustum")
    position, forward = numpy.array(camera.GetPosition()), camera.GetDirectionOfProjection()
    corners = numpy.array([[bounds[2 * axis + side] for axis, side in enumerate(corner)]
                           for corner in numpy.ndindex(2, 2, 2)])
    depths = (corners - position) @ numpy.array(forward)
    clips = []
    for plane, sign, cuts in ((near, 1.0, depths.min() < near), (far, -1.0, depths.max() > far)):
        if cuts:
            clips.append(ClipPlane(tuple((position + plane * numpy.array(forward)).tolist()),
                                   tuple(sign * part for part in forward)))
    return clips


def has_ambient_light(renderer: Any) -> bool:
    """Whether a property's ambient part is seen: VTK gives its color to it under one head light of
    intensity 1; under other lights it has their own ambient colors, black unless they are set."""
    lights = [light for light in items(renderer.GetLights()) if light.GetSwitch()]
    return not lights or (len(lights) == 1 and bool(lights[0].LightTypeIsHeadlight())
                          and lights[0].GetIntensity() == 1)


def power_factor() -> float:
    """From VTK's specular power to that of Shading: since 9.2 VTK has (r·v)^power, next to which
    |n·h|^(4 power) has highlights of the same width."""
    from vtkmodules.vtkCommonCore import vtkVersion
    version = vtkVersion.GetVTKMajorVersion(), vtkVersion.GetVTKMinorVersion()
    return 4.0 if version >= (9, 2) else 1.0


def lights_of(renderer: Any, is_lit: bool, notes: List[str]) -> List[Any]:
    """Lights as the GPU mapper has them. A head light alone is at the camera, also of parallel
    rays; beside others it shines along the camera's axis."""
    camera = renderer.GetActiveCamera()
    shining = [light for light in items(renderer.GetLights()) if light.GetSwitch()]
    lights: List[Any] = []
    for light in shining:
        color = tuple(light.GetIntensity() * c for c in light.GetDiffuseColor())
        if any(light.GetAmbientColor()) and not has_ambient_light(renderer):
            notes.append("the ambient color of lights is left out")
        if light.LightTypeIsHeadlight():
            if len(shining) > 1:
                lights.append(DirectionalLight(tuple(camera.GetDirectionOfProjection()), color))
            else:
                lights.append(_head_light(camera, color, is_lit, notes))
        elif light.GetPositional():
            if tuple(light.GetAttenuationValues()) != (1.0, 0.0, 0.0) or light.GetConeAngle() < 90:
                notes.append("a light has a cone or an attenuation, which is left out")
            lights.append(PointLight(tuple(light.GetTransformedPosition()), color))
        else:
            lights.append(DirectionalLight(
                tuple(numpy.subtract(light.GetTransformedFocalPoint(),
                                     light.GetTransformedPosition()).tolist()), color))
    if is_lit and not renderer.GetTwoSidedLighting():
        notes.append("both sides reflect light here, whatever TwoSidedLighting says")
    # VTK makes a head light of its own if none shines.
    if lights or not renderer.GetAutomaticLightCreation():
        return lights
    return [_head_light(camera, (1.0, 1.0, 1.0), is_lit, notes)]


def _head_light(camera: Any, color: Any, is_lit: bool, notes: List[str]) -> Any:
    if not camera.GetParallelProjection():
        return HeadLight(color)
    if is_lit:
        notes.append("VTK sees its head light from where a ray enters the data, here it is seen "
                     "from each point")
    return PointLight(tuple(camera.GetPosition()), color)
