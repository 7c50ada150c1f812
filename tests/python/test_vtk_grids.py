# SPDX-License-Identifier: Apache-2.0
"""Grids of VTK in memory: what they hide, which array is meant, and cells of every kind."""
import warnings

import numpy
import pytest

import pellucid

vtk = pytest.importorskip("vtkmodules.all")
from vtkmodules.util.numpy_support import numpy_to_vtk  # noqa: E402


def add(attributes, name, values, active=False):
    array = numpy_to_vtk(numpy.ascontiguousarray(values), deep=True)
    if name is not None:
        array.SetName(name)
    if active:
        attributes.SetScalars(array)
    else:
        attributes.AddArray(array)
    return array


def structured():
    """4 x 3 x 2 cells of size 1; values at points are x + 10 y + 100 z, in cells their number."""
    grid, points = vtk.vtkStructuredGrid(), vtk.vtkPoints()
    grid.SetDimensions(5, 4, 3)
    for z in range(3):
        for y in range(4):
            for x in range(5):
                points.InsertNextPoint(x, y, z)
    grid.SetPoints(points)
    place = numpy.array([points.GetPoint(i) for i in range(60)])
    add(grid.GetPointData(), "p", place @ [1, 10, 100])
    add(grid.GetCellData(), "c", numpy.arange(24.0))
    return grid


def unstructured():
    """The same as hexahedra."""
    change = vtk.vtkAppendFilter()
    change.AddInputData(structured())
    change.Update()
    return change.GetOutput()


def volume_of(grid, **options):
    return pellucid.mesh_of(grid, **options).statistics["volume"]


@pytest.mark.parametrize("kind", ["vtkCharArray", "vtkSignedCharArray"])
def test_bytes_are_numbers(kind):
    """VTK says that the memory of the first is text."""
    array = getattr(vtk, kind)()
    array.SetNumberOfTuples(27)
    for i in range(27):
        array.SetValue(i, chr(i + 60) if kind == "vtkCharArray" else i - 9)
    image = vtk.vtkImageData()
    image.SetDimensions(3, 3, 3)
    image.GetPointData().SetScalars(array)
    volume = pellucid.Volume(image)
    first = 60 if kind == "vtkCharArray" else -9
    assert volume.type == "i8" and numpy.array_equal(volume.array.ravel(),
                                                     numpy.arange(first, first + 27))


def test_hidden_points_hide_their_cells():
    grid = structured()
    assert volume_of(grid) == pytest.approx(24)
    grid.BlankPoint(0)  # a corner: one cell
    assert volume_of(grid) == pytest.approx(23)
    grid.BlankPoint(2 + 5 * 1 + 20 * 1)  # inside: eight more
    assert volume_of(grid) == pytest.approx(15)
    grid.UnBlankPoint(0)
    assert volume_of(grid) == pytest.approx(16)
    visible = sum(grid.IsCellVisible(cell) for cell in range(24))
    assert visible == 16


def test_hidden_cells():
    grid = structured()
    grid.BlankCell(23)
    mesh = pellucid.mesh_of(grid, ["c"])
    assert mesh.statistics["volume"] == pytest.approx(23) and mesh.range == (0, 22)
    grid.BlankPoint(0)
    assert pellucid.mesh_of(grid, ["c"]).range == (1, 22)
    for cell in range(24):
        grid.BlankCell(cell)
    with pytest.raises(pellucid.Error, match="all of its cells are hidden"):
        pellucid.mesh_of(grid)


@pytest.mark.parametrize("name, flag, left", [
    ("vtkGhostType", 1, 23), ("vtkGhostType", 32, 23), ("vtkGhostType", 8, 23),
    ("vtkGhostType", 4, 24), ("vtkGhostLevels", 1, 23), ("vtkGhostLevels", 2, 23),
    ("vtkGhostLevels", 0, 24)])
@pytest.mark.parametrize("make", [structured, unstructured])
def test_ghosts_of_cells(make, name, flag, left):
    grid = make()
    flags = numpy.zeros(24, dtype=numpy.uint8)
    flags[5] = flag
    add(grid.GetCellData(), name, flags)
    assert volume_of(grid) == pytest.approx(left)


def test_hidden_points_of_unstructured_grids():
    grid = unstructured()
    flags = numpy.zeros(60, dtype=numpy.uint8)
    flags[0] = 2
    add(grid.GetPointData(), "vtkGhostType", flags)
    assert volume_of(grid) == pytest.approx(23)


def test_ghosts_and_numbers_are_no_data():
    grid = unstructured()
    for attributes in (grid.GetPointData(), grid.GetCellData()):
        attributes.Initialize()
    add(grid.GetPointData(), "vtkGhostType", numpy.zeros(60, dtype=numpy.uint8))
    ids = add(grid.GetPointData(), "ids", numpy.arange(60))
    grid.GetPointData().SetGlobalIds(ids)
    with pytest.raises(pellucid.Error, match="has no values"):
        pellucid.mesh_of(grid)


@pytest.mark.parametrize("make", [structured, unstructured])
def test_the_active_array_is_shown(make):
    grid = make()
    assert pellucid.mesh_of(grid).range == (0, 234)
    add(grid.GetCellData(), "p", 500 + numpy.arange(24.0), active=True)  # named as one of points
    assert pellucid.mesh_of(grid).range == (500, 523)
    assert pellucid.mesh_of(grid, ["p"]).range == (0, 234)
    assert pellucid.mesh_of(grid, ["p_cell"]).range == (500, 523)
    add(grid.GetPointData(), "s", -numpy.arange(60.0), active=True)
    assert pellucid.mesh_of(grid).range == (-59, 0)


def test_active_vectors_are_told():
    grid = structured()
    vectors = numpy.stack([3 * numpy.arange(60.0), numpy.zeros(60), 4 * numpy.arange(60.0)], axis=1)
    add(grid.GetPointData(), "velocity", vectors, active=True)
    with pytest.warns(pellucid.Note, match="\"velocity\" has 3 components, whose length is shown"):
        assert pellucid.mesh_of(grid).range == (0, 5 * 59)
    assert pellucid.mesh_of(grid, ["velocity:2"]).range == (0, 4 * 59)


@pytest.mark.parametrize("name", ["a:0", "stress:12", "gmsh:physical", "p=1"])
def test_names_with_signs(name):
    grid = structured()
    add(grid.GetPointData(), "a", numpy.ones((60, 3)))
    add(grid.GetPointData(), name, numpy.arange(60.0) + 7, active=True)
    assert pellucid.mesh_of(grid).range == (7, 66)


def test_arrays_without_a_name():
    grid = structured()
    add(grid.GetPointData(), None, numpy.arange(60.0) + 7)
    add(grid.GetPointData(), None, numpy.arange(60.0) + 300, active=True)
    assert pellucid.mesh_of(grid).range == (300, 359)


def mixed():
    """A surface, a hexahedron, a line and a tetrahedron, with values of cells."""
    points = vtk.vtkPoints()
    for p in [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1),
              (0, 1, 1), (0, 0, 2)]:
        points.InsertNextPoint(p)
    grid = vtk.vtkUnstructuredGrid()
    grid.SetPoints(points)
    for kind, ids in [(9, [0, 1, 2, 3]), (12, [0, 1, 2, 3, 4, 5, 6, 7]), (3, [0, 1]),
                      (10, [4, 5, 7, 8])]:
        grid.InsertNextCell(kind, len(ids), ids)
    add(grid.GetCellData(), "c", numpy.array([100.0, 1, 200, 2]), active=True)
    return grid


def test_surfaces_and_lines_are_left_out():
    grid = mixed()
    with pytest.warns(pellucid.Note, match="2 of 4 cells are surfaces, lines or points"):
        mesh = pellucid.mesh_of(grid)
    assert mesh.range == (1, 2) and mesh.statistics["volume"] == pytest.approx(7 / 6)
    add(grid.GetCellData(), "vtkGhostType", numpy.array([0, 1, 0, 0], dtype=numpy.uint8))
    with pytest.warns(pellucid.Note, match="2 of 3"):
        mesh = pellucid.mesh_of(grid)
    assert mesh.range == (2, 2) and mesh.statistics["volume"] == pytest.approx(1 / 6)


def test_polyhedra_and_ghosts():
    grid = mixed()
    ids = vtk.vtkIdList()
    for number in (4, 3, 4, 5, 8, 3, 4, 5, 7, 3, 5, 7, 8, 3, 4, 7, 8):
        ids.InsertNextId(number)
    both = vtk.vtkUnstructuredGrid()
    both.SetPoints(grid.GetPoints())
    both.InsertNextCell(12, 8, [0, 1, 2, 3, 4, 5, 6, 7])
    both.InsertNextCell(vtk.VTK_POLYHEDRON, ids)
    add(both.GetCellData(), "c", numpy.array([1.0, 2]))
    assert volume_of(both) == pytest.approx(7 / 6)
    flags = numpy.zeros(9, dtype=numpy.uint8)
    flags[8] = 2
    add(both.GetPointData(), "vtkGhostType", flags)
    assert pellucid.mesh_of(both).range == (1, 1)


def test_orders_of_lagrange_cells():
    """A hexahedron of order 2, 1, 1 has 12 points, as none of one order has."""
    points = vtk.vtkPoints()
    for p in [(0, 0, 0), (2, 0, 0), (2, 1, 0), (0, 1, 0), (0, 0, 1), (2, 0, 1), (2, 1, 1),
              (0, 1, 1), (1, 0, 0), (1, 1, 0), (1, 0, 1), (1, 1, 1)]:
        points.InsertNextPoint(p)
    grid = vtk.vtkUnstructuredGrid()
    grid.SetPoints(points)
    grid.InsertNextCell(vtk.VTK_LAGRANGE_HEXAHEDRON, 12, list(range(12)))
    add(grid.GetPointData(), "v", numpy.arange(12.0))
    with pytest.raises(pellucid.Error, match="HIGHER_ORDER_DEGREES"):
        pellucid.mesh_of(grid)
    add(grid.GetCellData(), "HIGHER_ORDER_DEGREES", numpy.array([[2, 1, 1.0]]))
    assert volume_of(grid) == pytest.approx(2)


def test_arrays_whose_memory_is_in_another_order():
    array = vtk.vtkSOADataArrayTemplate["float64"]() if hasattr(
        vtk, "vtkSOADataArrayTemplate") else None
    if array is None:
        pytest.skip("VTK wraps no arrays of this kind")
    array.SetNumberOfComponents(1)
    array.SetNumberOfTuples(60)
    for i in range(60):
        array.SetValue(i, i + 7)
    array.SetName("soa")
    grid = structured()
    grid.GetPointData().SetScalars(array)
    assert pellucid.mesh_of(grid).range == (7, 66)


@pytest.mark.parametrize("components", [1, 3])
def test_bits(components):
    bits = vtk.vtkBitArray()
    bits.SetNumberOfComponents(components)
    for i in range(60 * components):
        bits.InsertNextValue(i % 2)
    bits.SetName("bits")
    grid = structured()
    grid.GetPointData().SetScalars(bits)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        # Vectors (0, 1, 0) and (1, 0, 1) have these lengths.
        expected = (0, 1) if components == 1 else (1, 2 ** 0.5)
        assert pellucid.mesh_of(grid).range == pytest.approx(expected)


class Association:
    def __init__(self, name):
        self.name = name


@pytest.mark.parametrize("name, expected", [("POINT", (0, 234)), ("CELL", (0, 23))])
def test_pyvista_says_which_scalars_it_means(name, expected):
    class UnstructuredGrid(vtk.vtkUnstructuredGrid):
        """As PyVista's: its own class, with the scalars of set_active_scalars()."""

        class active_scalars_info:
            association = Association(name)

        points = cells = point_data = None  # which meshes of meshio have

    grid = UnstructuredGrid()
    grid.ShallowCopy(unstructured())
    grid.GetPointData().SetActiveScalars("p")
    grid.GetCellData().SetActiveScalars("c")
    assert pellucid.mesh_of(grid).range == expected


@pytest.mark.parametrize("name, expected",
                         [("POINT", "point"), ("CELL", "cell"), ("NONE", "point")])
def test_pyvista_says_it_of_images(name, expected):
    class ImageData(vtk.vtkImageData):
        class active_scalars_info:
            association = Association(name)

    image = ImageData()
    image.SetDimensions(5, 4, 3)
    add(image.GetPointData(), "p", numpy.arange(60.0), active=True)
    add(image.GetCellData(), "c", numpy.arange(24.0), active=True)
    assert pellucid.Volume(image).centering == expected


def test_ghost_levels_are_no_data_of_images():
    image = vtk.vtkImageData()
    image.SetDimensions(5, 4, 3)
    add(image.GetPointData(), "vtkGhostLevels", numpy.zeros(60, dtype=numpy.uint8))
    add(image.GetPointData(), "p", numpy.arange(60.0))
    assert pellucid.Volume(image).statistics["maximum"] == 59


def test_what_is_no_grid_of_cells_is_refused():
    with pytest.raises(pellucid.Error, match="has no cells"):
        pellucid.mesh_of(vtk.vtkUnstructuredGrid())
    flat = vtk.vtkStructuredGrid()
    flat.SetDimensions(2, 2, 1)
    points = vtk.vtkPoints()
    for p in [(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0)]:
        points.InsertNextPoint(p)
    flat.SetPoints(points)
    with pytest.raises(pellucid.Error, match="single point"):
        pellucid.mesh_of(flat)
    blocks = vtk.vtkMultiBlockDataSet()
    blocks.SetBlock(0, unstructured())
    for other, words in [(blocks, "give one of its blocks"), (vtk.vtkPolyData(), "no volume"),
                         (vtk.vtkTable(), "expected a vtkImageData")]:
        with pytest.raises(pellucid.Error, match=words):
            pellucid.render(other)
