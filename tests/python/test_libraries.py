# SPDX-License-Identifier: Apache-2.0
"""Objects of nibabel, ITK, xarray and VTK, beside the program on their files."""
import sys
import types

import numpy
import pytest

import pellucid
from conftest import assert_same_bits, render, smooth

BRAIN = "/usr/share/mricron/templates/ch2.nii.gz"


def assert_same_place(data, path):
    """A camera that shows everything moves with the data: pictures do not tell where they are."""
    volume, expected = pellucid.Volume(data), pellucid.read(path)
    assert volume.shape == expected.shape and volume.centering == expected.centering
    assert volume.origin == expected.origin and volume.spacing == expected.spacing
    assert numpy.array_equal(volume.direction, expected.direction)


def oblique():
    """RAS, with spacings 1, 2, 3, turned about two axes."""
    c, s = numpy.cos(0.3), numpy.sin(0.3)
    turn = numpy.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]) @ numpy.array(
        [[1, 0, 0], [0, c, s], [0, -s, c]])
    affine = numpy.eye(4)
    affine[:3, :3] = turn @ numpy.diag([1, 2, 3])
    affine[:3, 3] = (-10, 20, 5)
    return affine.astype(numpy.float32)


@pytest.mark.parametrize("kind, slope", [("u1", None), ("i2", None), ("f4", None), ("i2", 0.5),
                                         ("i4", 0.1)])
def test_nibabel(program, tmp_path, kind, slope):
    nibabel = pytest.importorskip("nibabel")
    image = nibabel.Nifti1Image(numpy.ascontiguousarray(smooth(kind).T), oblique())
    path = tmp_path / "a.nii"
    nibabel.save(image, path)
    if slope is not None:  # nibabel scales what it saves itself; here the header says so
        content = bytearray(path.read_bytes())
        content[112:116] = numpy.float32(slope).tobytes()
        content[116:120] = numpy.float32(-3).tobytes()
        path.write_bytes(bytes(content))
    loaded = nibabel.load(path)
    assert_same_bits(render(loaded), program.render(path))
    assert_same_place(loaded, path)
    assert_same_bits(render(pellucid.read(path)), program.render(path))


def test_nibabel_in_memory(program, tmp_path):
    nibabel = pytest.importorskip("nibabel")
    values = numpy.asfortranarray(smooth("f4").T)
    image = nibabel.Nifti1Image(values, oblique())
    volume = pellucid.Volume(image)
    assert volume.array.__array_interface__["data"][0] == values.__array_interface__["data"][0]
    nibabel.save(image, tmp_path / "a.nii")
    assert_same_bits(render(volume), program.render(tmp_path / "a.nii"))


def test_a_brain_of_nibabel(program):
    nibabel = pytest.importorskip("nibabel")
    try:
        brain = nibabel.load(BRAIN)
    except FileNotFoundError:
        pytest.skip("the brain MRI of mricron-data is not installed")
    assert_same_bits(render(brain), program.render(BRAIN))


def test_nibabel_of_several_volumes():
    nibabel = pytest.importorskip("nibabel")
    image = nibabel.Nifti1Image(numpy.zeros((4, 5, 6, 2), dtype="f4"), numpy.eye(4))
    with pytest.raises(pellucid.Error, match="4 axes"):
        pellucid.Volume(image)


class FakeITK:
    """What SimpleITK's images offer; Debian has none."""

    def __init__(self, values):
        self.values = values

    def GetSpacing(self):
        return (0.5, 1.0, 2.0)

    def GetOrigin(self):
        return (1.0, 2.0, 3.0)

    def GetDirection(self):
        return (0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0)


def test_itk(program, tmp_path, monkeypatch):
    values = smooth("i2")
    library = types.ModuleType("fake_itk")
    library.GetArrayViewFromImage = lambda image: image.values
    monkeypatch.setitem(sys.modules, "fake_itk", library)
    monkeypatch.setattr(FakeITK, "__module__", "fake_itk")
    volume = pellucid.Volume(FakeITK(values))
    assert volume.spacing == (2, 1, 0.5) and volume.origin == (3, 2, 1)
    path = tmp_path / "a.nrrd"
    volume.write(path)
    assert_same_bits(render(volume), program.render(path))
    assert_same_place(FakeITK(values), path)
    # Index x goes along world y: column 0 of the direction, read as (x, y, z), is (0, 1, 0).
    assert numpy.array_equal(volume.direction[:, 2], (0, 1, 0))


def test_xarray(program, tmp_path):
    xarray = pytest.importorskip("xarray")
    values = smooth("f4")
    coords = {"z": 5 + 2 * numpy.arange(7), "y": -0.5 * numpy.arange(9.0)[::-1],
              "x": numpy.arange(11) * 0.25}
    data = xarray.DataArray(values, dims=("z", "y", "x"), coords=coords, name="density")
    numpy.save(tmp_path / "a.npy", values)
    expected = program.render(tmp_path / "a.npy", "--spacing", "0.25,0.5,2", "--origin", "0,-4,5")
    assert_same_bits(render(data), expected)
    volume = pellucid.Volume(data)
    assert volume.name == "density" and volume.spacing == (2, 0.5, 0.25)
    assert volume.array.__array_interface__["data"][0] == values.__array_interface__["data"][0]
    # By name, whatever the order.
    assert pellucid.Volume(data.transpose("x", "y", "z")).spacing == (2, 0.5, 0.25)
    # By order, with other names, and without coordinates.
    other = xarray.DataArray(values, dims=("lev", "lat", "lon"), coords={"lev": coords["z"]})
    assert pellucid.Volume(other).spacing == (2, 1, 1)
    descending = data.isel(y=slice(None, None, -1))
    assert pellucid.Volume(descending).direction[1, 1] == -1
    with pytest.raises(pellucid.Error, match="Dataset"):
        pellucid.Volume(data.to_dataset())


def test_xarray_masked_by_nan():
    xarray = pytest.importorskip("xarray")
    data = xarray.DataArray(smooth(), dims=("z", "y", "x"))
    assert pellucid.Volume(data.where(data < 80)).statistics["nan"] > 0


@pytest.fixture
def vtk():
    return pytest.importorskip("vtkmodules.all")


def write(writer, data, path):
    writer.SetFileName(str(path))
    writer.SetInputData(data)
    assert writer.Write() == 1
    return path


def scalars(vtk, data, values, cells=False):
    from vtkmodules.util.numpy_support import numpy_to_vtk

    array = numpy_to_vtk(values.ravel(), deep=True)
    array.SetName("v")
    (data.GetCellData() if cells else data.GetPointData()).SetScalars(array)
    return data


@pytest.mark.parametrize("cells", [False, True])
def test_vtk_images(vtk, program, tmp_path, cells):
    values = smooth("i2")
    image = vtk.vtkImageData()
    z, y, x = (side + cells for side in values.shape)
    image.SetExtent(3, 2 + x, -1, y - 2, 0, z - 1)
    image.SetSpacing(1, 2, 3)
    image.SetOrigin(4, 5, 6)
    image.SetDirectionMatrix((0, 1, 0, -1, 0, 0, 0, 0, 1))
    scalars(vtk, image, values, cells)
    path = write(vtk.vtkXMLImageDataWriter(), image, tmp_path / "a.vti")
    assert_same_bits(render(image), program.render(path))
    assert_same_place(image, path)


def test_vtk_images_are_not_copied(vtk):
    image = vtk.vtkImageData()
    image.SetDimensions(4, 5, 6)
    image.AllocateScalars(vtk.VTK_FLOAT, 1)
    memory = numpy.asarray(memoryview(image.GetPointData().GetScalars()))
    memory[...] = numpy.arange(120)
    volume = pellucid.Volume(image)
    assert volume.array.__array_interface__["data"][0] == memory.__array_interface__["data"][0]
    del image, memory
    assert volume.array[5, 4, 3] == 119


def test_vtk_rectilinear_grids(vtk, program, tmp_path):
    from vtkmodules.util.numpy_support import numpy_to_vtk

    values = smooth("f4")
    grid = vtk.vtkRectilinearGrid()
    grid.SetDimensions(*values.shape[::-1])
    for name, side in zip("XYZ", values.shape[::-1]):
        getattr(grid, f"Set{name}Coordinates")(numpy_to_vtk(numpy.arange(side) ** 1.5, deep=True))
    scalars(vtk, grid, values)
    path = write(vtk.vtkXMLRectilinearGridWriter(), grid, tmp_path / "a.vtr")
    assert_same_place(grid, path)
    assert_same_bits(render(grid), program.render(path))


def unstructured(vtk):
    """Two tetrahedra, a hexahedron, a wedge, and a triangle that has no volume."""
    points = vtk.vtkPoints()
    for p in [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 1.2), (2, 0, 0), (3, 0, 0),
              (3, 1, 0), (2, 1, 0), (2, 0, 1), (3, 0, 1), (3, 1, 1), (2, 1, 1), (2, 0.5, 2),
              (3, 0.5, 2)]:
        points.InsertNextPoint(p)
    grid = vtk.vtkUnstructuredGrid()
    grid.SetPoints(points)
    for kind, ids in [(10, [0, 1, 2, 3]), (10, [1, 2, 3, 4]),
                      (12, [5, 6, 7, 8, 9, 10, 11, 12]), (13, [9, 12, 13, 10, 11, 14])]:
        grid.InsertNextCell(kind, len(ids), ids)
    return scalars(vtk, grid, numpy.linspace(0, 1, points.GetNumberOfPoints()) ** 2)


def test_vtk_unstructured_grids(vtk, program, tmp_path):
    grid = unstructured(vtk)
    path = write(vtk.vtkXMLUnstructuredGridWriter(), grid, tmp_path / "a.vtu")
    assert_same_bits(render(grid), program.render(path))
    assert_same_bits(render(pellucid.mesh_of(grid)), program.render(path))


def test_vtk_polyhedra(vtk, program, tmp_path):
    points = vtk.vtkPoints()
    for z in (0, 1):
        for a in numpy.linspace(0, 2 * numpy.pi, 6)[:-1]:
            points.InsertNextPoint(numpy.cos(a), numpy.sin(a), z)
    faces = [[0, 1, 2, 3, 4], [5, 6, 7, 8, 9]] + [
        [i, (i + 1) % 5, 5 + (i + 1) % 5, 5 + i] for i in range(5)]
    ids = vtk.vtkIdList()
    ids.InsertNextId(len(faces))
    for face in faces:
        ids.InsertNextId(len(face))
        for point in face:
            ids.InsertNextId(point)
    grid = vtk.vtkUnstructuredGrid()
    grid.SetPoints(points)
    grid.InsertNextCell(vtk.VTK_POLYHEDRON, ids)
    scalars(vtk, grid, numpy.arange(10.0))
    path = write(vtk.vtkXMLUnstructuredGridWriter(), grid, tmp_path / "a.vtu")
    assert_same_bits(render(grid), program.render(path))


def test_vtk_structured_grids(vtk, program, tmp_path):
    z, y, x = numpy.meshgrid(range(4), range(5), range(6), indexing="ij")
    points = vtk.vtkPoints()
    for p in zip((x + 0.1 * y).ravel(), (y + 0.05 * x * z).ravel(), z.ravel()):
        points.InsertNextPoint(p)
    grid = vtk.vtkStructuredGrid()
    grid.SetDimensions(6, 5, 4)
    grid.SetPoints(points)
    scalars(vtk, grid, smooth("f8", (4, 5, 6)))
    path = write(vtk.vtkXMLStructuredGridWriter(), grid, tmp_path / "a.vts")
    assert_same_bits(render(grid), program.render(path))


def test_what_vtk_has_and_we_do_not(vtk):
    with pytest.raises(pellucid.Error, match="vtkPolyData"):
        pellucid.Volume(vtk.vtkPolyData())
    with pytest.raises(pellucid.Error, match="has no values"):
        pellucid.Volume(vtk.vtkImageData())
    with pytest.raises(pellucid.Error, match="Update"):
        pellucid.mesh_of(vtk.vtkUnstructuredGrid())
    colors = vtk.vtkImageData()
    colors.SetDimensions(2, 2, 2)
    colors.AllocateScalars(vtk.VTK_UNSIGNED_CHAR, 3)
    with pytest.raises(pellucid.Error, match="3 components"):
        pellucid.Volume(colors)


def test_matplotlib_colormaps():
    pytest.importorskip("matplotlib")
    import matplotlib

    by_name = pellucid.from_colormap("viridis", (0, 100), 0.3)
    by_object = pellucid.from_colormap(matplotlib.colormaps["viridis"], (0, 100), 0.3)
    assert by_name.points == by_object.points and len(by_name.points) == 256
    value, extinction, color = by_name.points[0]
    assert (value, extinction) == (0, 0.3)
    expected = pellucid.srgb_to_linear(numpy.array(matplotlib.colormaps["viridis"](0.0)[:3]))
    assert numpy.allclose(color, expected, atol=0)
    with pytest.raises(pellucid.Error, match="did you mean viridis"):
        pellucid.from_colormap("veridis", (0, 1), 1)


def test_colormaps_of_ones_own():
    function = pellucid.from_colormap(["#000000", "#ffffff"], (0, 1), [(0, 0), (0.3, 2), (1, 0)], 3)
    values = [value for value, _, _ in function.points]
    assert values == [0, 0.3, 0.5, 1]
    assert function.points[1][1] == 2 and numpy.allclose(function.points[1][2], 0.3)
    with pytest.raises(pellucid.Error, match="ascending"):
        pellucid.from_colormap(["#000000"], (1, 0), 1)


def test_nothing_heavy_is_imported():
    import subprocess

    code = ("import sys, pellucid; heavy = {'matplotlib', 'vtk', 'vtkmodules', 'nibabel', 'xarray',"
            " 'pandas', 'scipy'} & set(sys.modules); assert not heavy, heavy")
    subprocess.run([sys.executable, "-c", code], check=True)
