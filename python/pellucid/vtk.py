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

from dataclasses import dataclass, field
from typing import Any, List, Sequence, Tuple

import numpy

from ._pellucid import Error, Image, Renderer
from ._pellucid import (  # type: ignore[attr-defined]
    _vtk_final_colors, _vtk_function_share, _vtk_has_ambient_light, _vtk_lights, _vtk_view)
from ._vtk_layers import is_a, items, layers_of, parts_of
from ._vtk_picture import picture_of
from .scene import Integration, Layer, Scene

# What pictures are held against, and what functions are fitted for where nobody says.
_DEFAULT_TOLERANCE = 1 / 4096


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
    if not (is_a(mapper, "vtkAbstractVolumeMapper")
            and _plugin().vtkPellucidFactory.Has(mapper)):
        if is_a(mapper, "vtkSmartVolumeMapper") and mapper.GetRequestedRenderMode() not in (0, 2):
            raise Error(f"mapper: {mapper!r:.60} draws by another mapper in its render mode; call "
                        "SetRequestedRenderModeToDefault()")
        raise Error(f"mapper: {mapper!r:.60} does not draw by Pellucid; make it after "
                    "pellucid.vtk.use()")
    return MapperSettings(mapper)


def scene_of(renderer: Any, notes: Any = None, tolerance: float = _DEFAULT_TOLERANCE) -> Scene:
    """Returns the Scene that a vtkRenderer shows: volumes, properties, camera, lights, clipping.

    renderer   a vtkRenderer, or a plotter of PyVista
    notes      a list that receives lines on what is left out; else these are warnings
    tolerance  of pictures of the scene: functions are fitted for it, and what they are off is
               counted in a picture's error. Finer fits of curved functions take longer to render

    It is the scene that the plug-in for VTK renders, with all volumes in one: the array that the
    mapper shows, opacities per unit distance (of unstructured grids extinctions), masks, blend
    modes. Clipping and cropping planes become clips, and so do those of the camera where they cut
    volumes. Independent components are layers, dependent ones Channels with a factor, and the
    nearest values of an unlit volume a LabelVolume. The parts of a vtkMultiVolume are layers. Other
    props are left out. Raises Error for what has no counterpart: sums of additive blending, a
    camera whose window is not in the middle.

    The window and level of the final color are those of a picture: finished() applies them.
    """
    renderer = getattr(renderer, "renderer", renderer)
    if not is_a(renderer, "vtkRenderer"):
        raise Error(f"renderer: expected a vtkRenderer, got {renderer!r:.60}")
    told: List[str] = []
    volumes = items(renderer.GetVolumes())
    if not volumes:
        raise Error("renderer: has no vtkVolume; add one before its scene is asked for")
    ambient = _vtk_has_ambient_light(renderer)
    parts = [(volume, parts_of(volume, f"volume {i + 1}")) for i, volume in enumerate(volumes)]
    share = tolerance * _vtk_function_share(sum(len(each) for _, each in parts))
    layers: List[Layer] = []
    for volume, list_of_volume in parts:
        for part in list_of_volume:
            made = layers_of(part, share, ambient, told)
            for layer in made:
                layer.visible = bool(volume.GetVisibility() and part.volume.GetVisibility())
            layers += made
        if len(list_of_volume) > 1:
            told.append("volumes of a vtkMultiVolume mix here as particles do")
    if not layers:
        raise Error("renderer: its volumes show nothing: all of their cells are hidden or ghosts, "
                    "or all components have the weight 0")
    if len(volumes) > 1:
        told.append("VTK draws volumes one over the other; here overlapping ones mix")
    others = sum(1 for prop in items(renderer.GetViewProps())
                 if not is_a(prop, "vtkVolume") and prop.GetVisibility())
    if others:
        told.append(f"{others} props that are no volumes are left out")
    scene = Scene(layers, size=tuple(renderer.GetSize()))
    scene.camera, scene.clips = _view_of(renderer, volumes, told)
    is_lit = any(layer.shading is not None for layer in layers)
    scene.lights = _vtk_lights(renderer, is_lit, told)
    if notes is None:
        _warn(told)
    else:
        notes.extend(told)
    return scene


def _view_of(renderer: Any, volumes: List[Any], told: List[str]) -> Any:
    """The camera, and those of its clipping planes that cut volumes off."""
    window = renderer.GetRenderWindow()
    if window is not None and tuple(window.GetTileScale()) != (1, 1):
        raise Error("window: is a tile of a larger picture; call SetTileScale(1, 1)")
    boxes = numpy.array([box for box in (volume.GetBounds() for volume in volumes) if box])
    bounds = [boxes[:, side].max() if side % 2 else boxes[:, side].min()
              for side in range(6)] if len(boxes) else None
    camera, clips, is_cut = _vtk_view(renderer, bounds, told)
    if is_cut:
        raise Error("camera: its center is not that of the window (WindowCenter); set it to 0 0")
    return camera, clips


def finished(renderer: Any, image: Image) -> Image:
    """Returns a picture of scene_of() with the window and level of the final color.

    They are those of the mapper of the renderer's first volume: colors from level - window / 2 to
    level + window / 2 become 0 to 1. Without them it is the image itself.
    """
    renderer = getattr(renderer, "renderer", renderer)
    for volume in items(renderer.GetVolumes()):
        mapper = volume.GetMapper()
        if not hasattr(mapper, "GetFinalColorWindow"):
            break
        scale, bias = _vtk_final_colors(mapper.GetFinalColorWindow(), mapper.GetFinalColorLevel())
        if (scale, bias) == (1, 0):
            break
        rgba = numpy.array(image.rgba, dtype=numpy.float32)
        rgba[..., :3] = scale * rgba[..., :3] + bias * rgba[..., 3:]
        return Image(rgba)
    return image


def audit(render_window: Any, tolerance: float = _DEFAULT_TOLERANCE, progress: Any = None) -> Audit:
    """Renders what a vtkRenderWindow shows to a tolerance, and compares VTK's own picture with it.

    render_window  a vtkRenderWindow whose first renderer with volumes is taken, or a plotter of
                   PyVista
    tolerance      of the picture that VTK's is held against

    VTK draws into a buffer of floats, without other props and without its background; the window is
    left as it was. Raises Error as scene_of() does.
    """
    window = getattr(render_window, "render_window", getattr(render_window, "ren_win",
                                                             render_window))
    if not is_a(window, "vtkRenderWindow"):
        raise Error(f"render_window: expected a vtkRenderWindow, got {window!r:.60}")
    renderers = [each for each in items(window.GetRenderers())
                 if each.GetVolumes().GetNumberOfItems() > 0]
    if not renderers:
        raise Error("render_window: none of its renderers has a volume")
    renderer = renderers[0]
    notes: List[str] = []
    theirs = Image(picture_of(window, renderer))
    scene = scene_of(renderer, notes, tolerance)
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


def _warn(lines: Sequence[str]) -> None:
    import warnings

    from ._notes import Note

    for line in lines:
        warnings.warn(line, Note, stacklevel=3)
