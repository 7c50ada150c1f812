# SPDX-License-Identifier: Apache-2.0
"""A view of ParaView with the plug-in, and the same scene by the program."""
import json
import math
import os
import sys

import numpy

sys.path.append(os.path.join(os.environ["PELLUCID_SOURCE_DIR"], "tests", "cli"))
from program import ProgramTest, exr
from paraview import servermanager, simple
from vtkmodules.numpy_interface import dataset_adapter
from vtkmodules.util import numpy_support
from vtkmodules.vtkIOImage import vtkPNGReader

OURS = "Volume (Pellucid)"
TOLERANCE = 1 / 512
# Half a step of 8 bits, the 15 bits that the display takes, and the program's tolerance.
OF_WINDOW = 0.5 / 255 + 1 / 32767 + 1e-5
# Where there is a color behind, the window rounds it, and what is blended over it, as well.
BLENDED = 2 * 0.5 / 255

COLORS = [37, 0, 0, 1, 150, 1, 0.5, 0, 277, 1, 1, 1]
OPACITIES = [37, 0, 0.5, 0, 120, 0.02, 0.5, 0, 200, 0.3, 0.5, 0, 277, 0.1, 0.5, 0]
UNIT = 2.5


def points_of(colors, opacities):
    """ParaView's two functions as points of one: value, opacity, color."""
    colors = numpy.reshape(colors, (-1, 4))
    opacities = numpy.reshape(opacities, (-1, 4))
    values = sorted({*colors[:, 0], *opacities[:, 0]})
    shown = [numpy.interp(values, colors[:, 0], colors[:, c]) for c in (1, 2, 3)]
    alpha = numpy.interp(values, opacities[:, 0], opacities[:, 1])
    return [{"value": v, "opacity": a, "color": list(color)}
            for v, a, *color in zip(values, alpha, *shown)]


def table_of(colors, opacities, unit):
    """A function of an image: opacities of a layer of the unit distance."""
    return {"unit_distance": unit, "points": points_of(colors, opacities)}


def extinctions_of(colors, opacities, unit):
    """A function of an unstructured grid: VTK's opacities are extinctions per unit distance."""
    return {"points": [{"value": p["value"], "extinction": p["opacity"] / unit, "color": p["color"]}
                       for p in points_of(colors, opacities)]}


class StageTest(ProgramTest):
    """Every test has a session, a view and a camera of its own."""

    size = (96, 64)
    position, focal_point, up, angle = (40.0, 55.0, -30.0), (1.0, 2.0, 0.0), (0.1, 1.0, 0.2), 25.0

    def setUp(self):
        super().setUp()
        simple.ResetSession()
        simple.LoadPlugin(os.environ["PELLUCID_PARAVIEW_PLUGIN"], remote=False, ns=globals())
        self.view = self.new_view()

    def new_view(self):
        view = simple.CreateView("RenderView")
        view.ViewSize = self.size
        view.OrientationAxesVisibility = 0
        view.UseColorPaletteForBackground = 0
        view.Background = [0, 0, 0]
        view.UseFXAA = 0
        view.CameraPosition, view.CameraFocalPoint = self.position, self.focal_point
        view.CameraViewUp, view.CameraViewAngle = self.up, self.angle
        return view

    def show(self, source, array, association="POINTS", kind=OURS, colors=COLORS,
             opacities=OPACITIES, unit=UNIT, space="RGB"):
        display = simple.Show(source, self.view)
        display.SetRepresentationType(kind)
        simple.ColorBy(display, (association, *array) if isinstance(array, tuple)
                       else (association, array))
        display.SetScalarBarVisibility(self.view, False)
        lut = display.LookupTable
        lut.ColorSpace = space
        lut.RGBPoints = colors
        display.ScalarOpacityFunction.Points = opacities
        display.ScalarOpacityUnitDistance = unit
        return display

    def light(self, display):
        """Puts the display in the light of a head light: the shading and the lights of a scene."""
        display.Shade = 1
        self.view.UseLight = 0
        simple.AddLight(self.view).Coords = "Headlight"
        return ({"ambient": 0, "diffuse": 1, "specular": 0, "flatness": 0}, [{"type": "head"}])

    def picture(self, name="shown.png"):
        """float (height, width, 3), row 0 at the top: the window as users save it."""
        simple.SaveScreenshot(self.path(name), self.view, ImageResolution=list(self.size))
        reader = vtkPNGReader()
        reader.SetFileName(self.path(name))
        reader.Update()
        image = reader.GetOutput()
        values = numpy_support.vtk_to_numpy(image.GetPointData().GetScalars())
        self.assertEqual(image.GetDimensions()[:2], tuple(self.size))
        return values.reshape(self.size[1], self.size[0], -1)[::-1, :, :3] / 255

    def camera(self):
        return {"position": list(self.view.CameraPosition),
                "focal_point": list(self.view.CameraFocalPoint), "up": list(self.view.CameraViewUp),
                **({"projection": "orthographic",
                    "parallel_scale": self.view.CameraParallelScale}
                   if self.view.CameraParallelProjection
                   else {"vertical_angle": self.view.CameraViewAngle})}

    def off(self, shown, layers, **more):
        """The largest difference of a picture and the program's of these layers, over the color
        behind."""
        width, height = self.size
        self.write("behind.exr", exr([[(*self.view.Background, 1)] * width] * height,
                                     depth=[[math.inf] * width] * height))
        scene = {"pellucid": 2, "layers": layers, "camera": self.camera(),
                 "image": {"width": width, "height": height, "backdrop": "behind.exr"},
                 "integration": {"tolerance": 1e-5}, **more}
        self.write("scene.json", json.dumps(scene))
        self.succeed("render", "scene.json", "-o", "truth.exr", "-q")
        self.write("shown.exr", exr([[(*pixel, 1) for pixel in row] for row in shown]))
        report = json.loads(self.succeed("compare", "truth.exr", "shown.exr", "--json"))
        return report["largest"]

    def assert_same(self, layers, tolerance=TOLERANCE, further=0, **more):
        shown = self.picture()
        self.assertGreater(numpy.ptp(shown), 0.2, "the picture is empty")
        self.assertLess(self.off(shown, layers, **more), OF_WINDOW + tolerance + further)

    def field_of(self, source, array, cells=False):
        """The values of an image as a field of a scene, from ParaView's pipeline."""
        image = servermanager.Fetch(source)
        adapter = dataset_adapter.WrapDataObject(image)
        values = numpy.asarray((adapter.CellData if cells else adapter.PointData)[array], "<f4")
        spacing = image.GetSpacing()
        extent = image.GetExtent()
        first = [image.GetOrigin()[a] + (extent[2 * a] + (0.5 if cells else 0)) * spacing[a]
                 for a in range(3)]
        self.write("field.raw", values.tobytes())
        return {"file": "field.raw", "type": "f32", "spacing": list(spacing), "origin": first,
                "dimensions": [n - (1 if cells else 0) for n in image.GetDimensions()],
                "centering": "cell" if cells else "point"}

    def results(self, display):
        proxy = display.SMProxy
        proxy.UpdatePropertyInformation()
        return [proxy.GetProperty(name).GetElement(0)
                for name in ("Exact", "LargestError", "PixelsOver")]


def move(display, position):
    """Moves what is shown: by a property that ParaView 5.13 has renamed."""
    setattr(display, "Translation" if hasattr(display, "Translation") else "Position", position)


def plane(view, center, across, up, color):
    """Shows a rectangle of one color, without light."""
    source = simple.Plane(Origin=list(numpy.subtract(center, numpy.add(across, up) / 2)),
                          Point1=list(numpy.add(center, numpy.subtract(across, up) / 2)),
                          Point2=list(numpy.add(center, numpy.subtract(up, across) / 2)))
    display = simple.Show(source, view)
    display.SetRepresentationType("Surface")
    display.ColorArrayName = [None, ""]
    display.AmbientColor = display.DiffuseColor = list(color)
    display.Ambient, display.Diffuse, display.Specular = 1, 0, 0
    return source, display


def unit(vector):
    return numpy.asarray(vector, float) / math.sqrt(numpy.dot(vector, vector))
