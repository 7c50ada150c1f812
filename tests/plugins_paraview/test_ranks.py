# SPDX-License-Identifier: Apache-2.0
"""Volumes of which each rank of pvbatch has a part, beside the program's pictures of the whole."""
import math
import os
import sys
import unittest

import numpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import test_meshes
from stage import (BLENDED, COLORS, OF_WINDOW, OPACITIES, TOLERANCE, UNIT, StageTest,
                   move, servermanager, simple, table_of)
from vtkmodules.util import numpy_support
from vtkmodules.vtkCommonDataModel import vtkImageData, vtkMultiBlockDataSet, vtkRectilinearGrid
from vtkmodules.vtkIOXML import (vtkXMLImageDataWriter, vtkXMLMultiBlockDataWriter,
                                 vtkXMLRectilinearGridWriter)

RANKS = servermanager.vtkProcessModule.GetProcessModule().GetNumberOfLocalPartitions()
SHAPE = (19, 15, 17)  # points along x, y, z
ORIGIN, SPACING = (-8.0, -7.0, -6.0), (1.0, 1.0, 0.9)


def bumps(x, y, z):
    return 157 + 90 * numpy.sin(x / 2.1) * numpy.cos(y / 2.5 + 0.3) + 5 * z


class Ranks(StageTest):
    bent, bent_layer = test_meshes.Meshes.bent, test_meshes.Meshes.bent_layer
    opened = test_meshes.Meshes.opened

    # Each rank rounds its colors to 8 bits, and so does each step that puts two pictures over each
    # other, which cuts off.
    of_ranks = RANKS * OF_WINDOW + (RANKS - 1) / 255

    def image(self, cells=False):
        """An image in a file, which ranks read in parts, and the same as a field."""
        sides = [n - 1 if cells else n for n in SHAPE]
        first = [o + (s / 2 if cells else 0) for o, s in zip(ORIGIN, SPACING)]
        x, y, z = (f + s * numpy.arange(n) for f, s, n in zip(first, SPACING, sides))
        values = bumps(x, y[:, None], z[:, None, None])
        # Rough, so that a gradient or a value from one side of a border is another one.
        k, j, i = numpy.ogrid[tuple(slice(n) for n in sides[::-1])]
        values = (values + 12 * ((3 * i + 5 * j + 7 * k) % 5 - 2)).astype("<f4")
        data = vtkImageData()
        data.SetDimensions(SHAPE)
        data.SetOrigin(ORIGIN)
        data.SetSpacing(SPACING)
        array = numpy_support.numpy_to_vtk(values.ravel(), deep=1)
        array.SetName("f")
        (data.GetCellData() if cells else data.GetPointData()).AddArray(array)
        self.whole = data
        writer = vtkXMLImageDataWriter()
        writer.SetFileName(self.path("image.vti"))
        writer.SetInputData(data)
        writer.SetDataModeToBinary()
        self.assertEqual(writer.Write(), 1)
        self.write("field.raw", values.tobytes())
        source = simple.OpenDataFile(self.path("image.vti"))
        source.UpdatePipeline()
        return source, {"file": "field.raw", "type": "f32", "spacing": list(SPACING),
                        "origin": first, "dimensions": sides,
                        "centering": "cell" if cells else "point"}

    def assert_whole(self, layers, further=0.0, **more):
        self.assert_same(layers, further=self.of_ranks - OF_WINDOW + further, **more)

    def layer(self, field, **more):
        return {"field": field, "transfer_function": table_of(COLORS, OPACITIES, UNIT), **more}

    def test_ranks_share_the_data(self):
        source, _ = self.image()
        self.assertGreater(RANKS, 1)
        information = source.GetDataInformation()
        # Points between two parts belong to both.
        self.assertGreater(information.GetNumberOfPoints(), numpy.prod(SHAPE))

    def test_points(self):
        source, field = self.image()
        display = self.show(source, "f")
        self.assert_whole([self.layer(field)])
        exact, largest, over = self.results(display)
        self.assertEqual((exact, over), (1, 0))
        self.assertTrue(0 < largest <= TOLERANCE, largest)

    def test_cells(self):
        source, field = self.image(cells=True)
        self.show(source, "f", "CELLS")
        self.assert_whole([self.layer(field)])

    def test_light_has_no_seams(self):
        source, field = self.image()
        display = self.show(source, "f")
        shading, lights = self.light(display)
        self.assert_whole([self.layer(field, shading=shading)], lights=lights)

    def test_parallel_projection(self):
        source, field = self.image()
        self.show(source, "f")
        self.view.CameraParallelProjection = 1
        self.view.CameraParallelScale = 13
        self.assert_whole([self.layer(field)])

    def test_inside(self):
        source, field = self.image()
        self.show(source, "f")
        self.view.CameraPosition = [1.2, 1.1, 0.3]
        self.view.CameraFocalPoint = [4.0, 2.0, 6.0]
        self.assert_whole([self.layer(field)])

    def test_background(self):
        source, field = self.image()
        self.show(source, "f")
        self.view.Background = [0.2, 0.3, 0.4]
        self.assert_whole([self.layer(field)], further=BLENDED)

    def test_moved(self):
        source, field = self.image()
        display = self.show(source, "f")
        move(display, [2, -1, 3])
        display.Orientation = [0, 0, 90]
        self.assert_whole([self.layer(
            field, transform=[[0, -1, 0, 2], [1, 0, 0, -1], [0, 0, 1, 3]])])

    def turns(self):
        """Quarter turns and a mirror: displays' settings, and transforms of the same."""
        return [({"Orientation": [0, 0, -90]}, [[0, 1, 0, 0], [-1, 0, 0, 0], [0, 0, 1, 0]]),
                ({"Orientation": [0, 180, 0]}, [[-1, 0, 0, 0], [0, 1, 0, 0], [0, 0, -1, 0]]),
                ({"Scale": [-1, 1, 1]}, [[-1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]])]

    def test_turned_after_a_picture(self):
        source, field = self.image()
        display = self.show(source, "f")
        self.picture()
        for settings, transform in self.turns():
            with self.subTest(settings):
                display.Orientation, display.Scale = [0, 0, 0], [1, 1, 1]
                for name, value in settings.items():
                    setattr(display, name, value)
                self.assert_whole([self.layer(field, transform=transform)])
                self.assertEqual(self.results(display)[0], 1)

    def test_turned_so_that_boxes_overlap_is_not_called_exact(self):
        display = self.show(self.image()[0], "f")
        display.Orientation = [0, 0, 30]
        self.picture()
        self.assertEqual(self.results(display)[:2], [0, math.inf])

    def test_light_on_cells_has_no_seams(self):
        source, field = self.image(cells=True)
        display = self.show(source, "f", "CELLS")
        shading, lights = self.light(display)
        self.assert_whole([self.layer(field, shading=shading)], lights=lights)

    def test_light_that_is_brighter_than_opacities(self):
        """What 8 bits cannot hold is left out, and told."""
        source, field = self.image()
        display = self.show(source, "f")
        shading, lights = self.light(display)
        display.Specular, display.SpecularPower = 0.3, 4
        shading.update(specular=0.3, power=4)
        shown = self.picture()
        exact, largest, over = self.results(display)
        self.assertEqual(exact, 1)
        self.assertGreater(over, 0)
        self.assertTrue(0.01 < largest < 0.5, largest)
        self.assertLess(self.off(shown, [self.layer(field, shading=shading)], lights=lights),
                        largest + self.of_ranks)

    def border(self):
        """The middle of x, where two ranks meet."""
        return ORIGIN[0] + SPACING[0] * (SHAPE[0] - 1) / 2

    def test_a_slice_in_a_border_is_shown_once(self):
        source, field = self.image()
        display = self.show(source, "f", opacities=[37, 0.4, 0.5, 0, 277, 0.4, 0.5, 0])
        display.BlendMode = "Slice"
        point = [self.border(), 0, 0]
        display.PellucidSliceFunction.Origin = point
        display.PellucidSliceFunction.Normal = [1, 0, 0]
        self.assert_whole([{"field": field, "slices": [
            {"point": point, "normal": [1, 0, 0], "opacity": 0.4,
             "colors": {"points": [{"value": v, "extinction": 0, "color": list(c)} for v, *c in
                                   numpy.reshape(COLORS, (-1, 4))]}}]}])

    def test_an_isosurface_in_a_border_is_shown_once(self):
        source, field = self.image()
        values = numpy.broadcast_to(ORIGIN[0] + SPACING[0] * numpy.arange(SHAPE[0]), SHAPE[::-1])
        self.write("field.raw", numpy.ascontiguousarray(values, "<f4").tobytes())
        along_x = simple.Calculator(source, Function="coordsX", ResultArrayName="x")
        display = self.show(along_x, "x", colors=[-8, 1, 0.5, 0, 10, 1, 0.5, 0],
                            opacities=[-8, 0.4, 0.5, 0, 10, 0.4, 0.5, 0])
        display.BlendMode = "Isosurface"
        display.IsosurfaceValues = [self.border()]
        self.assert_whole([{"field": field, "isosurfaces": [
            {"value": self.border(), "color": [1, 0.5, 0], "opacity": 0.4}]}])

    def test_cropping_is_of_the_whole(self):
        source, field = self.image()
        display = self.show(source, "f")
        display.UseCropping = 1
        display.CroppingOrigin, display.CroppingScale = [1, 0, 0], [0.6, 0.7, 0.5]
        lower = numpy.add([1, 0, 0], numpy.multiply(ORIGIN, [0.6, 0.7, 0.5]))
        upper = numpy.add([1, 0, 0], numpy.multiply(
            numpy.add(ORIGIN, numpy.multiply(SPACING, numpy.subtract(SHAPE, 1))), [0.6, 0.7, 0.5]))
        self.assert_whole([self.layer(field, clip=[
            {"box": {"lower": lower.tolist(), "upper": upper.tolist()}}])])

    def blocks(self, order):
        """The image in four slabs along z, which the ranks share in this order."""
        field = self.image()[1]
        blocks = vtkMultiBlockDataSet()
        cuts = [0, 4, 8, 12, SHAPE[2] - 1]
        for place, slab in enumerate(order):
            block = vtkImageData()
            block.DeepCopy(self.whole)
            block.Crop([*self.whole.GetExtent()[:4], cuts[slab], cuts[slab + 1]])
            blocks.SetBlock(place, block)
        writer = vtkXMLMultiBlockDataWriter()
        writer.SetFileName(self.path("blocks.vtm"))
        writer.SetInputData(blocks)
        writer.SetDataModeToBinary()
        self.assertEqual(writer.Write(), 1)
        return simple.OpenDataFile(self.path("blocks.vtm")), field

    def test_blocks(self):
        source, field = self.blocks((0, 1, 2, 3))
        display = self.show(source, "f")
        self.assert_whole([self.layer(field)])
        self.assertEqual(self.results(display)[0], 1)

    def test_blocks_out_of_order_are_not_called_exact(self):
        display = self.show(self.blocks((0, 2, 1, 3))[0], "f")
        self.picture()
        self.assertEqual(self.results(display)[:2], [0, math.inf])

    def test_volumes_that_are_cut_in_other_ways_are_not_called_exact(self):
        first = self.show(self.image()[0], "f")
        self.picture()
        self.assertEqual(self.results(first)[0], 1)
        second = self.show(simple.Wavelet(WholeExtent=[12, 14, -2, 2, -20, 20]), "RTData")
        self.picture()
        for display in (first, second):
            self.assertEqual(self.results(display)[:2], [0, math.inf])

    def test_rectilinear_grid(self):
        """Of values that are linear, so that any grid of them has the same field."""
        axes = [numpy.array(a, float) for a in
                ([-8, -7.5, -5, -3, 0, 2, 4, 7, 9], [-6, 1, 2, 2.5, 7], [-7, -6, 5, 6])]
        grid = vtkRectilinearGrid()
        grid.SetDimensions([len(axis) for axis in axes])
        for name, axis in zip("XYZ", axes):
            getattr(grid, f"Set{name}Coordinates")(numpy_support.numpy_to_vtk(axis, deep=1))
        z, y, x = numpy.meshgrid(*axes[::-1], indexing="ij")
        values = numpy_support.numpy_to_vtk((157 + 9 * x + 4 * y - 2 * z).ravel(), deep=1)
        values.SetName("f")
        grid.GetPointData().AddArray(values)
        writer = vtkXMLRectilinearGridWriter()
        writer.SetFileName(self.path("grid.vtr"))
        writer.SetInputData(grid)
        writer.SetDataModeToBinary()
        self.assertEqual(writer.Write(), 1)
        display = self.show(simple.OpenDataFile(self.path("grid.vtr")), "f")
        shading, lights = self.light(display)
        corners = numpy.array([157 + 9 * x + 4 * y - 2 * z for z in (-7, 6) for y in (-6, 7)
                               for x in (-8, 9)], "<f4")
        self.write("field.raw", corners.tobytes())
        self.assert_whole([self.layer({"file": "field.raw", "type": "f32", "dimensions": [2, 2, 2],
                                       "origin": [-8, -6, -7], "spacing": [17, 13, 13]},
                                      shading=shading)], lights=lights)
        self.assertEqual(self.results(display)[0], 1)

    def test_turned_cells(self):
        cells = list(test_meshes.hexahedra())
        half = len(cells) // 2
        display = self.show(self.pieces(cells[:half], cells[half:]), "f")
        self.picture()
        display.Orientation = [180, 0, 0]
        self.assert_whole([{**self.bent_layer(),
                            "transform": [[1, 0, 0, 0], [0, -1, 0, 0], [0, 0, -1, 0]]}])
        self.assertEqual(self.results(display)[0], 1)

    def test_errors_are_of_all_ranks(self):
        source, field = self.image()
        display = self.show(source, "f")
        for tolerance in (2e-2, 1e-4):
            display.Tolerance = tolerance
            self.assert_same([self.layer(field)], tolerance, self.of_ranks - OF_WINDOW)
            exact, largest, over = self.results(display)
            self.assertEqual((exact, over), (1, 0))
            self.assertTrue(0.01 * tolerance < largest <= tolerance, largest)

    def test_no_rank_but_one_has_data(self):
        """ParaView reads a file of cells on the first rank."""
        source = self.opened(self.bent())
        display = self.show(source, "f")
        self.assert_whole([self.bent_layer()])
        exact, largest, over = self.results(display)
        self.assertEqual((exact, over), (1, 0))
        self.assertLessEqual(largest, TOLERANCE)

    def pieces(self, first, second):
        """The bent grid as a file of two pieces, of some hexahedra each."""
        points = test_meshes.points_of_grid().reshape(-1, 3)
        for number, cells in enumerate((first, second)):
            used, places = numpy.unique(cells, return_inverse=True)
            self.opened(test_meshes.grid_of(
                points[used], [(test_meshes.VTK_HEXAHEDRON, cell)
                               for cell in places.reshape(-1, 8).tolist()],
                {"f": test_meshes.bumps(points[used])}))
            os.replace(self.path("mesh.vtu"), self.path(f"piece{number}.vtu"))
        self.write("mesh.pvtu", """<VTKFile type="PUnstructuredGrid" version="0.1">
            <PUnstructuredGrid GhostLevel="0">
            <PPointData><PDataArray type="Float64" Name="f"/></PPointData>
            <PPoints><PDataArray type="Float64" NumberOfComponents="3"/></PPoints>
            <Piece Source="piece0.vtu"/><Piece Source="piece1.vtu"/>
            </PUnstructuredGrid></VTKFile>""")
        source = simple.OpenDataFile(self.path("mesh.pvtu"))
        source.UpdatePipeline()
        return source

    def test_pieces_of_cells(self):
        cells = list(test_meshes.hexahedra())
        half = len(cells) // 2  # z is not bent
        display = self.show(self.pieces(cells[:half], cells[half:]), "f")
        self.assert_whole([self.bent_layer()])
        self.assertEqual(self.results(display)[0], 1)

    def test_pieces_that_overlap_are_not_called_exact(self):
        cells = list(test_meshes.hexahedra())
        display = self.show(self.pieces(cells[::2], cells[1::2]), "f")
        self.picture()
        exact, largest, _ = self.results(display)
        self.assertEqual((exact, largest), (0, math.inf))


if __name__ == "__main__":
    # Debian's pvpython crashes in sys.exit().
    unittest.main(argv=["test_ranks"], exit=False)
