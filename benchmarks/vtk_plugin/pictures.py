#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""The pictures of docs/how-to/vtk.md.

    PYTHONPATH=build/release/lib/python3.11/dist-packages xvfb-run -a /usr/bin/python3 \\
        benchmarks/vtk_plugin/pictures.py docs/images
"""
import sys

import numpy
import vtkmodules.all as vtk

import pellucid.vtk
from stage import BRAIN, Stage, property_of, waves
from turning import read
from vtk_tests import save


def brain(ours):
    pellucid.vtk.use(ours)
    look = property_of([(30, 0), (80, 0), (90, 0.15), (100, 0), (140, 0.5)],
                       [(30, 0.3, 0.1, 0.1), (95, 0.8, 0.4, 0.2), (140, 1, 0.95, 0.85)])
    stage = Stage(vtk.vtkSmartVolumeMapper(), read(BRAIN), look, (320, 320), (0.08, 0.1, 0.16))
    pellucid.vtk.use(False)
    stage.camera.SetFocalPoint(0, 0, 0)
    stage.camera.SetPosition(0.8, 1, 0.4)
    stage.camera.SetViewUp(0, 0, 1)
    stage.aim(0, 0, 1.4)
    return stage.picture()


def ball(azimuth):
    pellucid.vtk.use()
    look = property_of(((60, 0), (160, 0.01), (277, 0.12)),
                       ((37, 0, 0, 0.4), (160, 0.9, 0.4, 0.1), (277, 1, 1, 0.8)))
    stage = Stage(vtk.vtkSmartVolumeMapper(), waves(), look, (320, 320), (0.08, 0.1, 0.16))
    pellucid.vtk.use(False)
    sphere = vtk.vtkSphereSource()
    sphere.SetCenter(18, 0, 0)
    sphere.SetRadius(10)
    sphere.SetThetaResolution(100)
    sphere.SetPhiResolution(100)
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputConnection(sphere.GetOutputPort())
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(0.3, 0.8, 0.5)
    stage.renderer.AddActor(actor)
    stage.aim(azimuth, 20, 1.3)
    return stage.picture()


def main():
    folder = sys.argv[1]
    vtk.vtkLogger.SetStderrVerbosity(vtk.vtkLogger.VERBOSITY_OFF)
    theirs, ours = brain(False), brain(True)
    off = abs(theirs.astype(int) - ours.astype(int))
    print("largest difference", off.max(), "of 255")
    difference = numpy.clip(8 * off, 0, 255).astype("u1")
    save(numpy.hstack([theirs, ours, difference]), f"{folder}/vtk_brain.png")
    save(numpy.hstack([ball(60), ball(-60)]), f"{folder}/vtk_ball.png")


if __name__ == "__main__":
    main()
