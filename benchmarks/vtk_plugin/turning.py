#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Time of frames while a volume turns: vtkSmartVolumeMapper by VTK and by us, frame after frame.

    PYTHONPATH=build/release/lib/python3.11/dist-packages xvfb-run -a /usr/bin/python3 \\
        benchmarks/vtk_plugin/turning.py [--frames N] [--rate R] [VOLUME.nii.gz...]

Both mappers have VTK's defaults; ours holds 1/512. With --rate the window asks for R frames a
second, as an interactor does while the user turns: then both show what they have in time. The
volumes are the brain MRI of the Debian package mricron-data and those that are given. Prints a
table in Markdown: the medians of the frames, their ratio, and how far each picture is from ours at
1/2048.
"""
import argparse
import os
import statistics
import sys
import time

import vtkmodules.all as vtk

import pellucid.vtk
from stage import BRAIN, Stage, property_of

SIZE = (512, 512)


def read(path):
    reader = vtk.vtkNIFTIImageReader()
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def look(data, shade):
    low, high = data.GetScalarRange()
    at = [low + share * (high - low) for share in (0.2, 0.4, 0.6, 1)]
    return property_of(list(zip(at, (0, 0.02, 0.1, 0.3))),
                       [(at[0], 0.3, 0.1, 0), (at[1], 0.9, 0.5, 0.2), (at[2], 1, 0.8, 0.6),
                        (at[3], 1, 1, 1)], shade, min(data.GetSpacing()))


def stage(data, shade, ours):
    pellucid.vtk.use(ours)
    made = Stage(vtk.vtkSmartVolumeMapper(), data, look(data, shade), SIZE)
    pellucid.vtk.use(False)
    made.aim(0, 15)
    return made


def frame(one):
    one.camera.Azimuth(7)
    one.renderer.ResetCameraClippingRange()
    start = time.perf_counter()
    one.window.Render()
    one.window.WaitForCompletion()
    return time.perf_counter() - start


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--frames", type=int, default=7)
    parser.add_argument("--rate", type=float, help="frames a second that the window asks for")
    parser.add_argument("volumes", nargs="*")
    arguments = parser.parse_args()
    vtk.vtkLogger.SetStderrVerbosity(vtk.vtkLogger.VERBOSITY_OFF)
    print("| volume | look | VTK | ours | ratio | VTK off by | ours off by |")
    print("|---|---|---|---|---|---|---|")
    for path in [str(BRAIN), *arguments.volumes]:
        data = read(path)
        name = os.path.basename(path).split(".")[0] + " " + " × ".join(
            map(str, data.GetDimensions()))
        for shade in (False, True):
            theirs, ours = stage(data, shade, False), stage(data, shade, True)
            seconds = {theirs: [], ours: []}
            if arguments.rate:
                for one in (theirs, ours):
                    one.window.Render()
                    one.window.SetDesiredUpdateRate(arguments.rate)
            for _ in range(arguments.frames + 1):  # the first makes tables
                for one in (theirs, ours):
                    seconds[one].append(frame(one))
            medians = [statistics.median(seconds[one][1:]) for one in (theirs, ours)]
            pictures = [one.picture().astype(int) for one in (theirs, ours)]
            ours.window.SetDesiredUpdateRate(0.0001)
            pellucid.vtk.settings(ours.mapper).tolerance = 1 / 2048
            truth = ours.picture().astype(int)
            off = [abs(picture - truth).max() for picture in pictures]
            print(f"| {name} | {'light' if shade else 'no light'} | {medians[0]:.3f} s | "
                  f"{medians[1]:.3f} s | {medians[1] / medians[0]:.2f} | {off[0]} / 255 | "
                  f"{off[1]} / 255 |", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
