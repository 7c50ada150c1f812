# SPDX-License-Identifier: Apache-2.0
"""Volume rendering to a tolerance instead of a step size.

    import pellucid
    image = pellucid.render(array)          # array: numpy, axes (z, y, x)
    image.save("picture.png")

Each channel of each pixel is within the tolerance of the exact volume rendering integral, or the
image says which pixel may not be (image.error, image.report).

Axes. Arrays have the axes (z, y, x), as numpy, ITK and napari have them; spacing, origin,
direction and coordinates of an array are in the same order. Points and directions of the world
(cameras, lights, clips, points of meshes) are (x, y, z).

Errors are pellucid.Error, a ValueError whose one line says what is wrong, where, and what to do.
What a reader assumed or left out is a warning of the category pellucid.Note.
"""
from ._notes import ImportedTransferFunction, Note, Preset
from ._pellucid import (Cancelled, Channels, Error, Figure, Frame, Gaussians, GradientOpacity,
                        Image, LabelMask, LabelTable, LabelVolume, Mesh, OpacityTable, Renderer,
                        TransferFunction, Volume, __version__, builtin_field, color_map,
                        color_map_names, default_camera,
                        default_transfer_function, dicom_series,
                        export_transfer_function, histogram, import_transfer_function,
                        label_count, linear_to_srgb, load_scene, looks,
                        make_preset, presets, projection_transfer_function, read,
                        read_image, read_mesh, read_volume, render_reference, srgb_to_linear,
                        suggest, suggest_boundaries, times, view_camera)
from ._colormaps import from_colormap
from ._films import animate, frames
from ._image import ColorBar, Comparison
from ._meshes import mesh_of
from ._ranks import render_on_ranks
from ._render import look, render, scene_of
from .scene import (Camera, Clip, ClipBox, ClipCylinder, ClipPlane, ClipSphere, DirectionalLight,
                    Gaussian, HeadLight, Integration, Isosurface, Layer, Light, PointLight, Scene,
                    Shading, Slice)
from ._view import Viewer, export, view
from .segments import integrate

__all__ = [
    "Camera", "Cancelled", "Channels", "Clip", "ClipBox", "ClipCylinder", "ClipPlane", "ClipSphere",
    "ColorBar", "Comparison", "DirectionalLight", "Error", "Figure", "Frame", "Gaussian",
    "Gaussians", "GradientOpacity", "HeadLight", "Image", "ImportedTransferFunction",
    "Integration", "Isosurface", "LabelMask", "LabelTable", "LabelVolume", "Layer", "Light", "Mesh",
    "Note", "OpacityTable", "PointLight", "Preset", "Renderer", "Scene", "Shading", "Slice",
    "TransferFunction", "Viewer", "Volume", "__version__", "animate",
    "builtin_field", "color_map", "color_map_names", "default_camera",
    "default_transfer_function", "dicom_series", "export",
    "export_transfer_function", "frames", "from_colormap", "histogram", "import_transfer_function",
    "integrate", "label_count", "linear_to_srgb", "load_scene", "look", "looks",
    "make_preset", "mesh_of", "presets",
    "projection_transfer_function", "read", "read_image", "read_mesh", "read_volume", "render",
    "render_on_ranks", "render_reference", "scene_of", "srgb_to_linear", "suggest",
    "suggest_boundaries", "times", "view", "view_camera",
]
