# SPDX-License-Identifier: Apache-2.0
"""One call from data to a picture."""
from __future__ import annotations

import dataclasses
import os
import warnings
from typing import Any, Callable, Iterable, Optional, Union

from . import _pellucid
from ._colormaps import color_points
from ._notes import Note
from ._pellucid import Channels, Error, Image, LabelVolume, Mesh, Renderer, Volume
from .scene import Camera, Color, Layer, Scene, Shading, _data_of

_PLACE_NAMES = ("spacing", "origin", "direction", "coordinates", "centering")
_CHANGES = {"cmap", "clim", "opacity"}
_LAYER_NAMES = (({f.name for f in dataclasses.fields(Layer)} | _CHANGES)
                - {"data", "transfer_function"})


# Keywords of scene_of() and, with others, of those that call it.
_SCENE_NAMES = (_LAYER_NAMES | set(_PLACE_NAMES)
                | {"preset", "tolerance", "size", "camera", "view", "background", "look"})


def check_keywords(function: str, given: Iterable[str]) -> None:
    """Raises TypeError, as Python does, for a keyword that scene_of() does not know."""
    for name in given:
        if name not in _SCENE_NAMES:
            raise TypeError(f"{function}() got an unexpected keyword argument '{name}'")


def look(data: Any, name: Optional[str] = None) -> Layer:
    """Returns a Layer of a volume or a mesh with the look of its kind of data, to show or to edit.

    data   what Volume() takes, a Volume or a Mesh of one variable, or a path
    name   one of looks(), or None: the look of what the data seem to be, as render() shows data
           alone: "ct", "mr", "scan", "microscopy", "labels", "mask", "simulation", "fog", "haze"
           or, of a mesh, "body"

    A Scene has one light at the eye unless it is given others; render(data) of data alone adds one
    from the upper left.

    Raises Error if there is no such look of such data.
    """
    if isinstance(data, (str, os.PathLike)):
        data = _pellucid.read(data)
    data = _data_of(data)
    if not isinstance(data, (Volume, Mesh)):
        raise Error(f"look: expected a volume or a mesh of one variable, got {type(data).__name__}")
    return _look_of(data, name or "")[0]


def _look_of(data: Union[Volume, Mesh], name: str, cmap: Any = None, clim: Any = None,
             opacity: float = 1.0) -> tuple[Layer, bool]:
    """The layer, and whether it is in light."""
    colors = None if cmap is None else color_points(cmap)
    found = _pellucid.choose_look(data, name, colors, clim, opacity)
    if found["as_labels"]:
        return Layer(LabelVolume(data)), False
    return Layer(data, found["transfer_function"], shading=found["shading"],
                 isosurfaces=found["isosurfaces"]), found["shading"] is not None


def _layer_of(data: Any, transfer_function: Any, name: Optional[str],
              attributes: dict[str, Any]) -> tuple[Layer, bool]:
    """The layer of data alone, which has a look if nothing says how it is shown; whether so in
    light."""
    shown = {"projection", "isosurfaces", "slices", "mask", "gradient_opacity"} & set(attributes)
    if name is not None and (shown or transfer_function is not None):
        other = ", ".join(sorted(shown)) or "a transfer function or a preset"
        raise Error(f"look {name}: {other} says what is shown; leave one of the two out")
    if transfer_function is None and not shown:
        data = _data_of(data)
        if isinstance(data, Volume) or (isinstance(data, Mesh) and len(data.channels) == 1):
            changes = {key: attributes.pop(key) for key in _CHANGES & set(attributes)}
            layer, lit = _look_of(data, name or "", **changes)
            return dataclasses.replace(layer, **attributes), lit
        if name is not None:
            raise Error(f"look {name}: looks are of a volume or a mesh of one variable, not of "
                        f"{type(data).__name__}")
    return Layer(data, transfer_function, **attributes), False


def _share_of(tolerance: Any) -> Optional[float]:
    """0.01 of "1%", None of a number."""
    if not isinstance(tolerance, str):
        return None
    number = tolerance.strip()
    try:
        if not number.endswith("%"):
            raise ValueError
        return float(number[:-1]) / 100
    except ValueError:
        raise Error(f"tolerance: expected a number or a text as \"1%\", got {tolerance!r:.60}"
                    ) from None


def scene_of(data: Any, transfer_function: Any = None, *, preset: Optional[str] = None,
             tolerance: Optional[float] = None, size: Any = None, camera: Optional[Camera] = None,
             view: Optional[str] = None, background: Any = None,
             look: Optional[str] = None, **layer: Any) -> Scene:
    """Returns the scene that render() renders; it takes the same arguments."""
    check_keywords("scene_of", layer)
    if isinstance(data, (str, os.PathLike)):
        path, data = os.fspath(data), _pellucid.read(data)
        if isinstance(data, Layer) and (look or preset or transfer_function is not None):
            raise Error(f"{path}: holds colors, which are shown as they are; read_volume(path, "
                        "component=0) gives one component, to which looks, presets and transfer "
                        "functions apply")
    place = {name: layer.pop(name) for name in _PLACE_NAMES if name in layer}
    if place:
        if isinstance(data, (Scene, Layer, Volume, Channels, Mesh, LabelVolume)):
            raise Error(f"render: {', '.join(place)} are for arrays; the {type(data).__name__} has "
                        "its place")
        data = Volume(data, **place)
    if preset is not None:
        if transfer_function is not None:
            raise Error(f"preset {preset}: a transfer function is given too; drop one of the two")
        transfer_function = preset
    if isinstance(data, (Scene, Layer)) and (layer or look or transfer_function is not None):
        raise Error("render: the scene has its layers; set transfer functions, presets and "
                    f"{', '.join(layer) or 'looks'} there")
    in_look_light = False
    if isinstance(data, Scene):
        scene = dataclasses.replace(data)
    else:
        if not isinstance(data, Layer):
            data, in_look_light = _layer_of(data, transfer_function, look, layer)
            lit = {each.name for each in _pellucid.presets() if each.lit}
            if preset in lit and data.projection is None and data.shading is None:
                data.shading = Shading()
        scene = Scene([data])
    if tolerance is not None:
        scene.integration = dataclasses.replace(scene.integration, tolerance=tolerance)
    if size is not None:
        scene.size = (size, size) if hasattr(size, "__index__") else size
    if background is not None:
        scene.background = background
    if camera is not None:
        scene.camera = camera
    if view is not None:
        if camera is not None:
            raise Error(f"view {view}: a camera is given too; drop one of the two")
        scene.camera = _pellucid.view_camera(scene, view)
    if in_look_light:
        scene.lights = _pellucid.look_lights(scene.camera)
    return scene


def render(data: Any, transfer_function: Any = None, *, preset: Optional[str] = None,
           tolerance: Union[float, str, None] = None, size: Any = None,
           camera: Optional[Camera] = None, view: Optional[str] = None,
           background: Any = None, look: Optional[str] = None, depth: bool = False,
           error: bool = True, values: bool = False, threads: int = 0,
           progress: Optional[Callable[[float], Any]] = None,
           renderer: Optional[Renderer] = None, **layer: Any) -> Image:
    """Renders data to a tolerance and returns the Image.

    data               a Scene, a Layer, a Volume, Channels, a Mesh, a LabelVolume; what Volume()
                       takes (an array, an image of nibabel, ITK, xarray, VTK); a VTK or meshio
                       mesh; or the path of a file that read() reads
    transfer_function  a TransferFunction, an OpacityTable, Gaussians or a list of points; without
                       one the data have the look of their kind; shading=None leaves light out
    preset             the name of one of presets(), in its place
    look               the name of one of looks(), in its place: the kind of data to show
    tolerance          largest error of any channel of a pixel, in premultiplied linear light; from
                       1e-7 to 1, default 1/512. A text "1%": that share of the largest channel
    size               (width, height) or one number, in pixels; default 512
    camera, view       a Camera; or "front", "back", "left", "right", "top", "bottom", "oblique".
                       Default: one that shows all that is visible
    background         behind a .png: a color, "white", "black", two colors from above downwards,
                       or "transparent"; default: a dark gradient. Pixels stay transparent
    depth, values      also fill Image.depth, Image.values (of a projection)
    threads            0: one per core
    progress           called with the finished fraction every 20 ms; what it raises cancels the
                       picture and is raised here, and so is Ctrl-C
    renderer           a Renderer, which keeps what frames share
    **layer            further attributes of the Layer: cmap="viridis" (colors), clim=(low, high)
                       (range of colors and opacity), opacity=2.0 (a factor), shading=True,
                       isosurfaces=[60], slices, clips, projection, gradient_opacity, transform,
                       mask, labels, name; and of an array spacing, origin, direction, coordinates
                       and centering, as Volume()

    Raises Error: one line that says what is wrong, where, and what to do.
    """
    check_keywords("render", layer)
    share = _share_of(tolerance)
    scene = scene_of(data, transfer_function, preset=preset,
                     tolerance=None if share is not None else tolerance, size=size, camera=camera,
                     view=view, background=background, look=look, **layer)
    renderer = renderer or Renderer()
    if share is not None:  # of a picture that may be faint
        return renderer.render_to_share(scene, share, depth=depth, error=error, values=values,
                                        threads=threads, progress=progress)
    image = renderer.render(scene, depth=depth, error=error, values=values, threads=threads,
                            progress=progress)
    for advice in _pellucid.surface_advice(scene):
        warnings.warn(advice, Note, stacklevel=2)
    advice = _pellucid.picture_advice(scene, image)
    if advice is not None:
        warnings.warn(advice, Note, stacklevel=2)
    return image
