# SPDX-License-Identifier: Apache-2.0
"""What mappers, cameras and data of VTK say of a picture, in scene_of(). Run under xvfb-run."""
import os

import numpy
import pytest

import pellucid
import pellucid.vtk
from conftest import smooth

if "DISPLAY" not in os.environ:
    pytest.skip("VTK needs a display: run under xvfb-run (Debian: xvfb)", allow_module_level=True)
vtk = pytest.importorskip("vtkmodules.all")
from test_vtk import Stage, image_of, look  # noqa: E402


def ball(n=16):
    return smooth(shape=(n, n, n))


def rendered(stage):
    return pellucid.render(pellucid.vtk.scene_of(stage.renderer, []), tolerance=1e-4)


def named(values, name, kind=vtk.vtkFloatArray):
    array = kind()
    array.SetName(name)
    array.SetNumberOfTuples(values.size)
    numpy.asarray(memoryview(array))[...] = values.ravel()
    return array


def choices():
    yield "name", lambda m: (m.SetScalarModeToUsePointFieldData(), m.SelectScalarArray("other"))
    yield "number", lambda m: (m.SetScalarModeToUsePointFieldData(), m.SelectScalarArray(1))
    yield "cells", lambda m: m.SetScalarModeToUseCellData()
    yield "cell name", lambda m: (m.SetScalarModeToUseCellFieldData(),
                                  m.SelectScalarArray("inside"))


@pytest.mark.parametrize("kind", [name for name, _ in choices()])
def test_the_mapper_chooses_the_array(kind):
    image, other = image_of(ball()), numpy.ascontiguousarray(ball()[::-1, :, ::-1])
    inside = numpy.ascontiguousarray(ball(15)[:, ::-1])
    image.GetPointData().AddArray(named(other, "other"))
    image.GetCellData().AddArray(named(ball(15), "more"))
    image.GetCellData().SetScalars(named(inside, "inside"))
    stage = Stage(image)
    first = rendered(stage)
    dict(choices())[kind](stage.mapper)
    alone = image_of(other)
    if "cell" in kind:
        alone.GetPointData().Initialize()
        alone.GetCellData().SetScalars(named(inside, "inside"))
    expected = rendered(Stage(alone))
    got = rendered(stage)
    assert got.compare(expected).largest < 2e-4 < 0.02 < got.compare(first).largest
    assert pellucid.vtk.audit(stage.window).largest < 0.02


def test_an_array_that_is_not_there():
    stage = Stage(image_of(ball()))
    stage.mapper.SetScalarModeToUsePointFieldData()
    stage.mapper.SelectScalarArray("nothing")
    with pytest.raises(pellucid.Error, match="has no values to show"):
        pellucid.vtk.scene_of(stage.renderer)


def mesh_stage(change=None):
    source = vtk.vtkCellTypeSource()
    source.SetCellType(10)
    source.SetBlocksDimensions(5, 5, 5)
    source.Update()
    grid = source.GetOutput()
    points = numpy.array([grid.GetPoint(i) for i in range(grid.GetNumberOfPoints())])
    grid.GetPointData().SetScalars(named(20 * points[:, 0], "along:x"))
    grid.GetPointData().AddArray(named(20 * points[:, 1], "y"))
    stage = Stage(image_of(ball()))
    stage.mapper = vtk.vtkUnstructuredGridVolumeRayCastMapper()
    stage.mapper.SetInputData(grid)
    stage.volume.SetMapper(stage.mapper)
    if change:
        change(stage.mapper)
    stage.renderer.ResetCamera()
    return stage


def test_the_array_of_a_mesh():
    def select(mapper):
        mapper.SetScalarModeToUsePointFieldData()
        mapper.SelectScalarArray("y")

    assert rendered(mesh_stage(select)).compare(rendered(mesh_stage())).largest > 0.02


def test_what_functions_of_a_mesh_are_off_by_is_counted():
    stage = mesh_stage()
    function = stage.volume.GetProperty().GetRGBTransferFunction()
    assert pellucid.vtk.scene_of(stage.renderer, []).layers[0].transfer_function.color_error == 0
    function.SetColorSpaceToLab()
    stage.volume.GetProperty().GetScalarOpacity().AddPoint(0, 0.05, 0.3, 0.4)
    made = pellucid.vtk.scene_of(stage.renderer, []).layers[0].transfer_function
    assert 0 < made.color_error < 2e-5 and 0 < made.relative_error < 2e-5


@pytest.mark.parametrize("parallel", [False, True])
def test_the_clipping_range_of_the_camera(parallel):
    stage = Stage(image_of(ball()))
    stage.camera.SetParallelProjection(parallel)
    near, far = stage.camera.GetClippingRange()
    full = rendered(stage)
    assert not pellucid.vtk.scene_of(stage.renderer, []).clips
    middle = numpy.dot(numpy.subtract(stage.volume.GetCenter(), stage.camera.GetPosition()),
                       stage.camera.GetDirectionOfProjection())
    for wanted in ((middle - 2, far), (near, middle + 1), (middle - 3, middle + 2)):
        stage.camera.SetClippingRange(*wanted)
        audit = pellucid.vtk.audit(stage.window)
        assert audit.largest < 0.02 < audit.ours.compare(full).largest


def test_all_volumes_of_a_multi_volume():
    mapper, several = vtk.vtkGPUVolumeRayCastMapper(), vtk.vtkMultiVolume()
    several.SetMapper(mapper)
    parts, alone = [], Stage(image_of(ball()))
    alone.renderer.RemoveVolume(alone.volume)
    for port, shift in ((0, 0), (2, 20), (3, 41)):
        mapper.SetInputDataObject(port, image_of(ball()))
        part, single = vtk.vtkVolume(), vtk.vtkVolume()
        single.SetMapper(vtk.vtkGPUVolumeRayCastMapper())
        single.GetMapper().SetInputData(image_of(ball()))
        for one in (part, single):
            one.SetProperty(look(unit=1 + port))
            one.SetPosition(shift, 0, 0)
        several.SetVolume(part, port)
        alone.renderer.AddVolume(single)
        parts.append(part)
    stage = Stage(image_of(ball()))
    stage.renderer.RemoveVolume(stage.volume)
    stage.renderer.AddVolume(several)
    for each in (stage, alone):
        each.renderer.ResetCamera()
        each.camera.SetPosition(20, 10, 120)
        each.camera.SetFocalPoint(25, 8, 8)
        each.renderer.ResetCameraClippingRange()
    notes = []
    assert len(pellucid.vtk.scene_of(stage.renderer, notes).layers) == 3 and "mix" in notes[0]
    assert rendered(stage).compare(rendered(alone)).largest < 3e-4


def test_descending_rectilinear_grids():
    values = numpy.random.default_rng(3).uniform(0, 100, (6, 7, 8)).astype(numpy.float32)
    axes = [numpy.cumsum(numpy.arange(1.0, n + 1)) for n in values.shape[::-1]]
    for backwards in ((0,), (1, 2), (0, 1, 2)):
        pictures = []
        for turned in (False, True):
            grid, array = vtk.vtkRectilinearGrid(), values
            grid.SetDimensions(*values.shape[::-1])
            for axis, name in enumerate("XYZ"):
                places = axes[axis]
                if turned and axis in backwards:
                    places, array = places[::-1], numpy.flip(array, 2 - axis)
                getattr(grid, f"Set{name}Coordinates")(
                    named(numpy.ascontiguousarray(places), name, vtk.vtkDoubleArray))
            grid.GetPointData().SetScalars(named(numpy.ascontiguousarray(array), "v"))
            pictures.append(rendered(Stage(grid)))
        assert pictures[0].compare(pictures[1]).largest < 2e-4, backwards
        assert pictures[0].rgba.max() > 0.2


@pytest.mark.parametrize("kind", ["vtkCharArray", "vtkSignedCharArray"])
def test_bytes_with_a_sign(kind):
    """vtk.util.numpy_support of 9.1 makes the first of numpy's int8, that of 9.3 the second."""
    from vtkmodules.util.numpy_support import numpy_to_vtk

    values = (ball() - 60).round().astype(numpy.int8)
    assert values.min() < 0
    image = image_of(values.astype(numpy.float32))
    expected = rendered(Stage(image, opacities=((-60, 0), (40, 0.2)),
                              colors=((-60, 0, 0, 1), (40, 1, 1, 0))))
    array = numpy_to_vtk(values.ravel(), deep=True)
    if kind == "vtkSignedCharArray":
        made = vtk.vtkSignedCharArray()
        made.SetNumberOfTuples(values.size)
        numpy.asarray(memoryview(made))[...] = values.ravel()
        array = made
    assert array.GetClassName() in (kind, "vtkTypeInt8Array")
    image.GetPointData().SetScalars(array)
    stage = Stage(image, opacities=((-60, 0), (40, 0.2)), colors=((-60, 0, 0, 1), (40, 1, 1, 0)))
    assert rendered(stage).compare(expected).largest < 2e-4


def test_independent_components_are_layers():
    image = vtk.vtkImageData()
    image.SetDimensions(16, 16, 16)
    image.AllocateScalars(vtk.VTK_FLOAT, 2)
    memory = numpy.asarray(memoryview(image.GetPointData().GetScalars())).reshape(-1, 2)
    memory[:, 0], memory[:, 1] = ball().ravel(), 100 - ball().ravel()
    stage = Stage(image)
    made = look()
    made.SetScalarOpacity(1, made.GetScalarOpacity(0))
    made.SetColor(1, made.GetRGBTransferFunction(0))
    made.SetComponentWeight(1, 0.5)
    stage.volume.SetProperty(made)
    layers = pellucid.vtk.scene_of(stage.renderer, []).layers
    assert [layer.transfer_function.unit_distance for layer in layers] == [1, 2]
    made.SetComponentWeight(0, 0)
    assert len(pellucid.vtk.scene_of(stage.renderer, []).layers) == 1


def changes():
    yield "mask", "labels are whole numbers", lambda s: s.mapper.SetMaskInput(image_of(ball()))
    yield "2D", "two variables", lambda s: (
        s.volume.GetProperty().SetTransferFunctionMode(1))
    yield "stereo", "two eyes", lambda s: s.window.StereoRenderOn()
    yield "off axis", "off-axis", lambda s: s.camera.UseOffAxisProjectionOn()
    yield "peeling", "peels", lambda s: (s.renderer.UseDepthPeelingOn(),
                                         s.renderer.UseDepthPeelingForVolumesOn())
    yield "tiles", "tile", lambda s: s.window.SetTileScale(2, 2)


@pytest.mark.parametrize("kind", [name for name, _, _ in changes()])
def test_what_is_refused(kind):
    for name, words, change in changes():
        if name != kind:
            continue
        stage = Stage(image_of(ball()))
        change(stage)
        with pytest.raises(pellucid.Error, match=words):
            pellucid.vtk.scene_of(stage.renderer)


def test_empty_functions_of_the_fixed_point_mapper_are_empty():
    stage = Stage(image_of(ball()))
    stage.mapper = vtk.vtkFixedPointVolumeRayCastMapper()
    stage.mapper.SetInputData(image_of(ball()))
    stage.volume.SetMapper(stage.mapper)
    stage.volume.GetProperty().SetScalarOpacity(vtk.vtkPiecewiseFunction())
    assert rendered(stage).rgba.max() == 0


@pytest.mark.parametrize("mode", ["magnitude", "component"])
def test_the_vector_mode_of_the_smart_mapper(mode):
    vectors = numpy.stack([ball(), 100 - ball(), numpy.roll(ball(), 3, axis=1)], -1)
    shown = numpy.linalg.norm(vectors, axis=-1) if mode == "magnitude" else vectors[..., 2]
    image = image_of(ball())
    array = vtk.vtkFloatArray()
    array.SetName("vectors")
    array.SetNumberOfComponents(3)
    array.SetNumberOfTuples(ball().size)
    numpy.asarray(memoryview(array))[...] = vectors.reshape(-1, 3)
    image.GetPointData().SetScalars(array)
    stage = Stage(image)
    stage.mapper = vtk.vtkSmartVolumeMapper()
    stage.mapper.SetInputData(image)
    stage.volume.SetMapper(stage.mapper)
    if mode == "magnitude":
        stage.mapper.SetVectorMode(0)
    else:
        stage.mapper.SetVectorMode(1)
        stage.mapper.SetVectorComponent(2)
        for component in range(3):
            stage.volume.GetProperty().SetScalarOpacity(component,
                                                        look().GetScalarOpacity())
            stage.volume.GetProperty().SetColor(component, look().GetRGBTransferFunction())
    expected = rendered(Stage(image_of(shown.astype(numpy.float32))))
    assert rendered(stage).compare(expected).largest < 2e-4
    assert pellucid.vtk.audit(stage.window).largest < 0.02


def test_data_of_several_blocks():
    blocks = vtk.vtkMultiBlockDataSet()
    blocks.SetBlock(0, image_of(ball()))
    stage = Stage(image_of(ball()))
    stage.mapper = vtk.vtkMultiBlockVolumeMapper()
    stage.mapper.SetInputDataObject(blocks)
    stage.volume.SetMapper(stage.mapper)
    with pytest.raises(pellucid.Error, match="give each block a volume"):
        pellucid.vtk.scene_of(stage.renderer)
