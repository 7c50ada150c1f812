# SPDX-License-Identifier: Apache-2.0
"""What a scene is made of: plain objects, to be made, changed and compared.

Points and directions of the world are (x, y, z). Colors are three linear numbers or "#rrggbb" in
sRGB. Numbers are checked when the scene is rendered: what is wrong raises pellucid.Error.
"""
from __future__ import annotations

import numbers
from dataclasses import InitVar, dataclass, field
from typing import Any, ClassVar, Optional, Sequence, Union

import numpy

from . import _pellucid
from ._colormaps import color_points
from ._pellucid import (Channels, Error, Gaussians, GradientOpacity, LabelMask, LabelTable,
                        LabelVolume, Mesh, OpacityTable, TransferFunction, Volume)

Vector = Sequence[float]
"""Three numbers (x, y, z)."""
Color = Union[str, Sequence[float]]
"""Three linear numbers (red, green, blue), or "#rrggbb" in sRGB."""

_identity = ((1.0, 0.0, 0.0, 0.0), (0.0, 1.0, 0.0, 0.0), (0.0, 0.0, 1.0, 0.0))


@dataclass
class Camera:
    """Where the picture is taken from, in world units."""

    position: Vector = (0.0, 0.0, 1.0)
    focal_point: Vector = (0.0, 0.0, 0.0)
    up: Vector = (0.0, 1.0, 0.0)
    """Not parallel to the view direction."""
    vertical_angle: float = 30.0
    """Degrees, between 0 and 180; perspective."""
    parallel_scale: float = 1.0
    """Half of the picture's height in world units; orthographic."""
    projection: str = "perspective"
    """"perspective" or "orthographic"."""


@dataclass
class HeadLight:
    """A light at the eye."""

    color: Color = (1.0, 1.0, 1.0)
    _kind: ClassVar[str] = "head"


@dataclass
class DirectionalLight:
    """A light from far away, which shines along `direction`."""

    direction: Vector = (0.0, 0.0, -1.0)
    color: Color = (1.0, 1.0, 1.0)
    _kind: ClassVar[str] = "directional"


@dataclass
class PointLight:
    """A light at a position, equally bright at any distance."""

    position: Vector = (0.0, 0.0, 0.0)
    color: Color = (1.0, 1.0, 1.0)
    _kind: ClassVar[str] = "point"


Light = Union[HeadLight, DirectionalLight, PointLight]


@dataclass
class Shading:
    """How a layer and its surfaces reflect the scene's lights (Blinn), on both sides."""

    ambient: float = 0.2
    diffuse: float = 0.7
    specular: float = 0.2
    power: float = 20.0
    """From 1 to 1000."""
    gradient: str = "smooth"
    """"smooth" (central differences at the values) or "field" (of the reconstruction)."""
    flatness: Optional[float] = None
    """Light fades where the gradient is below this share of the data's range per voxel, on surfaces
    too. None: on surfaces it does not, in the medium as `flat_gradient` says."""
    channel: int = 0
    """Of several variables, the index of the one whose gradient it is."""
    flat_gradient: Optional[float] = None
    """In the medium light fades where the gradient is below this, in data units per world length.
    None: below what noise makes, found in the data (docs/reference/scene.md)."""


@dataclass
class Isosurface:
    """A surface where the data have a value."""

    value: float
    color: Color = (1.0, 1.0, 1.0)
    opacity: float = 1.0
    colors: Optional[TransferFunction] = None
    """Gives the color by a variable, in place of `color`."""
    channel: int = 0
    color_channel: int = 0


@dataclass
class Slice:
    """A plane that shows the data in colors."""

    point: Vector = (0.0, 0.0, 0.0)
    normal: Vector = (0.0, 0.0, 1.0)
    opacity: float = 1.0
    colors: Optional[TransferFunction] = None
    """The color of each value; None: those of the layer's function of one variable."""
    channel: int = 0


@dataclass
class ClipPlane:
    """The side of a plane that its normal points to is shown."""

    point: Vector = (0.0, 0.0, 0.0)
    normal: Vector = (0.0, 0.0, 1.0)
    keep: str = "inside"
    """"inside", or "outside": the other side."""
    _kind: ClassVar[str] = "plane"


@dataclass
class ClipBox:
    """A box along the world's axes."""

    lower: Vector = (0.0, 0.0, 0.0)
    upper: Vector = (1.0, 1.0, 1.0)
    keep: str = "inside"
    """"inside", or "outside": the box is cut away."""
    _kind: ClassVar[str] = "box"


@dataclass
class ClipSphere:
    """A ball, kept or cut away."""

    center: Vector = (0.0, 0.0, 0.0)
    radius: float = 1.0
    keep: str = "inside"
    _kind: ClassVar[str] = "sphere"


@dataclass
class ClipCylinder:
    """A cylinder with flat ends."""

    start: Vector = (0.0, 0.0, 0.0)
    end: Vector = (0.0, 0.0, 1.0)
    radius: float = 1.0
    keep: str = "inside"
    _kind: ClassVar[str] = "cylinder"


Clip = Union[ClipPlane, ClipBox, ClipSphere, ClipCylinder]


@dataclass
class Gaussian:
    """A Gaussian of some channels: extinction * exp(-|K (values - center)|^2).

    Exactly one of widths, covariance and matrix gives K. A width is where the extinction has
    fallen to 1/e of its peak along a channel, or along a row of `axes`.
    """

    center: Sequence[float]
    extinction: float
    """The peak, per world length."""
    color: Color = (1.0, 1.0, 1.0)
    widths: Optional[Sequence[float]] = None
    covariance: Optional[Sequence[Sequence[float]]] = None
    matrix: Optional[Sequence[Sequence[float]]] = None
    axes: Optional[Sequence[Sequence[float]]] = None
    channels: Optional[Sequence[str]] = None
    """Names; None: all channels of the function, in order."""


@dataclass
class Integration:
    """How rays are integrated, and how exactly."""

    tolerance: float = 1 / 512
    """Largest error of any channel of a pixel, in premultiplied linear light; from 1e-7 to 1."""
    grade: str = "estimated"
    """"estimated" or "proved": what the error of a pixel may rely on."""
    method: str = "exact"
    """Others are for comparison: "midpoint", "preintegrated", … They have no error."""
    precision: str = "automatic"
    """"automatic", "float32" or "float64"."""
    step: float = 0.5
    """Of methods other than exact, in voxels."""


Data = Union[Volume, Channels, Mesh, LabelVolume]
Function = Union[TransferFunction, OpacityTable, Gaussians]


@dataclass(eq=False)
class Layer:
    """One kind of data with its look and its place.

    `data` may be anything that Volume() takes. Without a transfer function one is made from the
    data; a name is that of a preset; a list for several variables holds Gaussians.

    Three arguments change the function of one variable when the layer is made: cmap, its colors
    (what from_colormap() takes); clim, (low, high), to where its first and last points move, and
    the ends of the color map, in the data's unit or in percent of the values, ("2%", "98%"); and
    opacity, a factor of its extinctions.
    """

    data: Any
    transfer_function: Union[Function, str, list, None] = None
    name: str = ""
    visible: bool = True
    transform: Sequence[Sequence[float]] = _identity
    """Three rows of an affine map, the world (x, y, z) from the world of the data."""
    clips: list[Clip] = field(default_factory=list)
    projection: Optional[str] = None
    """"maximum", "minimum", "mean" or "sum" along each ray in place of the integral."""
    shading: Union[Shading, bool, None] = None
    """True: the default Shading(); False, or None without isosurfaces given as numbers: none."""
    gradient_opacity: Optional[GradientOpacity] = None
    isosurfaces: list[Union[Isosurface, float]] = field(default_factory=list)
    """A number is an Isosurface of this value."""
    slices: list[Slice] = field(default_factory=list)
    labels: Optional[LabelTable] = None
    """The look of a LabelVolume; None: made from the labels."""
    mask: Optional[LabelMask] = None
    """Labels that choose another function for a Volume."""
    cmap: InitVar[Any] = None
    clim: InitVar[Optional[Sequence[Union[float, str]]]] = None
    opacity: InitVar[float] = 1.0

    def __post_init__(self, cmap: Any, clim: Any, opacity: float) -> None:
        self.data = _data_of(self.data)
        surfaces = _list_of(self.isosurfaces)
        if self.shading is None and any(isinstance(each, numbers.Real) for each in surfaces):
            self.shading = Shading()
        self.isosurfaces = [Isosurface(float(each)) if isinstance(each, numbers.Real) else each
                            for each in surfaces]
        if isinstance(self.shading, (bool, numpy.bool_)):
            self.shading = Shading() if self.shading else None
        changes = cmap is not None or clim is not None or opacity != 1
        if isinstance(self.data, LabelVolume):
            if changes:
                raise Error("layer: cmap, clim and opacity are for a function; labels have colors "
                            "of their own (LabelTable)")
            if self.labels is None:
                self.labels = LabelTable.default(self.data)
            return
        self.transfer_function = self._function(clim)
        if changes:
            colors = None if cmap is None else color_points(cmap)
            self.transfer_function = _pellucid.changed_function(
                self.transfer_function, self.data, colors, clim, opacity)

    def _function(self, clim: Any) -> Function:
        given, data = self.transfer_function, self.data
        if isinstance(given, str):
            if isinstance(data, Channels):
                raise Error(f"preset {given}: presets are for one variable, but there are channels")
            # Numbers say where a preset lies, whatever the units of the data.
            if clim is not None and not any(isinstance(each, str) for each in clim):
                return _pellucid.make_preset(given, data, tuple(clim))
            return _pellucid.make_preset(given, data)
        if isinstance(given, (list, tuple)):
            names = data.names if isinstance(data, Channels) else getattr(data, "channels", None)
            if names is None or any(isinstance(entry, (list, tuple)) for entry in given):
                return TransferFunction(given)
            return Gaussians(given, channels=names)
        if given is not None:
            return given
        several = isinstance(data, Channels) or (isinstance(data, Mesh) and len(data.channels) > 1)
        if self.isosurfaces or self.slices:
            transparent = TransferFunction([(0, 0, (0, 0, 0))])
            if several:
                names = data.names if isinstance(data, Channels) else data.channels
                return Gaussians([], channels=names, tables={names[0]: transparent})
            if any(getattr(each, "colors", None) is None for each in self.slices):
                return _pellucid.grey_colors(data)
            return transparent
        if several:
            raise Error("layer: several variables need a transfer function; "
                        "pellucid.suggest() makes a first one")
        if self.projection is not None:
            return _pellucid.projection_transfer_function(data, self.projection)
        return _pellucid.default_transfer_function(data)


def _list_of(given: Any) -> list:
    """Returns a list of isosurfaces, of which one may be given alone."""
    return [given] if isinstance(given, (Isosurface, numbers.Real)) else list(given)


def _data_of(data: Any) -> Data:
    """Returns data that a layer can have, made from an array or an object of another library."""
    if isinstance(data, (Volume, Channels, Mesh, LabelVolume)):
        return data
    from . import _meshes

    if _meshes.is_mesh(data):
        return _meshes.mesh_of(data)
    return Volume(data)


@dataclass(eq=False)
class Scene:
    """What is seen, by which camera, and how exactly.

    Where layers overlap, their extinctions add; the order of layers does not matter, except among
    projected ones. A layer may be given as its data.
    """

    layers: list[Layer] = field(default_factory=list)
    camera: Optional[Camera] = None
    """None: one that shows what is visible, as the command line chooses it."""
    size: tuple[int, int] = (512, 512)
    """Width and height in pixels."""
    lights: list[Light] = field(default_factory=lambda: [HeadLight()])
    clips: list[Clip] = field(default_factory=list)
    background: Any = None
    """Behind a .png: a color, two from above downwards, or "transparent". None: a dark gradient.
    The pixels and an .exr stay transparent."""
    samples: int = 1
    """A pixel is the mean of samples * samples rays."""
    integration: Integration = field(default_factory=Integration)
    backdrop: Any = None
    """An Image with depth, as large as `size`: rays end at it. Or None."""
    animation: Optional[dict] = None
    """What changes in a film, as the key "animation" of a scene file says
    (docs/reference/scene.md); for frames() and animate()."""

    def __post_init__(self) -> None:
        if not isinstance(self.layers, (list, tuple)):
            self.layers = [self.layers]
        self.layers = [each if isinstance(each, Layer) else Layer(each) for each in self.layers]

    def save(self, path: Any) -> None:
        """Writes the scene as JSON, which load_scene() and `pellucid render` read.

        Data must come from files or be built in: raises Error for arrays.
        """
        _pellucid.save_scene(self, path)
