# SPDX-License-Identifier: Apache-2.0
"""VTK's own pictures in floats."""
from __future__ import annotations

import sys
from typing import Any

import numpy

from ._pellucid import Error
from ._vtk_layers import is_a, items


def picture_of(window: Any, renderer: Any) -> numpy.ndarray:
    """VTK's own picture of the volumes: float32 (height, width, 4), premultiplied, row 0 on top."""
    library = sys.modules.get("vtkmodules.vtkRenderingOpenGL2")
    if library is None or not is_a(window, "vtkOpenGLRenderWindow"):
        raise Error("render_window: is no window of VTK's OpenGL; import "
                    "vtkmodules.vtkRenderingOpenGL2 before it is made")
    hidden = [prop for prop in items(renderer.GetViewProps())
              if not is_a(prop, "vtkVolume") and prop.GetVisibility()]
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
