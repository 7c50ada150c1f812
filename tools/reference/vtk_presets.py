#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures how far VTK's pictures are from ours with a volume property of 3D Slicer.

This is the table in docs/reference/formats.md.

usage: xvfb-run -a python3 vtk_presets.py VOLUME PROPERTY.vp.json [FOLDER]

Reads the property twice: by VTK's own classes, and by pellucid's importer. Draws the volume with
vtkOpenGLGPUVolumeRayCastMapper at smaller and smaller steps into a buffer of floats, and once with
pellucid to 1e-4, with an orthographic camera and VTK's head light. Prints the largest and the root
mean square difference of the channels, and writes both pictures and their difference into FOLDER.
VTK's normals have length 1 wherever the gradient is not 0, so flatness is 0. `python3` must find
the package pellucid and VTK (Debian: python3-vtk9).
"""

import json
import pathlib
import sys

import numpy
import pellucid
import pellucid.vtk
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonDataModel import vtkImageData, vtkPiecewiseFunction
from vtkmodules.vtkRenderingCore import (vtkColorTransferFunction, vtkRenderer, vtkRenderWindow,
                                         vtkVolume, vtkVolumeProperty)
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401: registers the window
from vtkmodules.vtkRenderingVolumeOpenGL2 import vtkOpenGLGPUVolumeRayCastMapper

SIZE = 256
STEPS = (1, 0.25, 0.1, 0.02)  # voxels


def curve(nodes):
    function = vtkPiecewiseFunction()
    for node in nodes["points"]:
        function.AddPoint(node["x"], node["y"], node.get("midpoint", 0.5), node.get("sharpness", 0))
    return function


def property_of(path):
    """A vtkVolumeProperty with what the first component of the file says."""
    component = json.loads(path.read_text())["volumeProperties"][0]["components"][0]
    colors = vtkColorTransferFunction()
    for node in component["rgbTransferFunction"]["points"]:
        colors.AddRGBPoint(node["x"], *node["color"], node.get("midpoint", 0.5),
                           node.get("sharpness", 0))
    look = vtkVolumeProperty()
    look.SetColor(colors)
    look.SetScalarOpacity(curve(component["scalarOpacity"]))
    look.SetScalarOpacityUnitDistance(component.get("scalarOpacityUnitDistance", 1))
    look.SetInterpolationTypeToLinear()
    if "gradientOpacity" in component:
        look.SetGradientOpacity(curve(component["gradientOpacity"]))
    if component.get("shade"):
        light = component.get("lighting", {})
        look.ShadeOn()
        look.SetAmbient(light.get("ambient", look.GetAmbient()))
        look.SetDiffuse(light.get("diffuse", look.GetDiffuse()))
        look.SetSpecular(light.get("specular", look.GetSpecular()))
        look.SetSpecularPower(light.get("specularPower", look.GetSpecularPower()))
    return look


def stage(volume, look, camera):
    image = vtkImageData()
    image.SetDimensions(volume.shape[::-1])
    image.SetSpacing(volume.spacing[::-1])
    image.SetOrigin(volume.origin[::-1])
    image.GetPointData().SetScalars(numpy_to_vtk(volume.array.ravel()))
    mapper = vtkOpenGLGPUVolumeRayCastMapper()
    mapper.SetInputData(image)
    mapper.AutoAdjustSampleDistancesOff()
    mapper.UseJitteringOff()
    actor = vtkVolume()
    actor.SetMapper(mapper)
    actor.SetProperty(look)
    renderer = vtkRenderer()
    renderer.AddVolume(actor)
    window = vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(0)
    window.SetSize(SIZE, SIZE)
    window.AddRenderer(renderer)
    eye = renderer.GetActiveCamera()
    eye.ParallelProjectionOn()
    eye.SetPosition(camera.position)
    eye.SetFocalPoint(camera.focal_point)
    eye.SetViewUp(camera.up)
    eye.SetParallelScale(camera.parallel_scale)
    renderer.ResetCameraClippingRange()
    return window, renderer, mapper


def our_scene(volume, path):
    imported = pellucid.import_transfer_function(path, colors="linear")
    print("\n".join(imported.notes))
    layer = pellucid.Layer(volume, imported.transfer_function, shading=imported.shading,
                           gradient_opacity=imported.gradient_opacity)
    if layer.shading is not None:
        layer.shading.flatness = 0
    scene = pellucid.Scene([layer], size=(SIZE, SIZE))
    scene.camera = pellucid.default_camera(scene)
    scene.camera.projection = "orthographic"
    distance = numpy.linalg.norm(numpy.subtract(scene.camera.position, scene.camera.focal_point))
    scene.camera.parallel_scale = 0.27 * float(distance)
    scene.integration = pellucid.Integration(tolerance=1e-4)
    return scene


def main():
    volume, path = pellucid.read(sys.argv[1]), pathlib.Path(sys.argv[2])
    folder = pathlib.Path(sys.argv[3]) if len(sys.argv) > 3 else None
    if not numpy.array_equal(volume.direction, numpy.eye(3)):
        sys.exit(f"{sys.argv[1]}: its axes are turned, which VTK's mappers do not follow")
    scene = our_scene(volume, path)
    ours = pellucid.Renderer().render(scene)
    print(f"ours: largest error {ours.report['largest_error']:.2g}, {ours.report['seconds']:.2f} s")
    window, renderer, mapper = stage(volume, property_of(path), scene.camera)
    for step in STEPS:
        mapper.SetSampleDistance(step * volume.voxel_size)
        window.Render()
        theirs = pellucid.Image(pellucid.vtk._picture(window, renderer))
        off = ours.compare(theirs)
        print(f"| {step} | {off.largest:.4f} | {off.rms:.5f} | {100 * off.share_over_255:.2f} % |",
              flush=True)
    if folder:
        folder.mkdir(parents=True, exist_ok=True)
        ours.save(folder / "ours.png")
        theirs.save(folder / "theirs.png")
        grey = numpy.clip(20 * off.difference.max(axis=2), 0, 1)
        ones = numpy.ones_like(grey)
        pellucid.Image(numpy.stack([grey, grey, grey, ones], 2)).save(folder / "difference_x20.png")


if __name__ == "__main__":
    main()
