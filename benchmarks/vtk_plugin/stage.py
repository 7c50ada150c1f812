# SPDX-License-Identifier: Apache-2.0
"""Windows with a volume that VTK's mapper or ours draws. Run under Xvfb with Debian's python3."""
import pathlib

import numpy
import vtkmodules.all as vtk

BRAIN = pathlib.Path("/usr/share/mricron/templates/ch2.nii.gz")
WINDOWS = []  # a display whose last window closes may end


def waves(cells=40):
    """A vtkImageData of floats from about 37 to 277 (VTK's Wavelet)."""
    source = vtk.vtkRTAnalyticSource()
    half = cells // 2
    source.SetWholeExtent(-half, half, -half, half, -half, half)
    source.Update()
    return source.GetOutput()


def ball(side=40, kind=vtk.VTK_UNSIGNED_CHAR, components=1, spacing=(1, 1, 1)):
    """A ball whose values fall from 255 in its middle; further components are moved balls."""
    image = vtk.vtkImageData()
    image.SetDimensions(side, side, side)
    image.SetSpacing(*spacing)
    image.AllocateScalars(kind, components)
    memory = numpy.asarray(memoryview(image.GetPointData().GetScalars()))
    memory = memory.reshape(side, side, side, components)
    z, y, x = numpy.meshgrid(*(numpy.linspace(-1, 1, side),) * 3, indexing="ij")
    for c in range(components):
        shift = 0.3 * c
        r = numpy.sqrt((x - shift) ** 2 + (y + 0.5 * shift) ** 2 + z * z)
        memory[..., c] = 255 * numpy.clip(1.1 - r, 0, 1)
    return image


def tetrahedra(image):
    cut = vtk.vtkDataSetTriangleFilter()
    cut.SetInputData(image)
    cut.TetrahedraOnlyOn()
    cut.Update()
    return cut.GetOutput()


def property_of(opacities, colors, shade=False, unit=1.0):
    made, opacity, color = (vtk.vtkVolumeProperty(), vtk.vtkPiecewiseFunction(),
                            vtk.vtkColorTransferFunction())
    for point in opacities:
        opacity.AddPoint(*point)
    for point in colors:
        color.AddRGBPoint(*point)
    made.SetScalarOpacity(opacity)
    made.SetColor(color)
    made.SetScalarOpacityUnitDistance(unit)
    made.SetInterpolationTypeToLinear()
    made.SetShade(shade)
    return made


class Stage:
    """One volume in a window off the screen."""

    def __init__(self, mapper, data, look, size=(256, 256), background=(0, 0, 0)):
        self.mapper, self.look = mapper, look
        if data is not None:
            mapper.SetInputDataObject(data)
        self.volume = vtk.vtkVolume()
        self.volume.SetMapper(mapper)
        self.volume.SetProperty(look)
        self.renderer = vtk.vtkRenderer()
        self.renderer.SetBackground(*background)
        self.renderer.AddVolume(self.volume)
        self.window = vtk.vtkRenderWindow()
        WINDOWS.append(self.window)
        self.window.SetOffScreenRendering(1)
        self.window.SetMultiSamples(0)
        self.window.SetSize(*size)
        self.window.AddRenderer(self.renderer)
        self.camera = self.renderer.GetActiveCamera()

    def aim(self, azimuth=30, elevation=20, zoom=1.4):
        self.renderer.ResetCamera()
        self.camera.Azimuth(azimuth)
        self.camera.Elevation(elevation)
        self.camera.Zoom(zoom)
        self.renderer.ResetCameraClippingRange()

    def picture(self):
        """uint8 (height, width, 3), row 0 at the top."""
        self.window.Render()
        width, height = self.window.GetSize()
        data = vtk.vtkUnsignedCharArray()
        self.window.GetPixelData(0, 0, width - 1, height - 1, 0, data, 0)
        return numpy.array(memoryview(data)).reshape(height, width, 3)[::-1]


class Messages:
    """What VTK says within the block, on the standard error beside."""

    def __enter__(self):
        self.lines = []
        self.window = vtk.vtkStringOutputWindow()
        self.before = vtk.vtkOutputWindow.GetInstance()
        vtk.vtkOutputWindow.SetInstance(self.window)
        return self

    def __exit__(self, *_):
        vtk.vtkOutputWindow.SetInstance(self.before)
        self.lines = [line for line in self.window.GetOutput().splitlines() if line.strip()]
