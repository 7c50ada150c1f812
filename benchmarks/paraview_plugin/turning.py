# SPDX-License-Identifier: Apache-2.0
"""Time of frames while a volume turns: ParaView's representation "Volume" and ours, frame by frame.

    xvfb-run -a pvpython benchmarks/paraview_plugin/turning.py PLUGIN [--frames N] [FILE...]

PLUGIN is Pellucid.so. Both have ParaView's defaults; ours holds 1/512. The data are ParaView's
Wavelet, as an image and as an unstructured grid of its cells, and the files, each by its first
array. Prints a table in Markdown: the medians of the frames, their ratio, and how far each picture
is from ours at 1/2048.
"""
import argparse
import os
import statistics
import sys
import time

from paraview import simple
from vtkmodules.util import numpy_support

OURS = "Volume (Pellucid)"


def picture(view):
    image = view.CaptureWindow(1)
    return numpy_support.vtk_to_numpy(image.GetPointData().GetScalars()).astype(int)


def frame(view):
    camera = view.GetActiveCamera()
    camera.Azimuth(7)
    start = time.perf_counter()
    simple.Render(view)
    view.GetRenderWindow().WaitForCompletion()
    return time.perf_counter() - start


def stage(source, kind, mapper=None):
    view = simple.CreateView("RenderView")
    view.ViewSize = [256, 256]
    view.OrientationAxesVisibility = view.UseFXAA = 0
    view.UseColorPaletteForBackground = 0
    view.Background = [0, 0, 0]
    display = simple.Show(source, view)
    arrays = source.PointData
    simple.ColorBy(display, ("POINTS", arrays.GetArray(0).Name))
    display.SetScalarBarVisibility(view, False)
    display.SetRepresentationType(kind)
    if mapper:
        display.SelectMapper = mapper
    simple.ResetCamera(view)
    view.GetActiveCamera().Elevation(15)
    return view, display


def rows(source, name):
    mappers = [None]
    if "Unstructured" in source.GetDataInformation().GetDataSetTypeAsString():
        mappers = ["Projected tetra", "Bunyk ray cast"]
    for mapper in mappers:
        theirs, _ = stage(source, "Volume", mapper)
        ours, display = stage(source, OURS)
        seconds = {theirs: [], ours: []}
        for _ in range(ARGUMENTS.frames + 1):  # the first makes tables
            for view in (theirs, ours):
                seconds[view].append(frame(view))
        medians = [statistics.median(seconds[view][1:]) for view in (theirs, ours)]
        pictures = [picture(view) for view in (theirs, ours)]
        display.Tolerance = 1 / 2048
        truth = picture(ours)
        off = [abs(shown - truth).max() for shown in pictures]
        print(f"| {name} | {mapper or 'Volume'} | {medians[0]:.3f} s | {medians[1]:.3f} s | "
              f"{medians[1] / medians[0]:.2f} | {off[0]} / 255 | {off[1]} / 255 |", flush=True)
        simple.Delete(theirs)
        simple.Delete(ours)


def main():
    simple.LoadPlugin(os.path.realpath(ARGUMENTS.plugin), remote=False, ns=globals())
    print("| data | ParaView's | ParaView | ours | ratio | ParaView off by | ours off by |")
    print("|---|---|---|---|---|---|---|")
    image = simple.Wavelet(WholeExtent=[-32, 31, -32, 31, -32, 31])
    image.UpdatePipeline()
    rows(image, "Wavelet, 64³")
    small = simple.Wavelet(WholeExtent=[-8, 8, -8, 8, -8, 8])
    cells = simple.AppendDatasets(Input=[small])
    cells.UpdatePipeline()
    rows(cells, "cells of Wavelet, 16³")
    for path in ARGUMENTS.files:
        source = simple.OpenDataFile(path)
        source.UpdatePipeline()
        rows(source, os.path.basename(path))
    return 0


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("plugin")
    parser.add_argument("--frames", type=int, default=5)
    parser.add_argument("files", nargs="*")
    ARGUMENTS = parser.parse_args()
    sys.exit(main())
