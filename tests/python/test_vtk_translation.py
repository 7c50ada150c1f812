# SPDX-License-Identifier: Apache-2.0
"""One table of scenes of VTK, read off by the plug-in in C++ and by scene_of() in Python.

Both give the numbers to the same translation: pictures are the same to the display's 15 bits, and
lines on what is left out or refused word for word. Run under xvfb-run.
"""
import math
import os

import numpy
import pytest

import pellucid
import pellucid.vtk
from conftest import smooth
from pellucid._vtk_picture import picture_of

if "DISPLAY" not in os.environ:
    pytest.skip("VTK needs a display: run under xvfb-run (Debian: xvfb)", allow_module_level=True)
vtk = pytest.importorskip("vtkmodules.all")
plugin = pytest.importorskip("pellucid.vtkPellucid",
                             reason="the plug-in for VTK is not built for this Python")
from vtkmodules.util.misc import calldata_type  # noqa: E402

from test_vtk_plugin import (Stage, cropped, dependent, dependent_colors, gradient,  # noqa: E402
                             hexahedra, image_of, lamp, lamp_and_head_light, moved)

# A step of the display, which also interpolates between texels.
STEP = 1.05 / 32767


def said_by(mapper, event):
    """The lines that a mapper tells by its warnings or errors."""
    lines = []

    @calldata_type(vtk.VTK_STRING)
    def hear(_object, _event, text):
        lines.append(text.rpartition("Pellucid")[2].partition(": ")[2].strip())

    mapper.AddObserver(event, hear)
    return lines


def own_lines(notes):
    """Those of notes that are about the translation, without the volume that they are about."""
    about_vtk = ("VTK 9.1", "gradients are measured", "gradient_opacity")
    return {line.removeprefix("volume 1: ") for line in notes
            if not any(words in line for words in about_vtk)}


def look(stage):
    return stage.volume.GetProperty()


def opacities(*nodes):
    function = vtk.vtkPiecewiseFunction()
    for node in nodes:
        function.AddPoint(*node)
    return function


def grey_ramp_in_lab(stage):
    """VTK puts its ramp into the function, which keeps its color space."""
    look(stage).SetColor(vtk.vtkColorTransferFunction())
    look(stage).GetRGBTransferFunction().SetColorSpaceToLab()


def no_node_is_a_number(stage):
    function = opacities((0, 0.1), (100, 0.2))
    for i in range(2):
        function.SetNodeValue(i, [100 * i, math.nan, 0.5, 0])
    look(stage).SetScalarOpacity(function)


def far_nodes(stage):
    look(stage).SetScalarOpacity(opacities((-math.inf, 0), (50, 0.02), (1e300, 0.2)))


def cut_opacities(stage):
    look(stage).SetScalarOpacity(opacities((0, -0.3), (60, 0.1), (80, 1.7), (100, 0.2, 0.3, 0.6)))


def colors(stage, space, *nodes):
    function = vtk.vtkColorTransferFunction()
    getattr(function, f"SetColorSpaceTo{space}")()
    for node in nodes or ((10, 0.9, 0.1, 0.2, 0.3, 0.4), (50, 0.1, 0.6, 0.95), (90, 0.8, 0.8, 0.1)):
        function.AddRGBPoint(*node)
    look(stage).SetColor(function)
    return function


def hues_that_do_not_wrap(stage):
    colors(stage, "HSV", (0, 0.9, 0.1, 0.2), (100, 0.8, 0.8, 0.1)).HSVWrapOff()


def colors_outside_of_the_nodes(stage):
    function = colors(stage, "Lab")
    function.UseBelowRangeColorOn()
    function.SetBelowRangeColor(0.1, 0.9, 0.3)
    function.UseAboveRangeColorOn()
    function.SetAboveRangeColor(0.7, 0.2, 1)


def functions_that_end(stage):
    colors(stage, "RGB", (45, 0.9, 0.1, 0.2), (60, 0.1, 0.6, 0.95)).ClampingOff()
    look(stage).SetScalarOpacity(opacities((30, 0.1), (70, 0.2)))
    look(stage).GetScalarOpacity().ClampingOff()


def logarithms(stage):
    colors(stage, "RGB", (1, 0.9, 0.1, 0.2), (100, 0.1, 0.6, 0.95)).SetScaleToLog10()
    look(stage).SetScalarOpacity(opacities((1, 0.001), (120, 0.3)))
    look(stage).GetScalarOpacity().UseLogScaleOn()


def steps_that_mappers_leave_out(stage):
    function = vtk.vtkDiscretizableColorTransferFunction()
    function.AddRGBPoint(0, 0.9, 0.1, 0.2)
    function.AddRGBPoint(100, 0.1, 0.6, 0.95)
    function.DiscretizeOn()
    function.IndexedLookupOn()
    look(stage).SetColor(function)


def jumps(stage):
    look(stage).SetScalarOpacity(opacities((0, 0, 0.3, 1), (50, 0.1, 0.6, 1), (100, 0.5)))


def nearest_at_jumps(stage):
    jumps(stage)
    look(stage).SetInterpolationTypeToNearest()


def greys(stage):
    look(stage).SetColor(opacities((0, 0.1), (70, 0.9, 0.4, 0.2), (100, 0.4)))


def nearest_where_vtk_has_no_number(stage):
    function = opacities((-20, 0.1), (10, 0.5), (90, 0.9))
    function.UseLogScaleOn()
    look(stage).SetScalarOpacity(function)
    look(stage).SetInterpolationTypeToNearest()


def several_components(stage):
    image = stage.mapper.GetInput()
    values = numpy.array(image.GetPointData().GetScalars())
    image.AllocateScalars(vtk.VTK_FLOAT, 3)
    memory = numpy.asarray(memoryview(image.GetPointData().GetScalars())).reshape(-1, 3)
    memory[:, 0], memory[:, 1], memory[:, 2] = values, 100 - values, values
    for c in (1, 2):
        look(stage).SetScalarOpacity(c, opacities((0, 0), (100, 0.1)))
        look(stage).SetColor(c, look(stage).GetRGBTransferFunction(0))
    look(stage).SetScalarOpacityUnitDistance(1, 2.5)
    look(stage).SetComponentWeight(1, 0.5)
    look(stage).SetComponentWeight(2, 0)


def hidden_colors(stage):
    """Bytes stay bytes where some of them are hidden."""
    dependent_colors(stage)
    grid = vtk.vtkUniformGrid()
    grid.ShallowCopy(stage.mapper.GetInput())
    for i in range(24 * 24):
        grid.BlankPoint(i)
    stage.grid = grid
    stage.mapper.SetInputData(grid)


def cells_of(stage, mark):
    """Gives the stage a grid with values of cells, of which `mark` marks some."""
    grid = vtk.vtkUniformGrid()
    grid.SetDimensions(13, 12, 11)
    values = vtk.vtkFloatArray()
    values.SetNumberOfTuples(12 * 11 * 10)
    numpy.asarray(memoryview(values))[...] = smooth(shape=(10, 11, 12)).ravel()
    grid.GetCellData().SetScalars(values)
    mark(grid)
    stage.grid = grid
    stage.mapper.SetInputData(grid)


def ghosts(stage):
    def mark(grid):
        grid.AllocateCellGhostArray()
        for i in range(grid.GetNumberOfCells()):
            if i % 12 > 7 or i // 12 % 11 < 3:
                grid.GetCellGhostArray().SetValue(i, 1)

    cells_of(stage, mark)
    stage.volume.RotateZ(20)


def hidden_cells(stage):
    cells_of(stage, lambda grid: [grid.BlankCell(i) for i in range(0, 1320, 7)])


def surface_in_a_face_of_ghosts(stage):
    """The face is the other block's, or the surface would be shown twice."""
    def mark(grid):
        grid.AllocateCellGhostArray()
        for i in range(grid.GetNumberOfCells()):
            if i % 12 > 5:
                grid.GetCellGhostArray().SetValue(i, 1)

    cells_of(stage, mark)
    isosurfaces(stage)


def clipped(stage):
    """The second plane is none."""
    for normal in ((1, 0.3, 0.1), (0, 0, 0)):
        plane = vtk.vtkPlane()
        plane.SetOrigin(*stage.volume.GetCenter())
        if any(normal):
            plane.SetNormal(normal)
        else:
            plane.SetNormal(math.nan, 0, 0)
        stage.mapper.AddClippingPlane(plane)


def cropped_to_a_fence(stage):
    cropped(stage)
    stage.mapper.SetCroppingRegionFlagsToFence()


def isosurfaces(stage):
    stage.mapper.SetBlendModeToIsoSurface()
    look(stage).SetScalarOpacity(opacities((0, 0), (100, 0.8)))
    for i, value in enumerate((30, 60, 60, math.inf)):
        look(stage).GetIsoSurfaceValues().SetValue(i, value)


def slices(stage):
    stage.mapper.SetBlendModeToSlice()
    plane = vtk.vtkPlane()
    plane.SetOrigin(15, 15, 20)
    plane.SetNormal(0.2, 0.3, 1)
    look(stage).SetSliceFunction(plane)
    look(stage).SetScalarOpacity(opacities((0, 0.2), (100, 0.9)))


def labels(stage):
    mask = vtk.vtkImageData()
    mask.SetDimensions(24, 24, 24)
    mask.SetSpacing(1, 1.5, 2)
    mask.SetOrigin(3, -2, 1)
    mask.AllocateScalars(vtk.VTK_UNSIGNED_CHAR, 1)
    numpy.asarray(memoryview(mask.GetPointData().GetScalars()))[...] = numpy.repeat(
        numpy.arange(24 ** 2) % 3, 24)
    stage.mapper.SetMaskInput(mask)
    stage.mask = mask


def binary_mask(stage):
    labels(stage)
    stage.mapper.SetMaskTypeToBinary()


def label_map(stage):
    labels(stage)
    stage.mapper.SetMaskTypeToLabelMap()
    stage.mapper.SetMaskBlendFactor(0.5)
    color = vtk.vtkColorTransferFunction()
    color.AddRGBPoint(0, 0, 1, 0)
    look(stage).SetLabelColor(1, color)
    look(stage).SetLabelScalarOpacity(2, opacities((0, 0), (100, 0.5)))
    look(stage).SetLabelGradientOpacity(1, opacities((0, 0.5)))


def odd_light(stage):
    """VTK makes no light of its own where one is on, whatever that is."""
    look(stage).ShadeOn()
    look(stage).SetAmbient(0.5)
    light = vtk.vtkLight()
    light.SetLightTypeToSceneLight()
    light.SetPosition(math.nan, 0, 0)
    stage.renderer.AddLight(light)


def dark_light(stage):
    look(stage).ShadeOn()
    light = vtk.vtkLight()
    light.SetIntensity(-2)
    light.SetAmbientColor(0.3, 0, 0)
    stage.renderer.AddLight(light)
    lamp(stage)


def lights_that_fade(stage):
    """Neither do they, nor is there a side that reflects none."""
    look(stage).ShadeOn()
    for position in ((60, 0, 10), (0, 50, 60)):
        light = vtk.vtkLight()
        light.SetLightTypeToSceneLight()
        light.PositionalOn()
        light.SetPosition(*position)
        light.SetAttenuationValues(1, 0.01, 0)
        stage.renderer.AddLight(light)
    stage.renderer.TwoSidedLightingOff()


def light_in_a_cone(stage):
    lamp(stage)
    light = stage.renderer.GetLights().GetItemAsObject(0)
    light.PositionalOn()
    light.SetConeAngle(30)


def no_light(stage):
    look(stage).ShadeOn()
    stage.renderer.AutomaticLightCreationOff()


def highlights(stage):
    look(stage).ShadeOn()
    look(stage).SetAmbient(0.3)
    look(stage).SetDiffuse(0.4)
    look(stage).SetSpecular(0.9)
    look(stage).SetSpecularPower(5)


def mean_of_a_range(stage):
    stage.mapper.SetBlendModeToAverageIntensity()
    stage.mapper.SetAverageIPScalarRange(20, 80)


def bright_light(stage):
    """Tables of opacities are fitted for what light makes of their colors."""
    lamp_and_head_light(stage)
    for light in (stage.renderer.GetLights().GetItemAsObject(i) for i in range(2)):
        light.SetIntensity(3)


def odd_shading(stage):
    look(stage).ShadeOn()
    look(stage).SetSpecularPower(0.3)
    look(stage).SetAmbient(math.nan)


def parallel_with_a_lamp(stage):
    """There is no head light to tell of."""
    lamp(stage)
    stage.camera.ParallelProjectionOn()


def center_of_shear(stage):
    """Without a shear its center says nothing."""
    stage.camera.SetViewShear(0, 0, 0.5)


def near_plane(stage):
    near, far = stage.camera.GetClippingRange()
    stage.camera.SetClippingRange(near + 0.4 * (far - near), far)


PICTURES = {
    "nothing else": lambda stage: None,
    "moved": moved,
    "a ramp in Lab": grey_ramp_in_lab,
    "no node is a number": no_node_is_a_number,
    "far nodes": far_nodes,
    "cut opacities": cut_opacities,
    "hues that do not wrap": hues_that_do_not_wrap,
    "colors outside of the nodes": colors_outside_of_the_nodes,
    "functions that end": functions_that_end,
    "logarithms": logarithms,
    "steps that mappers leave out": steps_that_mappers_leave_out,
    "CIEDE2000": lambda stage: colors(stage, "LabCIEDE2000"),
    "greys": greys,
    "a unit distance": lambda stage: look(stage).SetScalarOpacityUnitDistance(2.5),
    "jumps": jumps,
    "nearest at jumps": nearest_at_jumps,
    "a unit distance that is none": lambda s: look(s).SetScalarOpacityUnitDistance(math.nan),
    "nearest where VTK has no number": nearest_where_vtk_has_no_number,
    "gradient opacity": gradient,
    "several components": several_components,
    "dependent components": dependent,
    "hidden colors": hidden_colors,
    "ghosts": ghosts,
    "hidden cells": hidden_cells,
    "a surface in a face of ghosts": surface_in_a_face_of_ghosts,
    "clipped": clipped,
    "cropped": cropped,
    "cropped to a fence": cropped_to_a_fence,
    "maximum": lambda stage: stage.mapper.SetBlendModeToMaximumIntensity(),
    "minimum": lambda stage: stage.mapper.SetBlendModeToMinimumIntensity(),
    "mean": lambda stage: stage.mapper.SetBlendModeToAverageIntensity(),
    "mean of a range": mean_of_a_range,
    "isosurfaces": isosurfaces,
    "slices": slices,
    "binary mask": binary_mask,
    "label map": label_map,
    "highlights": highlights,
    "lights that fade": lights_that_fade,
    "light in a cone": light_in_a_cone,
    "no light": no_light,
    "odd light": odd_light,
    "dark light": dark_light,
    "bright light": bright_light,
    "odd shading": odd_shading,
    "parallel with a lamp": parallel_with_a_lamp,
    "center of shear": center_of_shear,
    "near plane": near_plane,
}


def expect_the_same(stage):
    warnings, notes = said_by(stage.mapper, "WarningEvent"), []
    shown = picture_of(stage.window, stage.renderer)
    tolerance = stage.mapper.GetTolerance()
    scene = pellucid.vtk.scene_of(stage.renderer, notes, tolerance)
    scene.integration.tolerance = tolerance
    ours = numpy.clip(pellucid.render(scene).rgba, 0, 1)
    assert abs(shown - ours).max() <= STEP
    assert set(warnings) == own_lines(notes)
    return shown


@pytest.mark.parametrize("name", PICTURES)
def test_pictures_are_the_same(name):
    stage = Stage(plugin.vtkPellucidVolumeMapper())
    PICTURES[name](stage)
    stage.look()
    if name == "near plane":
        near_plane(stage)  # which look() has moved
    shown = expect_the_same(stage)
    assert (shown[..., 3].max() < 1e-3) == (name == "no node is a number")


def matrix_of(stage, changes):
    matrix = vtk.vtkMatrix4x4()
    matrix.DeepCopy(stage.camera.GetProjectionTransformMatrix(96 / 64, -1, 1))
    for row, column, value in changes:
        matrix.SetElement(row, column, value)
    stage.camera.SetExplicitProjectionTransformMatrix(matrix)
    stage.camera.UseExplicitProjectionTransformMatrixOn()


def behind_the_camera(stage):
    depth = stage.camera.GetProjectionTransformMatrix(96 / 64, -1, 1)
    matrix_of(stage, [(2, 3, -depth.GetElement(2, 3))])


def user_matrix(stage, row, column, value):
    matrix = vtk.vtkMatrix4x4()
    matrix.SetElement(row, column, value)
    stage.volume.SetUserMatrix(matrix)


def three_colors(stage):
    several_components(stage)
    look(stage).IndependentComponentsOff()


def cropped_projection(stage):
    cropped_to_a_fence(stage)
    stage.mapper.SetBlendModeToMaximumIntensity()


def no_array(stage):
    stage.mapper.SetScalarModeToUsePointFieldData()
    stage.mapper.SelectScalarArray("nothing")


def hole_between_cells(stage):
    grid = vtk.vtkUniformGrid()
    grid.DeepCopy(stage.mapper.GetInput())
    grid.BlankCell(6000)
    stage.grid = grid
    stage.mapper.SetInputData(grid)


def scattered_ghosts(stage):
    hole_between_cells(stage)
    stage.grid.GetCellGhostArray().Fill(0)
    stage.grid.GetCellGhostArray().SetValue(6000, 1)


REFUSED = {
    "a projection behind the camera": behind_the_camera,
    "a projection that is none": lambda stage: matrix_of(stage, [(0, 1, 0.25)]),
    "pixels that are not square": lambda stage: matrix_of(stage, [(0, 0, 1), (1, 1, 1)]),
    "a matrix that is not affine": lambda stage: user_matrix(stage, 3, 0, 0.1),
    "a singular matrix": lambda stage: user_matrix(stage, 0, 0, 0),
    "three dependent components": three_colors,
    "a cropped projection": cropped_projection,
    "no array": no_array,
    "no plane of a slice": lambda stage: stage.mapper.SetBlendModeToSlice(),
    "two variables": lambda stage: look(stage).SetTransferFunctionMode(1),
    "a hole between cells": hole_between_cells,
    "scattered ghosts": scattered_ghosts,
    "shear": lambda stage: stage.camera.SetViewShear(0.1, 0, 1),
}


@pytest.mark.parametrize("name", REFUSED)
def test_refusals_are_the_same(name):
    stage = Stage(plugin.vtkPellucidVolumeMapper())
    stage.look()
    REFUSED[name](stage)
    stage.renderer.GetCullers().RemoveAllItems()  # of what is behind the camera
    errors = said_by(stage.mapper, "ErrorEvent")
    stage.window.Render()
    with pytest.raises(pellucid.Error) as refused:
        pellucid.vtk.scene_of(stage.renderer, [])
    assert [str(refused.value).removeprefix("volume 1: ")] == errors


def flags(values, attributes):
    array = vtk.vtkUnsignedCharArray()
    array.SetName("vtkGhostType")
    array.SetNumberOfTuples(len(values))
    numpy.asarray(memoryview(array))[...] = values
    attributes.AddArray(array)


def hidden_corners(stage):
    grid = stage.mapper.GetInput()
    flags(2 * (numpy.arange(grid.GetNumberOfPoints()) % 50 == 0), grid.GetPointData())


def marked_cells(stage):
    grid = stage.mapper.GetInput()
    flags(numpy.choose(numpy.arange(grid.GetNumberOfCells()) % 5, [0, 0, 1, 8, 32]),
          grid.GetCellData())


MESHES = {
    "nothing else": lambda stage: None,
    "maximum": lambda stage: stage.mapper.SetBlendModeToMaximumIntensity(),
    "curved": lambda stage: look(stage).SetScalarOpacity(
        opacities((0, -0.1), (60, 0.3, 0.3, 0.6), (100, 2))),
    "a unit distance of 0": lambda stage: look(stage).SetScalarOpacityUnitDistance(0),
    "light": lambda stage: look(stage).ShadeOn(),
    "clipped": clipped,
    "hidden corners": hidden_corners,
    "marked cells": marked_cells,
}


@pytest.mark.parametrize("name", MESHES)
def test_pictures_of_meshes_are_the_same(name):
    stage = Stage(plugin.vtkPellucidUnstructuredGridMapper(), hexahedra())
    MESHES[name](stage)
    stage.look()
    assert expect_the_same(stage)[..., 3].max() > 0.1
