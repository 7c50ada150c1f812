# SPDX-License-Identifier: Apache-2.0
"""Scenes of live VTK renderers, and audits of VTK's pictures. Run under xvfb-run."""
import os

import numpy
import pytest

import pellucid
import pellucid.vtk
from conftest import smooth

if "DISPLAY" not in os.environ:
    pytest.skip("VTK needs a display: run under xvfb-run (Debian: xvfb)", allow_module_level=True)
vtk = pytest.importorskip("vtkmodules.all")

WINDOWS = []  # a display whose last window closes may end


def image_of(values, spacing=(1, 1, 1), origin=(0, 0, 0)):
    image = vtk.vtkImageData()
    image.SetDimensions(*values.shape[::-1])
    image.SetSpacing(*spacing)
    image.SetOrigin(*origin)
    image.AllocateScalars(vtk.VTK_FLOAT, 1)
    memory = numpy.asarray(memoryview(image.GetPointData().GetScalars()))
    memory[...] = values.ravel()
    return image


def look(opacities=((0, 0), (50, 0.02), (100, 0.2)),
         colors=((0, 0, 0, 1), (60, 1, 0.5, 0), (100, 1, 1, 1)), unit=1.0):
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
    made.ShadeOff()
    return made


class Stage:
    """A renderer in a window, with one volume. Its step is a tenth of a voxel."""

    def __init__(self, data, size=(96, 64), **looks):
        self.mapper = vtk.vtkOpenGLGPUVolumeRayCastMapper()
        self.mapper.SetInputData(data)
        self.mapper.AutoAdjustSampleDistancesOff()
        self.mapper.SetSampleDistance(0.1)
        self.mapper.UseJitteringOff()
        self.volume = vtk.vtkVolume()
        self.volume.SetMapper(self.mapper)
        self.volume.SetProperty(look(**looks))
        self.renderer = vtk.vtkRenderer()
        self.renderer.AddVolume(self.volume)
        self.renderer.SetBackground(0.3, 0.2, 0.1)
        self.window = vtk.vtkRenderWindow()
        WINDOWS.append(self.window)
        self.window.SetOffScreenRendering(1)
        self.window.SetMultiSamples(0)
        self.window.SetSize(*size)
        self.window.AddRenderer(self.renderer)
        self.renderer.ResetCamera()
        self.camera = self.renderer.GetActiveCamera()
        self.camera.Azimuth(30)
        self.camera.Elevation(20)
        self.renderer.ResetCameraClippingRange()


def ball(n=24):
    return smooth(shape=(n, n, n))


@pytest.fixture
def stage():
    return Stage(image_of(ball(), spacing=(1, 1.5, 2), origin=(3, -2, 1)))


def close(audit, largest, rms):
    """VTK at small steps and we see the same: conventions agree."""
    assert audit.largest < largest and audit.rms < rms, str(audit)
    assert audit.ours.rgba[..., 3].max() > 0.3


def test_perspective(stage):
    audit = pellucid.vtk.audit(stage.window)
    close(audit, 6e-3, 1e-3)
    assert audit.ours.width == 96 and audit.ours.height == 64
    assert "largest difference" in str(audit)
    assert audit.picture(10).rgba.max() <= 1 and audit.picture().rgba.shape == (64, 96, 4)
    assert audit.scene.integration.tolerance == 1 / 4096


def test_parallel(stage):
    stage.camera.ParallelProjectionOn()
    stage.renderer.ResetCameraClippingRange()
    close(pellucid.vtk.audit(stage.window), 6e-3, 1e-3)


def test_horizontal_angles(stage):
    stage.camera.UseHorizontalViewAngleOn()
    stage.renderer.ResetCameraClippingRange()
    close(pellucid.vtk.audit(stage.window), 6e-3, 1e-3)


def test_a_coarse_step_is_found_out(stage):
    peak = ((0, 0), (58, 0), (60, 0.9), (62, 0), (100, 0))
    stage.volume.SetProperty(look(opacities=peak))
    stage.mapper.SetSampleDistance(2)
    audit = pellucid.vtk.audit(stage.window)
    assert audit.largest > 0.1 and audit.share_over_255 > 0.05


def test_a_moved_volume_with_a_unit_distance(stage):
    stage.volume.SetPosition(5, 6, 7)
    stage.volume.RotateZ(30)
    stage.volume.SetProperty(look(unit=2.5))
    stage.renderer.ResetCamera()
    close(pellucid.vtk.audit(stage.window), 6e-3, 1e-3)


def test_clipping_planes(stage):
    plane = vtk.vtkPlane()
    plane.SetOrigin(*stage.volume.GetCenter())
    plane.SetNormal(1, 0.3, 0.1)
    stage.mapper.AddClippingPlane(plane)
    scene = pellucid.vtk.scene_of(stage.renderer)
    assert len(scene.layers[0].clips) == 1
    audit = pellucid.vtk.audit(stage.window)
    # VTK begins to sample a part of a step behind the plane.
    close(audit, 3e-2, 4e-3)
    full = Stage(image_of(ball(), spacing=(1, 1.5, 2), origin=(3, -2, 1)))
    assert audit.ours.compare(pellucid.vtk.audit(full.window).ours).largest > 0.1


def test_cropping(stage):
    """VTK 9.1's GPU mapper takes the planes for places between the outer faces of the voxels, but
    they are places between the outermost values: it crops up to half a voxel too far outside."""
    bounds, n = stage.volume.GetBounds(), 24
    wanted = numpy.add(bounds, (4, -8, 4, 0, 0, -10))
    low, length = numpy.repeat(bounds[::2], 2), numpy.repeat(numpy.subtract(bounds[1::2],
                                                                            bounds[::2]), 2)
    stage.mapper.CroppingOn()
    stage.mapper.SetCroppingRegionFlagsToSubVolume()
    stage.mapper.SetCroppingRegionPlanes(*wanted)
    audit = pellucid.vtk.audit(stage.window)
    assert 0.05 < audit.largest and "half a voxel" in str(audit)
    clips = audit.scene.layers[0].clips
    assert [clip.point[i // 2] for i, clip in enumerate(clips)] == pytest.approx(wanted)
    # With planes that it moves to the wanted places the pictures agree.
    stage.mapper.SetCroppingRegionPlanes(
        *(low + length * ((wanted - low) / length * (n - 1) / n + 0.5 / n)))
    assert audit.ours.compare(pellucid.vtk.audit(stage.window).theirs).rms < 2e-3
    # A few boxes together cover the regions, with one layer each.
    stage.mapper.SetCroppingRegionFlagsToFence()
    assert len(pellucid.vtk.scene_of(stage.renderer, []).layers) == 7


def test_light(stage):
    stage.volume.GetProperty().ShadeOn()
    stage.volume.GetProperty().SetAmbient(0.3)
    stage.volume.GetProperty().SetDiffuse(0.6)
    stage.volume.GetProperty().SetSpecular(0)
    scene = pellucid.vtk.scene_of(stage.renderer)
    assert scene.layers[0].shading.ambient == 0.3 and scene.layers[0].shading.flatness == 0
    close(pellucid.vtk.audit(stage.window), 0.03, 2e-3)


def test_highlights(stage):
    """VTK's are Phong's since 9.2, next to which Blinn's of four times the power are as wide."""
    look = stage.volume.GetProperty()
    look.ShadeOn()
    look.SetAmbient(0.1)
    look.SetDiffuse(0.2)
    look.SetSpecular(0.6)
    look.SetSpecularPower(8)
    audit = pellucid.vtk.audit(stage.window)
    close(audit, 0.06, 4e-3)
    shading = audit.scene.layers[0].shading
    shading.power = 8 if shading.power == 32 else 32
    assert pellucid.render(audit.scene).compare(audit.theirs).rms > 3 * audit.rms


def test_the_head_light_of_parallel_rays(stage):
    """VTK's mapper has it at the position of the camera, near which rays enter the data."""
    stage.camera.ParallelProjectionOn()
    stage.camera.SetPosition(*(numpy.array(stage.camera.GetFocalPoint()) + (60, 0, 0)))
    stage.renderer.ResetCameraClippingRange()
    stage.volume.GetProperty().ShadeOn()
    notes = []
    (light,) = pellucid.vtk.scene_of(stage.renderer, notes).lights
    assert tuple(light.position) == stage.camera.GetPosition() and "head light" in notes[-1]
    audit = pellucid.vtk.audit(stage.window)
    close(audit, 0.1, 0.01)
    audit.scene.lights = [pellucid.HeadLight()]
    assert pellucid.render(audit.scene).compare(audit.theirs).rms > 2 * audit.rms


def test_a_head_light_beside_another(stage):
    head, other = vtk.vtkLight(), vtk.vtkLight()
    head.SetLightTypeToHeadlight()
    head.SetIntensity(0.5)
    other.SetLightTypeToSceneLight()
    other.SetPosition(30, 0, 0)
    other.SetFocalPoint(0, 0, 0)
    for light in (head, other):
        stage.renderer.AddLight(light)
    lights = pellucid.vtk.scene_of(stage.renderer).lights
    assert [type(each) for each in lights] == [pellucid.DirectionalLight] * 2
    assert tuple(lights[0].direction) == stage.camera.GetDirectionOfProjection()


def test_lights_of_ones_own(stage):
    light = vtk.vtkLight()
    light.SetLightTypeToSceneLight()
    light.SetPosition(10, 0, 0)
    light.SetFocalPoint(0, 0, 0)
    light.SetIntensity(0.5)
    stage.renderer.AddLight(light)
    (made,) = pellucid.vtk.scene_of(stage.renderer).lights
    assert isinstance(made, pellucid.DirectionalLight) and tuple(made.direction) == (-10, 0, 0)
    assert made.color == (0.5, 0.5, 0.5)
    light.PositionalOn()
    light.SetConeAngle(90)
    (made,) = pellucid.vtk.scene_of(stage.renderer).lights
    assert isinstance(made, pellucid.PointLight)
    light.SwitchOff()
    assert pellucid.vtk.scene_of(stage.renderer).lights == [pellucid.HeadLight()]


def test_curved_functions(stage):
    made = look()
    opacity = made.GetScalarOpacity()
    opacity.RemoveAllPoints()
    opacity.AddPoint(0, 0, 0.3, 0.6)
    opacity.AddPoint(100, 0.2)
    made.GetRGBTransferFunction().SetColorSpaceToHSV()
    stage.volume.SetProperty(made)
    # VTK holds the function at 1024 values.
    close(pellucid.vtk.audit(stage.window), 2e-2, 2e-3)


def test_functions_that_end(stage):
    made = look(opacities=((20, 0.1), (80, 0.1)))
    made.GetScalarOpacity().ClampingOff()
    stage.volume.SetProperty(made)
    table = pellucid.vtk.scene_of(stage.renderer).layers[0].transfer_function
    at_20 = [opacity for value, opacity, _ in table.points if value == 20]
    assert at_20 == [0, 0.1]


def test_other_props_and_the_background_do_not_count(stage):
    source = vtk.vtkCubeSource()
    source.SetCenter(10, 10, 10)
    source.SetXLength(20)
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputConnection(source.GetOutputPort())
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    stage.renderer.AddActor(actor)
    audit = pellucid.vtk.audit(stage.window)
    close(audit, 6e-3, 1e-3)
    assert actor.GetVisibility() == 1 and stage.renderer.GetBackground() == (0.3, 0.2, 0.1)
    actor.SetVisibility(False)
    assert not pellucid.vtk.audit(stage.window).notes


def test_plotters_have_windows_and_renderers(stage):
    class Plotter:  # what PyVista's offer; Debian has none
        render_window, renderer = stage.window, stage.renderer

    close(pellucid.vtk.audit(Plotter()), 6e-3, 1e-3)
    assert len(pellucid.vtk.scene_of(Plotter()).layers) == 1


def clipped_scene(data, along_x, cells):
    """The scene of a grid of which a plane shows what lies beyond a place."""
    stage = Stage(data)
    if cells:
        stage.mapper.SetScalarModeToUseCellData()
    stage.volume.RotateZ(20)
    stage.volume.SetScale(1.25)
    if along_x is not None:
        plane, matrix = vtk.vtkPlane(), stage.volume.GetMatrix()
        plane.SetOrigin(*matrix.MultiplyPoint((along_x, 0, 0, 1))[:3])
        plane.SetNormal(*matrix.MultiplyPoint((1, 0, 0, 0))[:3])
        stage.mapper.AddClippingPlane(plane)
    stage.camera.SetPosition(60, 40, 50)
    stage.camera.SetFocalPoint(10, 20, 20)
    stage.renderer.ResetCameraClippingRange()
    return pellucid.vtk.scene_of(stage.renderer)


@pytest.mark.parametrize("cells", [False, True])
@pytest.mark.parametrize("kind", ["points", "cells", "duplicates"])
def test_hidden_places_and_ghosts(kind, cells):
    """Everything up to the sixth cell along x is marked."""
    values = numpy.random.default_rng(5).uniform(20, 100, (12, 12, 12)).astype(numpy.float32)
    whole, marked = vtk.vtkUniformGrid(), vtk.vtkUniformGrid()
    for grid in (whole, marked):
        grid.SetDimensions(*(side + cells for side in values.shape[::-1]))
        grid.SetOrigin(3, -2, 1)
        array = vtk.vtkFloatArray()
        array.SetNumberOfTuples(values.size)
        numpy.asarray(memoryview(array))[...] = values.ravel()
        (grid.GetCellData() if cells else grid.GetPointData()).SetScalars(array)
    across = marked.GetDimensions()[0] - (kind != "points")
    count = marked.GetNumberOfPoints() if kind == "points" else marked.GetNumberOfCells()
    if kind == "duplicates":
        marked.AllocateCellGhostArray()
    for i in range(count):
        if i % across > 5:
            continue
        if kind == "points":
            marked.BlankPoint(i)
        elif kind == "cells":
            marked.BlankCell(i)
        else:
            marked.GetCellGhostArray().SetValue(i, 1)
    # What is hidden has no values to interpolate with: of cells that ends half a cell later.
    left = 3 + (6.5 if cells and kind != "duplicates" else 6)
    expected = pellucid.render(clipped_scene(whole, left, cells), tolerance=1e-4)
    got = pellucid.render(clipped_scene(marked, None, cells), tolerance=1e-4)
    assert got.compare(expected).largest < 2e-4
    full = pellucid.render(clipped_scene(whole, None, cells), tolerance=1e-4)
    assert full.compare(expected).largest > 0.05


def test_marks_that_have_no_counterpart():
    grid = vtk.vtkUniformGrid()
    grid.DeepCopy(image_of(ball()))
    grid.BlankCell(6000)
    with pytest.raises(pellucid.Error, match="hides cells between others"):
        pellucid.vtk.scene_of(Stage(grid).renderer)
    grid.GetCellGhostArray().Fill(0)
    grid.GetCellGhostArray().SetValue(6000, 1)
    with pytest.raises(pellucid.Error, match="do not fill a box"):
        pellucid.vtk.scene_of(Stage(grid).renderer)
    grid.GetCellGhostArray().Fill(1)
    with pytest.raises(pellucid.Error, match="show nothing"):
        pellucid.vtk.scene_of(Stage(grid).renderer)


def test_what_has_no_counterpart(stage):
    for change, words in [
            (lambda s: s.mapper.SetBlendModeToAdditive(), "blends"),
            (lambda s: s.camera.SetWindowCenter(0.5, 0), "WindowCenter")]:
        other = Stage(image_of(ball()))
        change(other)
        with pytest.raises(pellucid.Error, match=words):
            pellucid.vtk.scene_of(other.renderer)
    with pytest.raises(pellucid.Error, match="no vtkVolume"):
        pellucid.vtk.scene_of(vtk.vtkRenderer())
    with pytest.raises(pellucid.Error, match="expected a vtkRenderer"):
        pellucid.vtk.scene_of(7)
    with pytest.raises(pellucid.Error, match="expected a vtkRenderWindow"):
        pellucid.vtk.audit(stage.renderer)


def dependent(kind, values):
    """A stage of dependent components: an array (z, y, x, component)."""
    image = vtk.vtkImageData()
    image.SetDimensions(*values.shape[2::-1])
    image.AllocateScalars(kind, values.shape[-1])
    memory = numpy.asarray(memoryview(image.GetPointData().GetScalars()))
    memory.reshape(values.shape)[...] = values
    stage = Stage(image)
    stage.volume.GetProperty().IndependentComponentsOff()
    return stage


def test_dependent_components_are_those_of_vtk():
    shift = numpy.roll(ball(), 5, axis=2)
    close(pellucid.vtk.audit(dependent(vtk.VTK_FLOAT, numpy.stack([shift, ball()], -1)).window),
          1e-2, 2e-3)
    colors = [numpy.clip(each, 0, 255).astype(int) for each in (2 * shift, 200 - 2 * shift,
                                                               0 * shift + 90, ball())]
    # VTK 9.1 finds opacities right if their component spans 0 to 255.
    colors[3][0, 0, 0] = 255
    stage = dependent(vtk.VTK_UNSIGNED_CHAR, numpy.stack(colors, -1))
    audit = pellucid.vtk.audit(stage.window)
    close(audit, 1e-2, 2e-3)
    function = audit.scene.layers[0].transfer_function
    assert function.channels == ["0", "1", "2", "3"] and function.factor[0] == "3"
    with pytest.raises(pellucid.Error, match="2 or 4"):
        pellucid.vtk.scene_of(dependent(vtk.VTK_UNSIGNED_CHAR,
                                        numpy.stack(colors[:3], -1)).renderer)


def test_nearest_values_are_those_of_vtk():
    stage = Stage(image_of(ball(8)))
    stage.volume.GetProperty().SetInterpolationTypeToNearest()
    audit = pellucid.vtk.audit(stage.window)
    assert isinstance(audit.scene.layers[0].data, pellucid.LabelVolume)
    # VTK steps across faces.
    close(audit, 3e-2, 5e-3)
    stage.volume.GetProperty().ShadeOn()
    notes = []
    scene = pellucid.vtk.scene_of(stage.renderer, notes)
    assert isinstance(scene.layers[0].data, pellucid.Volume)
    assert any("trilinear" in note for note in notes)


def test_the_final_color_in_an_audit(stage):
    stage.mapper.SetFinalColorWindow(0.7)
    stage.mapper.SetFinalColorLevel(0.4)
    audit = pellucid.vtk.audit(stage.window)
    assert audit.largest < 1e-2 and any("window" in note for note in audit.notes)


def test_importing_it_imports_no_vtk():
    import subprocess
    import sys

    code = "import sys, pellucid.vtk; assert not {'vtk', 'vtkmodules'} & set(sys.modules)"
    subprocess.run([sys.executable, "-c", code], check=True)
