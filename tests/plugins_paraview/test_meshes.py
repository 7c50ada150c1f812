# SPDX-License-Identifier: Apache-2.0
"""Unstructured grids in ParaView, beside the program's pictures of the same scene."""
import os
import struct
import sys
import unittest

import numpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from stage import (BLENDED, COLORS, OF_WINDOW, OPACITIES, OURS, TOLERANCE, UNIT, StageTest,
                   extinctions_of, move, plane, simple, unit)
from vtkmodules.util import numpy_support
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import (VTK_HEXAHEDRON, VTK_TETRA, VTK_WEDGE,
                                           vtkUnstructuredGrid)
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter

SHAPE = (7, 6, 5)  # points along x, y, z


def points_of_grid():
    """Points of a bent grid, x fastest."""
    z, y, x = numpy.meshgrid(*(numpy.linspace(-s, s, n) for s, n in zip((8, 7, 9), SHAPE[::-1])),
                             indexing="ij")
    return numpy.stack([x + 0.1 * y * numpy.sin(z / 4), y + 0.6 * numpy.cos(x / 3), z], -1)


def bumps(points):
    return 157 + 90 * numpy.sin(points[..., 0] / 3) * numpy.cos(points[..., 1] / 4 + 0.3) \
        + 3 * points[..., 2]


def hexahedra():
    for k in range(SHAPE[2] - 1):
        for j in range(SHAPE[1] - 1):
            for i in range(SHAPE[0] - 1):
                first = i + SHAPE[0] * (j + SHAPE[1] * k)
                layer = SHAPE[0] * SHAPE[1]
                yield [first + o for o in (0, 1, SHAPE[0] + 1, SHAPE[0], layer, layer + 1,
                                           layer + SHAPE[0] + 1, layer + SHAPE[0])]


def grid_of(points, cells, arrays):
    grid = vtkUnstructuredGrid()
    place = vtkPoints()
    place.SetData(numpy_support.numpy_to_vtk(numpy.reshape(points, (-1, 3)), deep=1))
    grid.SetPoints(place)
    for kind, cell in cells:
        grid.InsertNextCell(kind, len(cell), cell)
    for name, values in arrays.items():
        array = numpy_support.numpy_to_vtk(values, deep=1)
        array.SetName(name)
        grid.GetPointData().AddArray(array)
    return grid


class Meshes(StageTest):
    def opened(self, grid):
        """The grid, as ParaView reads it from a file."""
        writer = vtkXMLUnstructuredGridWriter()
        writer.SetFileName(self.path("mesh.vtu"))
        writer.SetInputData(grid)
        writer.SetDataModeToBinary()
        self.assertEqual(writer.Write(), 1)
        source = simple.OpenDataFile(self.path("mesh.vtu"))
        source.UpdatePipeline()
        return source

    def bent(self):
        points = points_of_grid()
        f = bumps(points).ravel()
        return grid_of(points, [(VTK_HEXAHEDRON, cell) for cell in hexahedra()],
                       {"f": f, "v": numpy.stack([0 * f, 0.8 * f, 0.6 * f], -1)})

    def bent_layer(self, unit_distance=UNIT):
        """The same cells and values as the program reads them from files of PLOT3D."""
        points = points_of_grid()
        head = struct.pack("<3i", *SHAPE)
        self.write("mesh.xyz", head + b"".join(numpy.ascontiguousarray(points[..., a], "<f8")
                                               .tobytes() for a in range(3)))
        f = bumps(points).astype("<f8")
        rest = numpy.zeros(f.shape, "<f8")
        self.write("mesh.q", head + struct.pack("<4d", 0, 0, 0, 0) + f.tobytes()
                   + 3 * rest.tobytes() + rest.tobytes())
        return {"mesh": {"file": "mesh.xyz", "q": "mesh.q", "array": "Density"},
                "transfer_function": extinctions_of(COLORS, OPACITIES, unit_distance)}

    def test_hexahedra(self):
        self.show(self.opened(self.bent()), "f")
        self.assert_same([self.bent_layer()])

    def test_unit_distance_and_parallel_projection(self):
        display = self.show(self.opened(self.bent()), "f")
        display.ScalarOpacityUnitDistance = 6
        self.view.CameraParallelProjection = 1
        self.view.CameraParallelScale = 13
        self.assert_same([self.bent_layer(6)])

    def test_component_and_length(self):
        source = self.opened(self.bent())
        self.show(source, ("v", "Magnitude"))
        self.assert_same([self.bent_layer()])

    def test_moved(self):
        display = self.show(self.opened(self.bent()), "f")
        move(display, [2, -1, 3])
        self.assert_same([{**self.bent_layer(),
                           "transform": [[1, 0, 0, 2], [0, 1, 0, -1], [0, 0, 1, 3]]}])

    def mixed(self, association):
        """A box of a hexahedron, two wedges and six tetrahedra: of a linear function any cells
        have the same field."""
        low, high = (-8, -6, -7), (9, 7, 6)
        steps = [low[0], -3, 4, high[0]]
        points = [(x, y, z) for z in (low[2], high[2]) for y in (low[1], high[1]) for x in steps]

        def corners(i):
            return [i, i + 1, i + 5, i + 4, i + 8, i + 9, i + 13, i + 12]
        a, b, c = corners(0), corners(1), corners(2)
        cells = [(VTK_HEXAHEDRON, a),
                 (VTK_WEDGE, [b[0], b[1], b[2], b[4], b[5], b[6]]),
                 (VTK_WEDGE, [b[0], b[2], b[3], b[4], b[6], b[7]])]
        for path in ((1, 2), (1, 5), (3, 2), (3, 7), (4, 5), (4, 7)):
            cells.append((VTK_TETRA, [c[0], c[path[0]], c[path[1]], c[6]]))
        f = numpy.array([157 + 9 * x + 4 * y - 2 * z for x, y, z in points], float)
        self.write("ramp.raw", numpy.array(
            [157 + 9 * x + 4 * y - 2 * z for z in (low[2], high[2]) for y in (low[1], high[1])
             for x in (low[0], high[0])], "<f4").tobytes())
        return grid_of(numpy.array(points, float), cells, {"f": f}), {
            "field": {"file": "ramp.raw", "type": "f32", "dimensions": [2, 2, 2],
                      "origin": list(low), "spacing": [17, 13, 13]},
            "transfer_function": extinctions_of(COLORS, OPACITIES, UNIT)}

    def test_turned_about_a_place_far_off(self):
        """The camera's range is that of the data where they are shown."""
        display = self.show(self.opened(self.bent()), "f")
        display.Orientation = [0, 0, 180]
        move(display, [20, 30, 0])
        self.view.CameraFocalPoint = [20, 30, 0]
        self.assert_same([{**self.bent_layer(),
                           "transform": [[-1, 0, 0, 20], [0, -1, 0, 30], [0, 0, 1, 0]]}])

    def test_mixed_cells(self):
        grid, layer = self.mixed("POINTS")
        self.show(self.opened(grid), "f")
        self.assert_same([layer])

    def test_blocks(self):
        """ParaView merges the blocks, and cuts their cells."""
        grid, layer = self.mixed("POINTS")
        source = self.opened(grid)
        group = simple.GroupDatasets(Input=[source])
        group.UpdatePipeline()
        simple.Hide(source, self.view)
        display = simple.Show(group, self.view, "UnstructuredGridRepresentation")
        self.assertIn(OURS, display.GetProperty("Representation").Available)
        self.show(group, "f")
        self.assert_same([layer])

    def test_rays_end_inside(self):
        self.show(self.opened(self.bent()), "f")
        layer = self.bent_layer()
        forward = unit(numpy.subtract(self.focal_point, self.position))
        normal = unit(-forward + numpy.array([0.3, 0.1, 0.2]))
        across = unit(numpy.cross(normal, self.up))
        plane(self.view, self.focal_point, 200 * across, 200 * numpy.cross(across, normal),
              (0.2, 0.7, 0.3))
        shown = self.picture()
        self.view.Background = [0.2, 0.7, 0.3]
        self.assertLess(self.off(shown, [layer], clip=[
            {"plane": {"point": list(self.focal_point), "normal": list(normal)}}]),
            OF_WINDOW + TOLERANCE + 2e-4 + BLENDED)

    def test_beside_paraview(self):
        """ParaView's own mappers show much the same."""
        display = self.show(self.opened(self.bent()), "f")
        ours = self.picture()
        display.SetRepresentationType("Volume")
        for mapper, mean in (("Projected tetra", 0.02), ("Bunyk ray cast", 0.02)):
            display.SelectMapper = mapper
            self.picture()  # the first one is empty
            theirs = self.picture()
            self.assertGreater(numpy.ptp(theirs), 0.2)
            self.assertLess(abs(ours - theirs).mean(), mean, mapper)
        display.SetRepresentationType(OURS)
        self.assertEqual(abs(self.picture() - ours).max(), 0)

    def test_tolerance(self):
        display = self.show(self.opened(self.bent()), "f")
        layer = self.bent_layer()
        for tolerance in (0.05, TOLERANCE, 1e-4):
            display.Tolerance = tolerance
            self.assert_same([layer], tolerance)
            exact, error, over = self.results(display)
            self.assertEqual((exact, over), (1, 0))
            self.assertLessEqual(error, tolerance)


if __name__ == "__main__":
    # Debian's pvpython crashes in sys.exit().
    unittest.main(argv=["test_meshes"], exit=False)
