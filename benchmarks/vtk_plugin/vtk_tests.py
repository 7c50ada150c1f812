#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""The scenes of VTK 9.1's own tests of volume rendering, made by our words, by VTK and by us.

    PYTHONPATH=build/release/lib/python3.11/dist-packages xvfb-run -a /usr/bin/python3 \\
        benchmarks/vtk_plugin/vtk_tests.py [--pictures FOLDER] [NAME...]

Each scene is drawn twice, with VTK's mapper at steps of a tenth of a voxel and with the mapper that
the same line of code gives after pellucid.vtk.use(). Prints a table in Markdown: `same` where at
most 0.5 % of the pixels differ by more than 3 of 255, else why. Ends with 1 if a scene that is to
be the same is not, or one that differs has no explanation.
"""
import argparse
import sys

import numpy
import vtkmodules.all as vtk

import pellucid.vtk
from stage import Messages, Stage, ball, property_of, tetrahedra, waves

STEP = 0.1
SAME_PIXELS = 0.005
SAME_STEPS = 3

SOFT = ((37, 0), (140, 0.01), (277, 0.25))
WARM = ((37, 0, 0, 0.4), (160, 0.9, 0.4, 0.1), (277, 1, 1, 0.8))
BALL = ((0, 0), (90, 0), (160, 0.1), (255, 0.5))
BLUE = ((0, 0, 0, 0.6), (128, 0.2, 0.7, 0.3), (255, 1, 0.9, 0.5))

SCENES = {}


def scene(what, explained=None, refused=None):
    """Adds a scene: a function of a maker of mappers that returns a Stage."""
    def add(make):
        SCENES[make.__name__.replace("_", " ")] = (what, explained, refused, make)
        return make
    return add


def fine(mapper):
    if hasattr(mapper, "SetAutoAdjustSampleDistances"):
        mapper.SetAutoAdjustSampleDistances(0)
    if hasattr(mapper, "SetSampleDistance"):
        mapper.SetSampleDistance(STEP)
    if hasattr(mapper, "UseJitteringOff"):
        mapper.UseJitteringOff()
    return mapper


def smart():
    mapper = fine(vtk.vtkSmartVolumeMapper())
    mapper.SetInteractiveAdjustSampleDistances(0)
    return mapper


def gpu():
    return fine(vtk.vtkGPUVolumeRayCastMapper())


def staged(mapper, data=None, look=None, **options):
    stage = Stage(mapper, waves() if data is None else data,
                  property_of(SOFT, WARM) if look is None else look, **options)
    stage.aim()
    return stage


@scene("vtkSmartVolumeMapper, composite")
def TestSmartVolumeMapper():
    return staged(smart())


@scene("vtkGPUVolumeRayCastMapper, light")
def TestGPUVolumeRayCastMapper():
    return staged(gpu(), ball(), property_of(BALL, BLUE, shade=True))


@scene("parallel projection")
def TestGPURayCastPerspectiveParallel():
    stage = staged(gpu())
    stage.camera.ParallelProjectionOn()
    stage.renderer.ResetCameraClippingRange()
    return stage


@scene("maximum intensity")
def TestGPURayCastDataTypesMIP():
    mapper = gpu()
    mapper.SetBlendModeToMaximumIntensity()
    return staged(mapper)


@scene("minimum intensity")
def TestGPURayCastDataTypesMinIP():
    mapper = gpu()
    mapper.SetBlendModeToMinimumIntensity()
    return staged(mapper, look=property_of(((37, 0.9), (277, 0)), WARM))


@scene("average intensity")
def TestGPURayCastAverageIP():
    mapper = gpu()
    mapper.SetBlendModeToAverageIntensity()
    return staged(mapper, look=property_of(((37, 0.8), (277, 0.8)), WARM))


@scene("additive")
def TestGPURayCastAdditive():
    mapper = gpu()
    mapper.SetBlendModeToAdditive()
    return staged(mapper, look=property_of(((37, 0), (140, 0.004), (277, 0.05)), WARM))


@scene("isosurfaces in light",
       explained="VTK finds a surface between two samples, and reflects by Phong's formula")
def TestGPURayCastIsosurface():
    mapper = gpu()
    mapper.SetBlendModeToIsoSurface()
    look = property_of(((37, 0.4), (277, 0.6)), WARM, shade=True)
    look.GetIsoSurfaceValues().SetValue(0, 180)
    look.GetIsoSurfaceValues().SetValue(1, 230)
    return staged(mapper, look=look)


@scene("a slice along a plane",
       explained="VTK 9.1 stretches a slice by a voxel, from its outer values to their faces")
def TestGPURayCastSlicePlane():
    mapper = gpu()
    mapper.SetBlendModeToSlice()
    look = property_of(((37, 1), (277, 1)), WARM)
    plane = vtk.vtkPlane()
    plane.SetOrigin(2, 1, 0)
    plane.SetNormal(0.4, 0.3, 1)
    look.SetSliceFunction(plane)
    return staged(mapper, look=look)


@scene("cropping to the middle box",
       explained="VTK 9.1's GPU mapper crops up to half a voxel outside of its planes")
def TestGPURayCastCropping():
    mapper = gpu()
    mapper.CroppingOn()
    mapper.SetCroppingRegionFlagsToSubVolume()
    mapper.SetCroppingRegionPlanes(-8, 9, -12, 6, -5, 14)
    return staged(mapper)


@scene("cropping to a fence",
       explained="VTK 9.1's GPU mapper crops up to half a voxel outside of its planes")
def TestGPURayCastCroppingRegions():
    mapper = gpu()
    mapper.CroppingOn()
    mapper.SetCroppingRegionFlagsToFence()
    mapper.SetCroppingRegionPlanes(-8, 9, -12, 6, -5, 14)
    return staged(mapper)


@scene("clipping planes",
       explained="VTK begins to sample a part of a step behind the plane")
def TestGPURayCastClipping():
    mapper = gpu()
    for origin, normal in (((4, 0, 0), (-1, 0.3, 0)), ((0, 3, 0), (0.1, -1, 0.2))):
        plane = vtk.vtkPlane()
        plane.SetOrigin(*origin)
        plane.SetNormal(*normal)
        mapper.AddClippingPlane(plane)
    return staged(mapper)


@scene("gradient opacity",
       explained="a gradient opacity multiplies the extinction here, in VTK a sample's opacity")
def TestGPURayCastGradientOpacity():
    look = property_of(BALL, BLUE)
    gradient = vtk.vtkPiecewiseFunction()
    gradient.AddPoint(0, 0)
    gradient.AddPoint(12, 0.8)
    gradient.AddPoint(20, 1)
    look.SetGradientOpacity(gradient)
    return staged(gpu(), ball(), look)


@scene("binary mask")
def TestGPURayCastCompositeBinaryMask():
    mapper = gpu()
    mapper.SetMaskInput(halves(mapper, 255))
    mapper.SetMaskTypeToBinary()
    return staged(mapper, ball(), property_of(BALL, BLUE))


@scene("map of labels with a blend factor",
       explained="VTK 9.1 does not fit the opacities of labels to its steps of 0.1")
def TestGPURayCastCompositeMaskBlend():
    mapper = gpu()
    mapper.SetMaskInput(halves(mapper, 1))
    mapper.SetMaskTypeToLabelMap()
    mapper.SetMaskBlendFactor(0.5)
    look = property_of(BALL, BLUE)
    red = vtk.vtkColorTransferFunction()
    red.AddRGBPoint(0, 1, 0, 0)
    look.SetLabelColor(1, red)
    look.SetLabelScalarOpacity(1, look.GetScalarOpacity())
    return staged(mapper, ball(), look)


def halves(_, inside):
    mask = vtk.vtkImageData()
    mask.SetDimensions(40, 40, 40)
    mask.AllocateScalars(vtk.VTK_UNSIGNED_CHAR, 1)
    memory = numpy.asarray(memoryview(mask.GetPointData().GetScalars())).reshape(40, 40, 40)
    memory[...] = 0
    memory[:, :, :23] = inside
    return mask


@scene("cell data",
       explained="cells hold their value to their faces, and half a cell at the border is there")
def TestGPURayCastCellData():
    cells = vtk.vtkPointDataToCellData()
    cells.SetInputData(waves(24))
    cells.Update()
    image = vtk.vtkImageData()
    image.CopyStructure(cells.GetOutput())
    image.GetCellData().SetScalars(cells.GetOutput().GetCellData().GetArray("RTData"))
    return staged(gpu(), image)


@scene("rectilinear grid",
       explained="VTK 9.1 shows a value of a rectilinear grid up to a cell aside")
def TestGPURayCastMapperRectilinearGrid():
    image = waves(24)
    grid = vtk.vtkRectilinearGrid()
    grid.SetDimensions(25, 25, 25)
    for axis in "XYZ":
        places = vtk.vtkDoubleArray()
        for i in range(25):
            places.InsertNextValue(i + 0.03 * i * i)
        getattr(grid, f"Set{axis}Coordinates")(places)
    grid.GetPointData().SetScalars(image.GetPointData().GetScalars())
    return staged(gpu(), grid)


@scene("unevenly scaled volume",
       explained="VTK's unit distance is scaled along the ray, here by the mean of the scales")
def TestGPURayCastVolumeScale():
    stage = staged(gpu())
    stage.volume.SetScale(1, 1.5, 0.7)
    stage.aim()
    return stage


@scene("turned, scaled and moved volume")
def TestGPURayCastVolumeRotation():
    stage = staged(gpu())
    stage.volume.RotateX(30)
    stage.volume.RotateZ(-40)
    stage.volume.SetScale(2, 2, 2)
    stage.volume.SetPosition(4, 5, 6)
    stage.aim()
    return stage


@scene("direction matrix of the image")
def TestGPURayCastVolumeOrientation():
    image = waves()
    image.SetDirectionMatrix(0, 0, 1, 1, 0, 0, 0, 1, 0)
    return staged(gpu(), image)


@scene("volume among geometry")
def TestGPURayCastVolumePolyData():
    stage = staged(gpu())
    sphere = vtk.vtkSphereSource()
    sphere.SetCenter(15, 0, 0)
    sphere.SetRadius(10)
    sphere.SetThetaResolution(60)
    sphere.SetPhiResolution(60)
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputConnection(sphere.GetOutputPort())
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    stage.renderer.AddActor(actor)
    stage.aim()
    return stage


@scene("two lights in the scene, one positional",
       explained="VTK reflects by Phong's formula, here it is Blinn's")
def TestGPURayCastPositionalLights():
    stage = staged(gpu(), ball(), property_of(BALL, BLUE, shade=True))
    for position, color in (((120, 40, 60), (1, 0.2, 0.2)), ((-60, 10, 60), (0.2, 0.4, 1))):
        light = vtk.vtkLight()
        light.SetLightTypeToSceneLight()
        light.SetPosition(*position)
        light.SetFocalPoint(20, 20, 20)
        light.SetPositional(color[0] == 1)
        light.SetConeAngle(90)
        light.SetColor(*color)
        stage.renderer.AddLight(light)
    return stage


@scene("two independent components",
       explained="components mix as particles do; VTK adds their colors by opacity")
def TestGPURayCastTwoComponentsIndependent():
    look = property_of(BALL, BLUE)
    look.SetScalarOpacity(1, look.GetScalarOpacity(0))
    red = vtk.vtkColorTransferFunction()
    red.AddRGBPoint(0, 1, 0.2, 0.1)
    look.SetColor(1, red)
    return staged(gpu(), ball(components=2), look)


@scene("two dependent components")
def TestGPURayCastTwoComponentsDependent():
    look = property_of(BALL, BLUE)
    look.IndependentComponentsOff()
    return staged(gpu(), ball(components=2), look)


@scene("four dependent components")
def TestGPURayCastFourComponentsDependent():
    look = property_of(BALL, BLUE)
    look.IndependentComponentsOff()
    return staged(gpu(), ball(components=4), look)


@scene("function of two variables", refused="a function of value and gradient, by a picture")
def TestGPURayCastTransfer2D():
    look = property_of(BALL, BLUE)
    table = vtk.vtkImageData()
    table.SetDimensions(8, 8, 1)
    table.AllocateScalars(vtk.VTK_FLOAT, 4)
    numpy.asarray(memoryview(table.GetPointData().GetScalars()))[...] = 0.1
    look.SetTransferFunction2D(table)
    return staged(gpu(), ball(), look)


@scene("maximum intensity of nearest values",
       explained="nearest values are shown by compositing alone; a maximum is of trilinear data")
def TestGPURayCastNearestDataTypesMIP():
    mapper = gpu()
    mapper.SetBlendModeToMaximumIntensity()
    look = property_of(((0, 0), (255, 1)), BLUE)
    look.SetInterpolationTypeToNearest()
    return staged(mapper, ball(), look)


@scene("nearest values, composite")
def TestFixedPointRayCasterNearest():
    look = property_of(BALL, BLUE)
    look.SetInterpolationTypeToNearest()
    return staged(gpu(), ball(16), look)


@scene("window and level of the final color")
def TestFinalColorWindowLevel():
    mapper = smart()
    mapper.SetFinalColorWindow(0.6)
    mapper.SetFinalColorLevel(0.4)
    return staged(mapper)


@scene("window of half the size in a corner")
def TestGPURayCastVolumeViewport():
    stage = staged(gpu(), size=(300, 200))
    stage.renderer.SetViewport(0.5, 0.5, 1, 1)
    stage.aim()
    return stage


@scene("inside of the volume")
def TestGPURayCastCameraInsideSmallSpacing():
    stage = staged(gpu())
    stage.camera.SetPosition(0, 2, 3)
    stage.camera.SetFocalPoint(10, 0, 0)
    stage.camera.SetClippingRange(0.01, 100)
    return stage


@scene("projected tetrahedra",
       explained="VTK integrates a tetrahedron by its mean, and blends in 8 bits")
def ProjectedTetrahedra():
    mapper = vtk.vtkProjectedTetrahedraMapper()
    return staged(mapper, tetrahedra(ball(12)), property_of(BALL, BLUE, unit=1))


def run(name, folder):
    what, explained, refused, make = SCENES[name]
    pellucid.vtk.use(False)
    with Messages():
        theirs = make().picture().astype(int)
    pellucid.vtk.use()
    with Messages() as said:
        stage = make()
        ours = stage.picture().astype(int)
    settings = pellucid.vtk.settings(stage.mapper)
    refusals = [line for line in said.lines if "draws nothing" in line]
    off = abs(ours - theirs).max(axis=2)
    share = (off > SAME_STEPS).mean()
    result = {"name": name.replace(" ", "_"), "what": what, "largest": int(off.max()),
              "rms": float(numpy.sqrt((off ** 2).mean())), "share": float(share)}
    if folder:
        save(numpy.hstack([theirs, ours]), f"{folder}/{result['name']}.png")
    if refusals:
        result["verdict"] = "not supported: " + refused if refused else "FAILED: " + refusals[0]
    elif refused:
        result["verdict"] = "FAILED: was to be refused"
    elif not settings.exact or settings.pixels_over:
        result["verdict"] = f"FAILED: {settings.pixels_over} pixels over the tolerance"
    elif share <= SAME_PIXELS:
        result["verdict"] = "same"
    else:
        result["verdict"] = "explained: " + explained if explained else "FAILED: differs"
    return result


def save(picture, path):
    data = vtk.vtkImageData()
    height, width = picture.shape[:2]
    data.SetDimensions(width, height, 1)
    data.AllocateScalars(vtk.VTK_UNSIGNED_CHAR, 3)
    numpy.asarray(memoryview(data.GetPointData().GetScalars()))[...] = picture[::-1].reshape(-1, 3)
    writer = vtk.vtkPNGWriter()
    writer.SetFileName(path)
    writer.SetInputData(data)
    writer.Write()


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--pictures", help="folder for pictures: VTK's on the left, ours beside it")
    parser.add_argument("names", nargs="*", help="scenes; default: all")
    arguments = parser.parse_args()
    vtk.vtkLogger.SetStderrVerbosity(vtk.vtkLogger.VERBOSITY_OFF)
    print("| VTK's test | scene | largest / 255 | RMS / 255 | pixels over 3 | |")
    print("|---|---|---|---|---|---|")
    failed = False
    for name in SCENES:
        if arguments.names and not any(part in name for part in arguments.names):
            continue
        r = run(name, arguments.pictures)
        nothing = r["verdict"].startswith("not supported")
        numbers = "| | | " if nothing else (f"| {r['largest']} | {r['rms']:.2g} | "
                                            f"{100 * r['share']:.2g} % ")
        print(f"| {r['name']} | {r['what']} {numbers}| {r['verdict']} |", flush=True)
        failed |= r["verdict"].startswith("FAILED")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
