# SPDX-License-Identifier: Apache-2.0
"""Images and rectilinear grids in ParaView, beside the program's pictures of the same scene."""
import math
import os
import sys
import unittest

import numpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from stage import (BLENDED, COLORS, OF_WINDOW, OPACITIES, OURS, TOLERANCE, UNIT, StageTest, move,
                   plane, simple, table_of, unit)
from vtkmodules.util import numpy_support
from vtkmodules.vtkCommonDataModel import vtkImageData, vtkRectilinearGrid
from vtkmodules.vtkRenderingCore import vtkColorTransferFunction


def ramp(x, y, z):
    """Linear, so that any grid of these values has the same field."""
    return 157 + 9 * x + 4 * y - 2 * z


RAMP = {"file": "ramp.raw", "type": "f32", "dimensions": [2, 2, 2]}


class Volumes(StageTest):
    def wavelet(self, **settings):
        source = simple.Wavelet(WholeExtent=[-8, 10, -7, 7, -6, 8])
        source.UpdatePipeline()
        return source, self.show(source, "RTData", **settings)

    def layer(self, source, **more):
        return {"field": self.field_of(source, "RTData"),
                "transfer_function": table_of(COLORS, OPACITIES, UNIT), **more}

    def test_wavelet(self):
        source, _ = self.wavelet()
        self.assert_same([self.layer(source)])

    def test_parallel_projection(self):
        source, _ = self.wavelet()
        self.view.CameraParallelProjection = 1
        self.view.CameraParallelScale = 13
        self.assert_same([self.layer(source)])

    def test_background(self):
        source, _ = self.wavelet()
        self.view.Background = [0.2, 0.3, 0.4]
        self.assert_same([self.layer(source)], further=BLENDED)

    def test_unit_distance(self):
        source, display = self.wavelet()
        display.ScalarOpacityUnitDistance = 7
        self.assert_same([self.layer(
            source, transfer_function=table_of(COLORS, OPACITIES, 7))])

    def test_cells(self):
        points = simple.Wavelet(WholeExtent=[-8, 10, -7, 7, -6, 8])
        cells = simple.PointDatatoCellData(Input=points)
        cells.UpdatePipeline()
        self.show(cells, "RTData", "CELLS")
        self.assert_same([{"field": self.field_of(cells, "RTData", cells=True),
                           "transfer_function": table_of(COLORS, OPACITIES, UNIT)}])

    def test_moved(self):
        source, display = self.wavelet()
        move(display, [2, -1, 3])
        display.Orientation = [0, 0, 90]
        self.assert_same([self.layer(
            source, transform=[[0, -1, 0, 2], [1, 0, 0, -1], [0, 0, 1, 3]])])

    def test_light(self):
        source, display = self.wavelet()
        shading, lights = self.light(display)
        self.assert_same([self.layer(source, shading=shading)], lights=lights)

    def test_colors_of_a_map(self):
        """ParaView's maps of colors are curves with steps for surfaces; volumes have none."""
        source, display = self.wavelet()
        lut = display.LookupTable
        lut.ColorSpace = "Diverging"
        lut.RGBPoints = [37, 0.23, 0.3, 0.75, 157, 0.87, 0.87, 0.87, 277, 0.7, 0.016, 0.15]
        lut.Discretize, lut.NumberOfTableValues = 1, 6
        smooth = vtkColorTransferFunction()
        smooth.SetColorSpaceToDiverging()
        for i in range(3):
            smooth.AddRGBPoint(*lut.RGBPoints[4 * i:4 * i + 4])
        colors = []
        for value in numpy.linspace(37, 277, 481):
            colors += [value, *smooth.GetColor(value)]
        self.assert_same([self.layer(
            source, transfer_function=table_of(colors, OPACITIES, UNIT))])

    def test_isosurfaces(self):
        source, display = self.wavelet()
        display.BlendMode = "Isosurface"
        display.IsosurfaceValues = [120, 200]
        self.assert_same([{"field": self.field_of(source, "RTData"), "isosurfaces": [
            {"value": v, "color": [float(numpy.interp(v, COLORS[::4], COLORS[c::4]))
                                   for c in (1, 2, 3)],
             "opacity": float(numpy.interp(v, OPACITIES[::4], OPACITIES[1::4]))}
            for v in (120, 200)]}])

    def test_slice(self):
        source, display = self.wavelet()
        display.BlendMode = "Slice"
        plane_of = display.PellucidSliceFunction
        plane_of.Origin, plane_of.Normal = [1, 0, 1], [1, 0.5, 0.25]
        display.ScalarOpacityFunction.Points = [37, 0.7, 0.5, 0, 277, 0.7, 0.5, 0]
        self.assert_same([{"field": self.field_of(source, "RTData"), "slices": [
            {"point": [1, 0, 1], "normal": [1, 0.5, 0.25], "opacity": 0.7,
             "colors": {"points": [{"value": v, "extinction": 0, "color": list(c)} for v, *c in
                                   numpy.reshape(COLORS, (-1, 4))]}}]}])

    def test_a_separate_array_of_opacities_is_refused(self):
        source, display = self.wavelet()
        self.picture()
        display.UseSeparateOpacityArray = 1
        self.assertEqual(self.picture().max(), 0)
        self.assertEqual(self.results(display)[:2], [0, math.inf])

    def test_cropping(self):
        source, display = self.wavelet()
        display.UseCropping = 1
        display.CroppingOrigin, display.CroppingScale = [1, 0, 0], [0.5, 0.6, 0.4]
        self.assert_same([self.layer(source, clip=[
            {"box": {"lower": [-3, -4.2, -2.4], "upper": [6, 4.2, 3.2]}}])])

    def show_data(self, data, array, **settings):
        source = simple.TrivialProducer()
        source.GetClientSideObject().SetOutput(data)
        source.UpdatePipeline()
        return source, self.show(source, array, **settings)

    def ramp_layer(self, low, high):
        self.write("ramp.raw", numpy.array(
            [ramp(x, y, z) for z in (low[2], high[2]) for y in (low[1], high[1])
             for x in (low[0], high[0])], "<f4").tobytes())
        return {"field": {**RAMP, "origin": list(low),
                          "spacing": [float(b - a) for a, b in zip(low, high)]},
                "transfer_function": table_of(COLORS, OPACITIES, UNIT)}

    def test_rectilinear_grid(self):
        axes = [numpy.array(a, float) for a in
                ([-8, -7.5, -3, 0, 4, 9], [-6, 1, 2, 2.5, 7], [-7, -6, 5, 6])]
        data = vtkRectilinearGrid()
        data.SetDimensions([len(a) for a in axes])
        for axis, name in zip(axes, "XYZ"):
            getattr(data, f"Set{name}Coordinates")(numpy_support.numpy_to_vtk(axis, deep=1))
        z, y, x = numpy.meshgrid(*axes[::-1], indexing="ij")
        values = numpy_support.numpy_to_vtk(ramp(x, y, z).ravel(), deep=1)
        values.SetName("f")
        data.GetPointData().SetScalars(values)
        self.show_data(data, "f")
        self.assert_same([self.ramp_layer((-8, -6, -7), (9, 7, 6))])

    def vectors(self):
        data = vtkImageData()
        data.SetDimensions(6, 5, 7)
        data.SetOrigin(-8, -6, -7)
        data.SetSpacing(3.4, 3.25, 13 / 6)
        points = numpy.array([data.GetPoint(i) for i in range(data.GetNumberOfPoints())])
        f = ramp(*points.T)
        values = numpy_support.numpy_to_vtk(numpy.array([0.6 * f, 0 * f + 3, f]).T, deep=1)
        values.SetName("v")
        data.GetPointData().AddArray(values)
        return data

    def test_component(self):
        self.show_data(self.vectors(), ("v", "2"))
        self.assert_same([self.ramp_layer((-8, -6, -7), (9, 7, 6))])

    def test_length(self):
        source, _ = self.show_data(self.vectors(), ("v", "Magnitude"))
        calculator = simple.Calculator(Input=source, Function="mag(v)", ResultArrayName="length")
        calculator.UpdatePipeline()
        self.assert_same([{"field": self.field_of(calculator, "length"),
                           "transfer_function": table_of(COLORS, OPACITIES, UNIT)}])

    def test_blocks(self):
        """Two halves are the whole."""
        whole = simple.Wavelet(WholeExtent=[-8, 10, -7, 7, -6, 8])
        halves = [simple.ExtractSubset(Input=whole, VOI=voi)
                  for voi in ([-8, 1, -7, 7, -6, 8], [1, 10, -7, 7, -6, 8])]
        group = simple.GroupDatasets(Input=halves)
        group.UpdatePipeline()
        simple.Hide(whole, self.view)
        display = simple.Show(group, self.view, "UniformGridRepresentation")
        self.assertIn(OURS, display.GetProperty("Representation").Available)
        self.show(group, "RTData")
        whole.UpdatePipeline()
        self.assert_same([self.layer(whole)])

    def depth_test(self, depth, sides):
        """A rectangle of one color, slanted, `depth` in front of the focal point."""
        source, _ = self.wavelet()
        forward = unit(numpy.subtract(self.focal_point, self.position))
        normal = unit(-forward + numpy.array([0.3, 0.1, 0.2]))
        across = unit(numpy.cross(normal, self.up))
        center = numpy.asarray(self.focal_point) - depth * forward
        plane(self.view, center, sides * across, sides * numpy.cross(across, normal),
              (0.2, 0.7, 0.3))
        return source, center, normal

    def test_rays_end_inside(self):
        source, center, normal = self.depth_test(2, 200)
        shown = self.picture()
        self.view.Background = [0.2, 0.7, 0.3]  # what is seen behind all that is in front of it
        # The window's depths have 24 bits over the clipping range.
        self.assertLess(self.off(shown, [self.layer(source)], clip=[
            {"plane": {"point": list(center), "normal": list(normal)}}]),
            OF_WINDOW + TOLERANCE + 2e-4 + BLENDED)
        self.assertGreater(numpy.ptp(shown), 0.2)

    def test_nothing_is_seen_through_what_is_in_front(self):
        self.depth_test(40, 200)
        shown = self.picture()
        self.assertLess(abs(shown - [0.2, 0.7, 0.3]).max(), 1.01 / 255)

    def test_what_is_behind_is_seen_through(self):
        source, *_ = self.depth_test(-60, 400)
        shown = self.picture()
        self.view.Background = [0.2, 0.7, 0.3]
        self.assertLess(self.off(shown, [self.layer(source)]), OF_WINDOW + TOLERANCE + BLENDED)

    def test_beside_paraview(self):
        """ParaView's own picture is much the same."""
        source, display = self.wavelet()
        ours = self.picture()
        display.SetRepresentationType("Volume")
        theirs = self.picture()
        self.assertGreater(numpy.ptp(theirs), 0.2)
        self.assertLess(abs(ours - theirs).mean(), 0.01)
        self.assertLess(abs(ours - theirs).max(), 0.15)
        self.assertGreater(abs(ours - theirs).max(), 0, "both are drawn by one mapper")

    def test_tolerance(self):
        source, display = self.wavelet()
        for tolerance in (0.05, TOLERANCE, 1e-4):
            display.Tolerance = tolerance
            self.assert_same([self.layer(source)], tolerance)
            exact, error, over = self.results(display)
            self.assertEqual((exact, over), (1, 0))
            self.assertLessEqual(error, tolerance)
            self.assertGreater(error, tolerance / 1000)

    def test_grade_and_threads(self):
        source, display = self.wavelet()
        display.Grade, display.Threads = "Proved", 1
        self.assert_same([self.layer(source)])
        self.assertEqual(self.results(display)[0], 1)

    def test_values_and_functions_that_change(self):
        source, display = self.wavelet()
        self.picture()
        source.XFreq = 90
        self.assert_same([self.layer(source)])
        display.ScalarOpacityFunction.Points = [37, 0, 0.5, 0, 277, 0.5, 0.5, 0]
        self.assert_same([self.layer(source, transfer_function=table_of(
            COLORS, [37, 0, 0.5, 0, 277, 0.5, 0.5, 0], UNIT))])


if __name__ == "__main__":
    # Debian's pvpython crashes in sys.exit().
    unittest.main(argv=["test_volumes"], exit=False)
