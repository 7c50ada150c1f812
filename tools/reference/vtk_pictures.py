#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures how far VTK's pictures are from ours with the same transfer function files.

This is the table in docs/reference/formats.md.

usage: xvfb-run -a python3 vtk_pictures.py PROGRAM FOLDER

PROGRAM is pellucid, FOLDER is tests/io/transfer_functions. Draws a field of 48³ floats with
vtkOpenGLGPUVolumeRayCastMapper of VTK (Debian: python3-vtk9) at smaller and smaller steps, and once
with pellucid to 1e-4 with --colors linear, and prints the largest and the root mean square
difference of the channels over black, both from 8 bits: ours of sRGB, VTK's of numbers as they are.
"""

import importlib.util
import json
import math
import pathlib
import struct
import subprocess
import sys
import tempfile

from vtkmodules.vtkCommonCore import vtkFloatArray
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkIOImage import vtkPNGReader
from vtkmodules.vtkRenderingCore import (vtkRenderer, vtkRenderWindow, vtkVolume, vtkVolumeProperty,
                                         vtkWindowToImageFilter)
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401: registers the window
from vtkmodules.vtkRenderingVolumeOpenGL2 import vtkOpenGLGPUVolumeRayCastMapper

N, SIZE, UNIT = 48, 128, 6
WINDOWS = []  # a display without windows may end
MIDDLE = [(N - 1) / 2] * 3
CAMERA = {"projection": "orthographic", "position": [MIDDLE[0] + 90, MIDDLE[1] - 120,
                                                     MIDDLE[2] + 60],
          "focal_point": MIDDLE, "up": [0, 0, 1], "parallel_scale": 40}


def field():
    place = [(i - MIDDLE[0]) / 24 for i in range(N)]
    return [0.5 + 0.5 * math.sin(3 * x) * math.cos(4 * y) * math.sin(2 * z + 1)
            for z in place for y in place for x in place]


def write_npy(path, values):
    header = f"{{'descr': '<f4', 'fortran_order': False, 'shape': ({N}, {N}, {N}), }}"
    header += " " * (-(len(header) + 11) % 64) + "\n"
    path.write_bytes(b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header.encode()
                     + struct.pack(f"<{len(values)}f", *values))


def numbers(image):
    """The first three components of all pixels, bottom row first."""
    scalars = image.GetPointData().GetScalars()
    return [scalars.GetComponent(i, c) / 255 for i in range(scalars.GetNumberOfTuples())
            for c in range(3)]


def by_vtk(image, functions, step):
    look = vtkVolumeProperty()
    look.SetColor(functions[0])
    look.SetScalarOpacity(functions[1])
    look.SetInterpolationTypeToLinear()
    look.ShadeOff()
    look.SetScalarOpacityUnitDistance(UNIT)
    mapper = vtkOpenGLGPUVolumeRayCastMapper()
    mapper.SetInputData(image)
    mapper.AutoAdjustSampleDistancesOff()
    mapper.SetSampleDistance(step)
    mapper.UseJitteringOff()
    volume = vtkVolume()
    volume.SetMapper(mapper)
    volume.SetProperty(look)
    renderer = vtkRenderer()
    renderer.AddVolume(volume)
    window = vtkRenderWindow()
    WINDOWS.append(window)
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(0)
    window.SetSize(SIZE, SIZE)
    window.AddRenderer(renderer)
    camera = renderer.GetActiveCamera()
    camera.ParallelProjectionOn()
    camera.SetPosition(CAMERA["position"])
    camera.SetFocalPoint(CAMERA["focal_point"])
    camera.SetViewUp(CAMERA["up"])
    camera.SetParallelScale(CAMERA["parallel_scale"])
    renderer.ResetCameraClippingRange()
    window.Render()
    grab = vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.ReadFrontBufferOff()
    grab.Update()
    return numbers(grab.GetOutput())


def by_pellucid(program, folder, name, scratch):
    picture = scratch / "ours.png"
    subprocess.run([program, "render", scratch / "field.npy", "--tf", folder / f"{name}.json",
                    "--colors", "linear", "--unit-distance", str(UNIT),
                    "--camera", scratch / "camera.json", "--size", str(SIZE),
                    "--background", "black", "--tolerance", "1e-4", "-q", "-o", picture],
                   check=True)
    reader = vtkPNGReader()
    reader.SetFileName(str(picture))
    reader.Update()
    return [s / 12.92 if s <= 0.04045 else ((s + 0.055) / 1.055) ** 2.4
            for s in numbers(reader.GetOutput())]


def main():
    program, folder = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2])
    place = pathlib.Path(__file__).with_name("vtk_transfer_functions.py")
    spec = importlib.util.spec_from_file_location("cases", place)
    cases = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(cases)
    values = field()
    image, array = vtkImageData(), vtkFloatArray()
    image.SetDimensions(N, N, N)
    array.SetNumberOfValues(len(values))
    for i, value in enumerate(values):
        array.SetValue(i, value)
    image.GetPointData().SetScalars(array)
    with tempfile.TemporaryDirectory() as scratch:
        scratch = pathlib.Path(scratch)
        write_npy(scratch / "field.npy", values)
        (scratch / "camera.json").write_text(json.dumps(CAMERA))
        for name in ("diverging_three", "lab_dark", "hsv_wrapped", "slicer_hermite"):
            ours = by_pellucid(program, folder, name, scratch)
            cells = []
            for step in (1, 0.1, 0.02):
                theirs = by_vtk(image, cases.functions(cases.CASES[name])[:2], step)
                off = [abs(a - b) for a, b in zip(ours, theirs)]
                rms = math.sqrt(sum(x * x for x in off) / len(off))
                cells.append(f"{max(off):.4f}, {rms:.4f}")
            print(f"| `{name}` | " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    main()
