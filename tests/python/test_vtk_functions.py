# SPDX-License-Identifier: Apache-2.0
"""Functions of VTK as scene_of() shows them, against VTK's own GetColor() and GetValue(). Run under
xvfb-run.

The data are a field of x, one thick and with a unit distance of 1, seen along z by parallel rays: a
pixel is the function at its middle.
"""
import itertools
import os

import numpy
import pytest

import pellucid
import pellucid.vtk

if "DISPLAY" not in os.environ:
    pytest.skip("VTK needs a display: run under xvfb-run (Debian: xvfb)", allow_module_level=True)
vtk = pytest.importorskip("vtkmodules.all")

WINDOWS = []  # a display whose last window closes may end
FIRST, LAST, WIDTH = 0.5, 100.0, 257


def strip(first=FIRST, last=LAST):
    """A stage whose pixel i shows the value places(first, last)[i]."""
    image = vtk.vtkImageData()
    image.SetDimensions(2, 2, 2)
    image.SetOrigin(first, 0, 0)
    image.SetSpacing(last - first, last - first, 1)
    image.AllocateScalars(vtk.VTK_DOUBLE, 1)
    numpy.asarray(memoryview(image.GetPointData().GetScalars()))[...] = [first, last] * 4
    mapper, volume = vtk.vtkGPUVolumeRayCastMapper(), vtk.vtkVolume()
    mapper.SetInputData(image)
    volume.SetMapper(mapper)
    renderer, window = vtk.vtkRenderer(), vtk.vtkRenderWindow()
    renderer.AddVolume(volume)
    window.SetOffScreenRendering(1)
    window.SetSize(WIDTH, 3)
    window.AddRenderer(renderer)
    WINDOWS.append(window)
    camera, middle = renderer.GetActiveCamera(), (first + last) / 2
    camera.ParallelProjectionOn()
    camera.SetFocalPoint(middle, (last - first) / 2, 0)
    camera.SetPosition(middle, (last - first) / 2, 10)
    camera.SetParallelScale(1.5 * (last - first) / WIDTH)
    camera.SetClippingRange(1, 100)
    return renderer, volume


def places(first=FIRST, last=LAST):
    return first + (numpy.arange(WIDTH) + 0.5) * (last - first) / WIDTH


def property_of(opacity, color):
    made = vtk.vtkVolumeProperty()
    made.SetScalarOpacity(opacity)
    made.SetColor(color)
    made.SetScalarOpacityUnitDistance(1)
    made.SetInterpolationTypeToLinear()
    return made


def constant(value):
    function = vtk.vtkPiecewiseFunction()
    function.AddPoint(0, value)
    return function


def white():
    function = vtk.vtkColorTransferFunction()
    function.AddRGBPoint(0, 1, 1, 1)
    return function


def table_color(function, x):
    color = [0.0] * 3
    function.GetTable(x, x, 1, color)
    return color


def off(look, tolerance, first=FIRST, last=LAST, notes=None):
    """How far a picture is from VTK's own functions, and what it says of that."""
    renderer, volume = strip(first, last)
    volume.SetProperty(look)
    scene = pellucid.vtk.scene_of(renderer, [] if notes is None else notes, tolerance)
    scene.integration = pellucid.Integration(tolerance=tolerance)
    image = pellucid.render(scene)
    opacity, color = look.GetScalarOpacity(), look.GetRGBTransferFunction()
    # VTK's CIEDE2000 takes 50 ms for each place.
    step = 16 if color.GetColorSpace() == 4 else 1
    at = numpy.arange(0, WIDTH, step)
    truth = numpy.empty((len(at), 4))
    for i, x in enumerate(places(first, last)[at]):
        truth[i, 3] = min(max(opacity.GetValue(x), 0), 1)
        truth[i, :3] = truth[i, 3] * numpy.maximum(table_color(color, x), 0)
    # The picture has floats.
    largest = abs(image.rgba[1][at] - truth).max()
    return largest, image.report["largest_error"] + 1.2e-7 * truth.max()


SPACES = ["RGB", "HSV", "Lab", "LabCIEDE2000", "Diverging", "Step"]
SHAPES = [(0.5, 0.0), (0.3, 0.0), (0.6, 0.5), (0.2, 1.0), (0.5, 0.02), (0.45, 0.985),
          (0.6, 0.995)]


def colors(space, shape, log=False, wrap=True):
    function = vtk.vtkColorTransferFunction()
    getattr(function, f"SetColorSpaceTo{space}")()
    function.SetHSVWrap(wrap)
    for x, *rgb in ((1, 0.9, 0.1, 0.2), (7, 0.1, 0.6, 0.95), (40, 0.85, 0.8, 0.05),
                    (90, 0.02, 0.01, 0.03)):
        function.AddRGBPoint(x, *rgb, *shape)
    if log:
        function.SetScaleToLog10()
    return function


@pytest.mark.parametrize("space", SPACES)
@pytest.mark.parametrize("log", [False, True])
def test_colors_are_vtks(space, log):
    for shape in SHAPES:
        if space == "LabCIEDE2000" and shape not in SHAPES[:2]:
            continue  # VTK takes seconds
        look = property_of(constant(0.5), colors(space, shape, log))
        largest, said = off(look, 1e-6)
        # VTK's colors of CIEDE2000 are steps.
        most = 0.03 if space == "LabCIEDE2000" else 4e-6
        assert largest <= said <= most, (space, log, shape, largest, said)


def test_hues_that_do_not_wrap():
    for shape in SHAPES:
        largest, said = off(property_of(constant(0.5), colors("HSV", shape, wrap=False)), 1e-6)
        assert largest <= said <= 2e-6, (shape, largest, said)


@pytest.mark.parametrize("space", ["RGB", "Lab", "Step"])
@pytest.mark.parametrize("clamping", [True, False])
def test_colors_outside_of_the_nodes_are_vtks(space, clamping):
    for below, above in itertools.product([None, (0.1, 0.9, 0.3)], [None, (0.7, 0.2, 1.0)]):
        function = colors(space, (0.5, 0.0))
        function.SetClamping(clamping)
        if below:
            function.UseBelowRangeColorOn()
            function.SetBelowRangeColor(*below)
        if above:
            function.UseAboveRangeColorOn()
            function.SetAboveRangeColor(*above)
        largest, said = off(property_of(constant(0.5), function), 1e-6)
        assert largest <= said <= 4e-6, (space, clamping, below, above)


def test_colors_beyond_their_range():
    for space, shape in itertools.product(["RGB", "HSV"], [(0.5, 0.0), (0.4, 0.5), (0.3, 0.0)]):
        function = colors(space, shape)
        function.AddRGBPoint(20, -0.4, 1.7, 0.5, *shape)
        largest, said = off(property_of(constant(0.5), function), 1e-6)
        assert largest <= said <= 4e-6, (space, shape)


def test_nodes_at_one_place():
    function = colors("RGB", (0.5, 0.0))
    function.AllowDuplicateScalarsOn()
    for red in (0.1, 0.9, 0.4):
        function.AddRGBPoint(40, red, 0.5, 1 - red)
    opacity = constant(0.3)
    opacity.AllowDuplicateScalarsOn()
    for value in (0.6, 0.9, 0.1):
        opacity.AddPoint(60, value)
    largest, said = off(property_of(opacity, function), 1e-6)
    assert largest <= said <= 2e-6


@pytest.mark.parametrize("log", [False, True])
@pytest.mark.parametrize("clamping", [True, False])
def test_opacities_are_vtks(log, clamping):
    for shape in SHAPES:
        for nodes in (((1, 0), (30, 0.7), (80, 0.2)), ((2, 0.4), (3, 0.9), (70, 0)),
                      ((1, -0.3), (30, 1.4), (60, 0.8), (80, -1)), ((5, 1), (50, 0.99), (90, 1))):
            opacity = vtk.vtkPiecewiseFunction()
            for x, value in nodes:
                opacity.AddPoint(x, value, *shape)
            opacity.SetUseLogScale(log)
            opacity.SetClamping(clamping)
            largest, said = off(property_of(opacity, white()), 1e-6)
            assert largest <= said <= 4e-6, (shape, nodes, largest, said)


def test_logarithms_that_do_not_exist():
    """VTK's colors are then linear; its opacities are no numbers, which a note says."""
    function = colors("RGB", (0.5, 0.0), log=True)
    function.AddRGBPoint(-20, 1, 1, 1)
    largest, said = off(property_of(constant(0.5), function), 1e-6, -30, 100)
    assert largest <= said <= 2e-6
    opacity = vtk.vtkPiecewiseFunction()
    for x, value in ((-20, 0.1), (10, 0.5), (90, 0.9)):
        opacity.AddPoint(x, value)
    opacity.UseLogScaleOn()
    notes = []
    largest, said = off(property_of(opacity, white()), 1e-6, 11, 100, notes)
    assert largest <= said <= 2e-6
    assert any("VTK has no number" in line for line in notes)


def test_a_tolerance_bounds_what_fits_are_off_by():
    look = property_of(constant(0.5), colors("Lab", (0.5, 0.0), log=True))
    points = []
    for tolerance in (1e-2, 1e-4):
        renderer, volume = strip()
        volume.SetProperty(look)
        table = pellucid.vtk.scene_of(renderer, [], tolerance).layers[0].transfer_function
        points.append(len(table.points))
        largest, said = off(look, tolerance)
        assert largest <= said <= tolerance
    assert 10 < points[0] < points[1] / 4 < 2000


def jumping_sharpness():
    """Returns 1 if this VTK's opacities jump there, as up to 9.2, else 0."""
    opacity = vtk.vtkPiecewiseFunction()
    opacity.AddPoint(0, 0, 0.5, 1)
    opacity.AddPoint(1, 1, 0.5, 1)
    return 1 if opacity.GetValue(0.25) == 0 else 0


def test_exact_functions_stay_exact():
    opacity = vtk.vtkPiecewiseFunction()
    for node in ((0, 0, 0.25, 0), (40, 0.8, 0.5, jumping_sharpness()), (90, 0.4, 0.5, 0)):
        opacity.AddPoint(*node)
    renderer, volume = strip()
    volume.SetProperty(property_of(opacity, colors("Step", (0.5, 0.0))))
    table = pellucid.vtk.scene_of(renderer, []).layers[0].transfer_function
    assert '"deviation"' not in table.to_json()
    assert (10.0, 0.4) in [(x, a) for x, a, _ in table.points]


def test_one_node_and_none():
    one = vtk.vtkColorTransferFunction()
    one.AddRGBPoint(30, 0.2, 0.4, 0.6)
    for clamping in (True, False):
        one.SetClamping(clamping)
        largest, said = off(property_of(constant(0.5), one), 1e-6)
        assert largest <= said
    # VTK's mapper puts ramps over the data's range into functions without nodes.
    renderer, volume = strip(3.0, 10.0)
    look = property_of(vtk.vtkPiecewiseFunction(), vtk.vtkColorTransferFunction())
    volume.SetProperty(look)
    scene = pellucid.vtk.scene_of(renderer, [])
    renderer.GetRenderWindow().Render()
    assert look.GetScalarOpacity().GetSize() == 2 and look.GetRGBTransferFunction().GetSize() == 2
    filled = pellucid.vtk.scene_of(renderer, [])
    assert (scene.layers[0].transfer_function.points == filled.layers[0].transfer_function.points
            == [(3.0, 0.0, (0.0, 0.0, 0.0)), (10.0, 0.5, (1.0, 1.0, 1.0))])


@pytest.mark.parametrize("space", ["HSV", "Lab", "Diverging"])
def test_ramps_are_in_the_color_space_of_their_function(space):
    """VTK puts the ends of a ramp into the function, and leaves the rest of it as it is."""
    color = vtk.vtkColorTransferFunction()
    getattr(color, f"SetColorSpaceTo{space}")()
    renderer, volume = strip()
    volume.SetProperty(property_of(constant(0.5), color))
    scene = pellucid.vtk.scene_of(renderer, [], 1e-6)
    scene.integration.tolerance = 1e-6
    image = pellucid.render(scene)
    renderer.GetRenderWindow().Render()
    assert color.GetSize() == 2
    truth = numpy.array([table_color(color, x) for x in places()])
    assert abs(image.rgba[1][:, :3] - 0.5 * truth).max() <= 4e-6
    assert space != "Lab" or abs(truth[128] - 0.5).max() > 0.03


def test_discretized_colors_are_those_of_the_mappers():
    function = vtk.vtkDiscretizableColorTransferFunction()
    for x, *rgb in ((1, 0.9, 0.1, 0.2), (90, 0.1, 0.6, 0.95)):
        function.AddRGBPoint(x, *rgb)
    for space in ("LabCIEDE2000", "HSV", "Lab"):
        getattr(function, f"SetColorSpaceTo{space}")()
        largest, said = off(property_of(constant(0.5), function), 1e-5)
        assert largest <= said <= (0.03 if space == "LabCIEDE2000" else 2e-5)
    function.DiscretizeOn()
    function.SetNumberOfValues(4)
    function.Build()
    notes = []
    largest, said = off(property_of(constant(0.5), function), 1e-5, notes=notes)
    assert largest <= said and any("discretized" in line for line in notes)
    function.SetNumberOfValues(256)  # as ParaView's have
    function.Build()
    notes = []
    largest, said = off(property_of(constant(0.5), function), 1e-5, notes=notes)
    assert largest <= said and notes == []
    function.SetNumberOfValues(4)
    function.Build()
    # So they are in VTK's own picture, which has a table of them.
    renderer, volume = strip()
    volume.SetProperty(property_of(constant(0.5), function))
    volume.GetMapper().AutoAdjustSampleDistancesOff()
    volume.GetMapper().SetSampleDistance(0.01)
    assert pellucid.vtk.audit(renderer.GetRenderWindow()).largest < 5e-3


def test_nearest_values_at_jumps_are_vtks():
    """Labels that lie where functions jump have the side that VTK takes."""
    image = vtk.vtkImageData()
    image.SetDimensions(4, 2, 2)
    image.AllocateScalars(vtk.VTK_UNSIGNED_CHAR, 1)
    numpy.asarray(memoryview(image.GetPointData().GetScalars()))[...] = [0, 1, 2, 3] * 4
    opacity, color = vtk.vtkPiecewiseFunction(), vtk.vtkColorTransferFunction()
    for x, value in ((0, 0.1), (1, 0.5), (2, 0.9), (3, 0.2)):
        opacity.AddPoint(x, value, 0.5, 1.0)
        color.AddRGBPoint(x, value, 1 - value, 0.5)
    color.SetColorSpaceToStep()
    renderer, volume = strip()
    look = property_of(opacity, color)
    look.SetInterpolationTypeToNearest()
    volume.SetProperty(look)
    volume.GetMapper().SetInputData(image)
    looks = pellucid.vtk.scene_of(renderer, []).layers[0].labels.looks
    for i in range(4):
        rgb, extinction, _ = looks[i]
        assert 1 - numpy.exp(-extinction) == pytest.approx(opacity.GetValue(i))
        assert rgb == pytest.approx(table_color(color, i))
