#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Time and error of one look after the other: VTK's two mappers on the CPU, and ours.

    PYTHONPATH=build/release/lib/python3.11/dist-packages xvfb-run -a /usr/bin/python3 \\
        benchmarks/vtk_plugin/looks.py [--frames N] [--size N] [VOLUME.nii.gz...]

`vtkSmartVolumeMapper` and `vtkFixedPointVolumeRayCastMapper` have VTK's defaults, ours holds 1/512,
on the same cores in one run, frame by frame in turn. The volumes are the brain MRI of the Debian
package mricron-data and those that are given. Prints a table in Markdown: medians of the frames,
ours over each of VTK's, and how far each picture is from ours at 1/4096. A look that a mapper
leaves out has no time.
"""
import argparse
import os
import statistics
import sys

import vtkmodules.all as vtk

import pellucid.vtk
from stage import BRAIN, Stage
from turning import frame, look, read


def unlit(stage, data):
    pass


def head_light(stage, data):
    stage.look.ShadeOn()


def point_light(stage, data):
    stage.look.ShadeOn()
    light = vtk.vtkLight()
    light.SetLightTypeToSceneLight()
    light.SetPositional(True)
    light.SetConeAngle(180)
    bounds = data.GetBounds()
    light.SetPosition(bounds[1] + 60, bounds[2] - 80, bounds[5] + 40)
    stage.renderer.RemoveAllLights()
    stage.renderer.SetAutomaticLightCreation(False)
    stage.renderer.AddLight(light)


def gradient_opacity(stage, data):
    stage.look.ShadeOn()
    low, high = data.GetScalarRange()
    factor = vtk.vtkPiecewiseFunction()
    for share, value in ((0, 0.1), (0.03, 0.4), (0.15, 1)):
        factor.AddPoint(share * (high - low), value)
    stage.look.SetGradientOpacity(factor)


def clipped(stage, data):
    plane = vtk.vtkPlane()
    plane.SetOrigin(data.GetCenter())
    plane.SetNormal(0.2, 1, 0.1)
    stage.mapper.AddClippingPlane(plane)


def clipped_in_light(stage, data):
    head_light(stage, data)
    clipped(stage, data)


LOOKS = {"no light": unlit, "head light": head_light, "point light": point_light,
         "gradient opacity, head light": gradient_opacity, "a clipping plane": clipped,
         "a clipping plane, head light": clipped_in_light}
MAPPERS = {"smart": (vtk.vtkSmartVolumeMapper, False),
           "fixed": (vtk.vtkFixedPointVolumeRayCastMapper, False),
           "ours": (vtk.vtkSmartVolumeMapper, True)}


def stage_of(name, data, change, size):
    make, ours = MAPPERS[name]
    pellucid.vtk.use(ours)
    made = Stage(make(), data, look(data, False), (size, size))
    pellucid.vtk.use(False)
    change(made, data)
    made.aim(0, 15)
    return made


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--frames", type=int, default=3)
    parser.add_argument("--size", type=int, default=512)
    parser.add_argument("volumes", nargs="*")
    arguments = parser.parse_args()
    vtk.vtkLogger.SetStderrVerbosity(vtk.vtkLogger.VERBOSITY_OFF)
    print("| volume | look | smart | fixed point | ours | ours / smart | ours / fixed point | "
          "smart off by | fixed point off by | ours off by |")
    print("|" + "---|" * 10)
    for path in [str(BRAIN), *arguments.volumes]:
        data = read(path)
        name = os.path.basename(path).split(".")[0]
        for title, change in LOOKS.items():
            stages = {key: stage_of(key, data, change, arguments.size) for key in MAPPERS}
            seconds = {key: [] for key in MAPPERS}
            for _ in range(arguments.frames + 1):  # the first makes tables
                for key, one in stages.items():
                    seconds[key].append(frame(one))
            median = {key: statistics.median(of[1:]) for key, of in seconds.items()}
            pictures = {key: one.picture().astype(int) for key, one in stages.items()}
            pellucid.vtk.settings(stages["ours"].mapper).tolerance = 1 / 4096
            truth = stages["ours"].picture().astype(int)
            off = {key: abs(picture - truth).max() for key, picture in pictures.items()}
            cells = [name, title, *(f"{median[key]:.3f} s" for key in MAPPERS),
                     f"{median['ours'] / median['smart']:.2f}",
                     f"{median['ours'] / median['fixed']:.2f}",
                     *(f"{off[key]} / 255" for key in MAPPERS)]
            print("| " + " | ".join(cells) + " |", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
