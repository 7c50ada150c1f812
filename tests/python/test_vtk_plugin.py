# SPDX-License-Identifier: Apache-2.0
"""The plug-in for VTK from Python, and its translation of scenes beside scene_of(). Under Xvfb."""
import math
import os
import subprocess
import sys

import numpy
import pytest

import pellucid
import pellucid.vtk
from conftest import smooth

if "DISPLAY" not in os.environ:
    pytest.skip("VTK needs a display: run under xvfb-run (Debian: xvfb)", allow_module_level=True)
vtk = pytest.importorskip("vtkmodules.all")
plugin = pytest.importorskip("pellucid.vtkPellucid",
                             reason="the plug-in for VTK is not built for this Python")

WINDOWS = []  # a display whose last window closes may end
HALF_A_STEP = 0.5 / 255
ROUNDING = 1 / 32767  # of the 15 bits that the display takes


def image_of(values, spacing=(1, 1.5, 2), origin=(3, -2, 1)):
    image = vtk.vtkImageData()
    image.SetDimensions(*values.shape[::-1])
    image.SetSpacing(*spacing)
    image.SetOrigin(*origin)
    image.AllocateScalars(vtk.VTK_FLOAT, 1)
    numpy.asarray(memoryview(image.GetPointData().GetScalars()))[...] = values.ravel()
    return image


def soft(unit=1.0):
    made, opacity, color = (vtk.vtkVolumeProperty(), vtk.vtkPiecewiseFunction(),
                            vtk.vtkColorTransferFunction())
    for point in ((0, 0), (50, 0.02), (100, 0.2)):
        opacity.AddPoint(*point)
    for point in ((0, 0, 0, 1), (60, 1, 0.5, 0), (100, 1, 1, 1)):
        color.AddRGBPoint(*point)
    made.SetScalarOpacity(opacity)
    made.SetColor(color)
    made.SetScalarOpacityUnitDistance(unit)
    made.SetInterpolationTypeToLinear()
    made.ShadeOff()
    return made


def hexahedra():
    """An image as an unstructured grid."""
    threshold = vtk.vtkThreshold()
    threshold.SetInputData(image_of(smooth(shape=(9, 9, 9))))
    threshold.SetLowerThreshold(-1e9)
    threshold.SetUpperThreshold(1e9)
    threshold.Update()
    return threshold.GetOutput()


class Stage:
    def __init__(self, mapper, data=None, size=(96, 64)):
        self.mapper = mapper
        self.mapper.SetInputData(image_of(smooth(shape=(24, 24, 24))) if data is None else data)
        self.volume = vtk.vtkVolume()
        self.volume.SetMapper(mapper)
        self.volume.SetProperty(soft())
        self.renderer = vtk.vtkRenderer()
        self.renderer.AddVolume(self.volume)
        self.window = vtk.vtkRenderWindow()
        WINDOWS.append(self.window)
        self.window.SetOffScreenRendering(1)
        self.window.SetMultiSamples(0)
        self.window.SetSize(*size)
        self.window.AddRenderer(self.renderer)
        self.camera = self.renderer.GetActiveCamera()
        self.look()

    def look(self):
        self.renderer.ResetCamera()
        self.camera.Azimuth(30)
        self.camera.Elevation(20)
        self.renderer.ResetCameraClippingRange()

    def picture(self):
        """float (height, width, 3), row 0 at the top."""
        self.window.Render()
        width, height = self.window.GetSize()
        data = vtk.vtkUnsignedCharArray()
        self.window.GetPixelData(0, 0, width - 1, height - 1, 0, data, 0)
        return numpy.asarray(memoryview(data)).reshape(height, width, 3)[::-1] / 255

    def off(self):
        """How far the window is from our picture of scene_of(), and what that may be."""
        shown = self.picture()
        scene = pellucid.vtk.scene_of(self.renderer, [], 1e-5)
        scene.integration.tolerance = 1e-5
        truth = numpy.clip(pellucid.render(scene).rgba[..., :3], 0, 1)
        assert truth.max() > 0.2 and numpy.ptp(truth) > 0.2
        return abs(shown - truth).max()


def tolerance_of(stage):
    return (HALF_A_STEP + ROUNDING + 1e-5
            + plugin.vtkPellucidFactory.Get(stage.mapper, "Tolerance"))


@pytest.fixture
def used():
    pellucid.vtk.use()
    yield
    pellucid.vtk.use(False)


def stages():
    yield "plain", lambda stage: None
    yield "parallel", lambda stage: stage.camera.ParallelProjectionOn()
    yield "unit distance", lambda stage: stage.volume.SetProperty(soft(2.5))
    yield "lit", lambda stage: stage.volume.GetProperty().ShadeOn()
    yield "lit, parallel", lit_parallel
    yield "lamp", lamp
    yield "lamp and head light", lamp_and_head_light
    yield "moved", moved
    yield "clipped", clipped
    yield "cropped", cropped
    yield "curved functions", curved
    yield "grey", grey
    yield "gradient opacity", gradient
    yield "unclamped", lambda stage: stage.volume.GetProperty().GetScalarOpacity().ClampingOff()
    yield "hsv", lambda stage: (stage.volume.GetProperty().GetRGBTransferFunction()
                                .SetColorSpaceToHSV())
    yield "dependent components", dependent
    yield "dependent colors", dependent_colors
    yield "nearest values", (lambda stage: stage.volume.GetProperty()
                             .SetInterpolationTypeToNearest())
    yield "a negative gradient", negative_gradient
    yield "an opacity that is none", no_number
    yield "a unit distance of 0", lambda stage: stage.volume.SetProperty(soft(0.0))
    yield "horizontal angle", lambda stage: stage.camera.UseHorizontalViewAngleOn()


def components(stage, kind, *parts):
    """Gives the stage's image other components, made of its values."""
    image = stage.mapper.GetInput()
    values = numpy.array(image.GetPointData().GetScalars())
    image.AllocateScalars(kind, len(parts))
    memory = numpy.asarray(memoryview(image.GetPointData().GetScalars()))
    for c, part in enumerate(parts):
        memory.reshape(-1, len(parts))[:, c] = part(values)
    image.GetPointData().GetScalars().Modified()
    stage.volume.GetProperty().IndependentComponentsOff()


def dependent(stage):
    components(stage, vtk.VTK_FLOAT, lambda v: 100 - v, lambda v: v)


def dependent_colors(stage):
    components(stage, vtk.VTK_UNSIGNED_CHAR, lambda v: numpy.clip(2 * v, 0, 255),
               lambda v: numpy.clip(200 - 2 * v, 0, 255), lambda v: 0 * v + 90,
               lambda v: numpy.clip(v, 0, 255))


def negative_gradient(stage):
    function = vtk.vtkPiecewiseFunction()
    function.AddPoint(-10, 0.2)
    function.AddPoint(10, 1)
    stage.volume.GetProperty().SetGradientOpacity(function)


def no_number(stage):
    stage.volume.GetProperty().GetScalarOpacity().SetNodeValue(1, [50, math.nan, 0.5, 0])


def lamp(stage):
    stage.volume.GetProperty().ShadeOn()
    light = vtk.vtkLight()
    light.SetLightTypeToSceneLight()
    light.SetPosition(100, 60, 40)
    light.SetFocalPoint(0, 0, 0)
    light.SetDiffuseColor(1, 0.5, 0.25)
    light.SetIntensity(0.8)
    stage.renderer.AddLight(light)


def lit_parallel(stage):
    stage.volume.GetProperty().ShadeOn()
    stage.camera.ParallelProjectionOn()


def lamp_and_head_light(stage):
    lamp(stage)
    light = vtk.vtkLight()
    light.SetLightTypeToHeadlight()
    stage.renderer.AddLight(light)


def moved(stage):
    stage.volume.SetPosition(5, 6, 7)
    stage.volume.RotateZ(30)
    stage.volume.SetScale(1, 2, 1.5)


def clipped(stage):
    plane = vtk.vtkPlane()
    plane.SetOrigin(*stage.volume.GetCenter())
    plane.SetNormal(1, 0.3, 0.1)
    stage.mapper.AddClippingPlane(plane)


def cropped(stage):
    stage.volume.RotateX(20)
    stage.mapper.CroppingOn()
    stage.mapper.SetCroppingRegionFlagsToSubVolume()
    stage.mapper.SetCroppingRegionPlanes(7.3, 20.2, 3.1, 28.7, 5.5, 39.4)


def curved(stage):
    opacity = stage.volume.GetProperty().GetScalarOpacity()
    opacity.RemoveAllPoints()
    opacity.AddPoint(0, 0, 0.3, 0.6)
    opacity.AddPoint(100, 0.3, 0.5, 0)


def grey(stage):
    function = vtk.vtkPiecewiseFunction()
    function.AddPoint(0, 0.1)
    function.AddPoint(100, 0.9)
    stage.volume.GetProperty().SetColor(function)


def gradient(stage):
    function = vtk.vtkPiecewiseFunction()
    function.AddPoint(0, 0.2)
    function.AddPoint(10, 1)
    stage.volume.GetProperty().SetGradientOpacity(function)


@pytest.mark.parametrize("change", [pytest.param(change, id=name) for name, change in stages()])
def test_both_translations_agree(change):
    stage = Stage(plugin.vtkPellucidVolumeMapper())
    change(stage)
    stage.look()
    assert stage.off() <= tolerance_of(stage)
    assert stage.mapper.GetExact() and stage.mapper.GetLargestError() <= 1 / 512


def test_rectilinear_grids_and_cells_agree():
    grid = vtk.vtkRectilinearGrid()
    grid.SetDimensions(9, 10, 11)
    for axis, count in (("X", 9), ("Y", 10), ("Z", 11)):
        places = vtk.vtkDoubleArray()
        for i in range(count):
            places.InsertNextValue(i + 0.1 * i * i)
        getattr(grid, f"Set{axis}Coordinates")(places)
    values = vtk.vtkFloatArray()
    values.SetNumberOfTuples(8 * 9 * 10)
    numpy.asarray(memoryview(values))[...] = smooth(shape=(10, 9, 8)).ravel()
    grid.GetCellData().SetScalars(values)
    stage = Stage(plugin.vtkPellucidVolumeMapper(), grid)
    assert stage.off() <= tolerance_of(stage)


def test_unstructured_grids_agree():
    stage = Stage(plugin.vtkPellucidUnstructuredGridMapper(), hexahedra())
    assert stage.off() <= tolerance_of(stage)


def test_the_smart_mapper_draws_by_us(used):
    stage = Stage(vtk.vtkSmartVolumeMapper())
    settings = pellucid.vtk.settings(stage.mapper)
    assert settings.tolerance == 1 / 512 and settings.grade == "estimated"
    assert stage.off() <= tolerance_of(stage)
    assert settings.exact and 0 < settings.largest_error <= 1 / 512 and settings.seconds > 0
    assert settings.pixels_over == 0
    settings.tolerance = 1e-4
    stage.window.Render()
    assert settings.tolerance == 1e-4 and settings.largest_error <= 1e-4


def test_projected_tetrahedra_draw_by_us(used):
    threshold = vtk.vtkThreshold()
    threshold.SetInputData(image_of(smooth(shape=(9, 9, 9))))
    threshold.Update()
    stage = Stage(vtk.vtkProjectedTetrahedraMapper(), threshold.GetOutput())
    assert stage.off() <= tolerance_of(stage)


def test_vtk_draws_by_itself_when_not_used():
    pellucid.vtk.use()
    pellucid.vtk.use(False)
    mapper = vtk.vtkGPUVolumeRayCastMapper()
    assert mapper.GetClassName() == "vtkOpenGLGPUVolumeRayCastMapper"
    with pytest.raises(pellucid.Error, match="does not draw by Pellucid"):
        pellucid.vtk.settings(mapper)
    with pytest.raises(pellucid.Error, match="does not draw by Pellucid"):
        pellucid.vtk.settings(3)


def test_settings_are_of_the_mapper_that_draws(used):
    """A smart mapper in its ray-cast mode draws by VTK's fixed-point mapper."""
    mapper = vtk.vtkSmartVolumeMapper()
    assert pellucid.vtk.settings(mapper).tolerance == 1 / 512
    mapper.SetRequestedRenderModeToRayCast()
    with pytest.raises(pellucid.Error, match="SetRequestedRenderModeToDefault"):
        pellucid.vtk.settings(mapper)
    mapper.SetRequestedRenderModeToGPU()
    assert pellucid.vtk.settings(mapper).tolerance == 1 / 512


def test_the_final_color_has_a_window_and_a_level(used):
    stage = Stage(vtk.vtkSmartVolumeMapper())
    stage.mapper.SetFinalColorWindow(0.5)
    stage.mapper.SetFinalColorLevel(0.4)
    shown = stage.picture()
    scene = pellucid.vtk.scene_of(stage.renderer, [])
    scene.integration.tolerance = 1e-5
    plain = pellucid.render(scene)
    truth = pellucid.vtk.finished(stage.renderer, plain)
    by_hand = 2 * plain.rgba[..., :3] - 0.3 * plain.rgba[..., 3:]
    assert abs(truth.rgba[..., :3] - by_hand).max() < 1e-6
    assert abs(shown - numpy.clip(truth.rgba[..., :3], 0, 1)).max() <= tolerance_of(stage)
    assert abs(truth.rgba - plain.rgba).max() > 0.05
    stage.mapper.SetFinalColorWindow(1)
    stage.mapper.SetFinalColorLevel(0.5)
    assert pellucid.vtk.finished(stage.renderer, plain) is plain


def test_an_abort_callback_may_take_the_mapper():
    stage = Stage(plugin.vtkPellucidVolumeMapper(), image_of(smooth(shape=(48, 48, 48))),
                  size=(300, 200))
    stage.mapper.SetTolerance(1e-5)
    asked = []

    def take(window, event):
        asked.append(event)
        stage.volume.SetMapper(None)
        stage.renderer.RemoveVolume(stage.volume)
        stage.mapper = None

    stage.window.AddObserver("AbortCheckEvent", take)
    stage.window.Render()
    assert asked and stage.volume.GetMapper() is None
    stage.window.Render()


def test_bad_settings(used):
    settings = pellucid.vtk.settings(vtk.vtkSmartVolumeMapper())
    for bad in (0, -1, float("nan")):
        with pytest.raises(pellucid.Error):
            settings.tolerance = bad
    with pytest.raises(pellucid.Error):
        settings.grade = "sure"
    settings.tolerance = 1e-99
    assert settings.tolerance == 1e-7


CLASSES = """
import vtkmodules.all as vtk
for name in ("vtkGPUVolumeRayCastMapper", "vtkProjectedTetrahedraMapper",
             "vtkFixedPointVolumeRayCastMapper", "vtkUnstructuredGridVolumeRayCastMapper",
             "vtkUnstructuredGridVolumeZSweepMapper"):
    print("Override" in getattr(vtk, name)().GetClassName())
"""


def run(**environment):
    done = subprocess.run([sys.executable, "-c", CLASSES], capture_output=True, text=True,
                          env={**os.environ, **environment}, check=True)
    return done.stdout.split()


@pytest.mark.skipif("PELLUCID_SANITIZED" in os.environ, reason="preloads a library already")
def test_environment_variables():
    folder = os.path.join(os.environ["PELLUCID_BINARY_DIR"], os.environ["PELLUCID_VTK_FOLDER"])
    assert run() == ["False"] * 5
    assert run(VTK_AUTOLOAD_PATH=os.path.join(folder, "vtk")) == ["True"] * 2 + ["False"] * 3
    preload = os.path.join(folder, "vtk-preload", "libvtkPellucidPreload.so")
    assert run(LD_PRELOAD=preload) == ["True"] * 5


def test_cells_that_change_are_read_anew():
    """The time of a grid leaves out that of its cells."""
    grid = hexahedra()
    stage = Stage(plugin.vtkPellucidUnstructuredGridMapper(), grid)
    whole = stage.picture()
    ids = numpy.array(grid.GetCells().GetConnectivityArray())
    assert len(ids) == 8 * grid.GetNumberOfCells()
    few = vtk.vtkCellArray()
    for cell in ids.reshape(-1, 8)[:256]:
        few.InsertNextCell(8, [int(i) for i in cell])
    grid.SetCells(vtk.VTK_VOXEL, few)
    assert abs(stage.picture() - whole).max() > 0.05
    assert stage.off() <= tolerance_of(stage)


def test_a_window_without_light_is_dark():
    stage = Stage(plugin.vtkPellucidVolumeMapper())
    stage.volume.GetProperty().ShadeOn()
    stage.volume.GetProperty().SetAmbient(0)
    stage.renderer.AutomaticLightCreationOff()
    assert pellucid.vtk.scene_of(stage.renderer, []).lights == []
    assert stage.picture().max() == 0


def test_opacities_on_a_logarithmic_scale_agree():
    stage = Stage(plugin.vtkPellucidVolumeMapper())
    opacity = vtk.vtkPiecewiseFunction()
    for point in ((1, 0.001), (60, 0.02), (120, 0.3)):
        opacity.AddPoint(*point)
    opacity.SetUseLogScale(True)
    stage.volume.GetProperty().SetScalarOpacity(opacity)
    assert stage.off() <= tolerance_of(stage)


def test_cameras_that_have_no_counterpart_are_refused():
    stage = Stage(plugin.vtkPellucidVolumeMapper())
    stage.camera.SetExplicitAspectRatio(0.5)
    stage.camera.UseExplicitAspectRatioOn()
    with pytest.raises(pellucid.Error, match="not square"):
        pellucid.vtk.scene_of(stage.renderer, [])
    stage.camera.UseExplicitAspectRatioOff()
    for element, words in (((0, 1), "frustum"), ((0, 2), "center"), ((3, 3), "frustum")):
        matrix = vtk.vtkMatrix4x4()
        matrix.DeepCopy(stage.camera.GetProjectionTransformMatrix(96 / 64, -1, 1))
        matrix.SetElement(*element, 0.25)
        stage.camera.SetExplicitProjectionTransformMatrix(matrix)
        stage.camera.UseExplicitProjectionTransformMatrixOn()
        with pytest.raises(pellucid.Error, match=words):
            pellucid.vtk.scene_of(stage.renderer, [])
        stage.camera.UseExplicitProjectionTransformMatrixOff()


@pytest.mark.parametrize("parallel", (False, True))
def test_explicit_projections_agree(parallel):
    stage = Stage(plugin.vtkPellucidVolumeMapper())
    stage.camera.SetParallelProjection(parallel)
    before = stage.picture()
    matrix = vtk.vtkMatrix4x4()
    matrix.DeepCopy(stage.camera.GetProjectionTransformMatrix(96 / 64, -1, 1))
    stage.camera.SetExplicitProjectionTransformMatrix(matrix)
    stage.camera.UseExplicitProjectionTransformMatrixOn()
    stage.camera.SetViewAngle(70)
    stage.camera.SetParallelScale(200)
    assert numpy.abs(stage.picture() - before).max() < 1e-3
    assert stage.off() <= tolerance_of(stage)


def test_threads_have_a_limit():
    mapper = plugin.vtkPellucidVolumeMapper()
    mapper.SetNumberOfThreads(100000)
    assert mapper.GetNumberOfThreads() == 1024
    mapper.SetNumberOfThreads(-3)
    assert mapper.GetNumberOfThreads() == 0
