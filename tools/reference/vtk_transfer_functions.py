#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Colors and opacities of transfer functions as VTK evaluates them, for tests/io.

usage: vtk_transfer_functions.py FOLDER [--check]

Writes into FOLDER (tests/io/transfer_functions) a file of each case, as ParaView or 3D Slicer
writes it, and vtk_values.csv: case,value,r,g,b,opacity at values within the pieces. The numbers
come from vtkColorTransferFunction::GetColor and vtkPiecewiseFunction::GetValue of VTK 9.1 (Debian:
python3-vtk9). With --check nothing is written, and the values that VTK gives now are compared with
those that stand there; exit code 77 where VTK's Python modules are missing. Opacities of VTK 9.3 do
not jump at a sharpness above 0.99: there those of slicer_jump are not compared.
"""

import csv
import json
import pathlib
import sys

try:
    from vtkmodules.vtkCommonDataModel import vtkPiecewiseFunction
    from vtkmodules.vtkRenderingCore import vtkColorTransferFunction
except ImportError as error:
    print(f"skipped: {error} (Debian: python3-vtk9)")
    sys.exit(77)

COOL_TO_WARM = [0, 0.231373, 0.298039, 0.752941, 0.5, 0.865003, 0.865003, 0.865003,
                1, 0.705882, 0.0156863, 0.14902]
RAINBOW = [-100, 0, 0, 1, 50, 0, 1, 0.4, 120, 1, 1, 0, 300, 1, 0, 0]
RAMP = [-100, 0, 0.5, 0, 100, 0.2, 0.5, 0, 300, 0.8, 0.5, 0]
HAZE = [0, 0, 0.5, 0, 1, 0.5, 0.5, 0]


def paraview(space, points, opacities, **others):
    return [{"Name": "case", "ColorSpace": space, "RGBPoints": points, "Points": opacities,
             **others}]


def slicer(colors, opacities, unit):
    return {
        "@schema": "volume-property-schema-v1.0.0.json#",
        "volumeProperties": [{"components": [{
            "scalarOpacityUnitDistance": unit,
            "rgbTransferFunction": {"type": "colorTransferFunction", "points": [
                {"x": x, "color": c, "midpoint": m, "sharpness": s} for x, c, m, s in colors]},
            "scalarOpacity": {"type": "piecewiseFunction", "points": [
                {"x": x, "y": y, "midpoint": m, "sharpness": s} for x, y, m, s in opacities]}}]}]}


CASES = {
    "rgb": paraview("RGB", RAINBOW, RAMP),
    "hsv": paraview("HSV", RAINBOW, RAMP, HSVWrap=1),
    "hsv_wrapped": paraview("HSV", [0, 1, 0.2, 0.4, 0.4, 0.9, 0.6, 0.1, 1, 0.5, 0.1, 1], HAZE,
                            HSVWrap=1),
    "hsv_not_wrapped": paraview("HSV", [0, 1, 0, 0.4, 1, 1, 0.6, 0.1], HAZE, HSVWrap=0),
    "hsv_grey": paraview("HSV", [0, 0.3, 0.3, 0.3, 1, 0.2, 0.4, 0.9], HAZE, HSVWrap=1),
    "lab": paraview("Lab", RAINBOW, RAMP),
    "lab_dark": paraview("Lab", [0, 0, 0, 0, 1, 0.02, 0.05, 0.1], HAZE),
    "diverging": paraview("Diverging", [0, 0.230, 0.299, 0.754, 1, 0.706, 0.016, 0.150], HAZE),
    "diverging_three": paraview("Diverging", COOL_TO_WARM, HAZE),
    "diverging_alike": paraview("Diverging", [0, 0.9, 0.2, 0.1, 1, 0.6, 0.3, 0.05], HAZE),
    "diverging_from_white": paraview("Diverging", [0, 1, 1, 1, 1, 0.2, 0.6, 0.3], HAZE),
    "step": paraview("Step", RAINBOW, RAMP),
    "slicer": slicer([(-50, [0, 0, 0], 0.5, 0), (40, [0.5, 0.2, 0.1], 0.3, 0),
                      (100, [1, 1, 0.9], 0.5, 0)],
                     [(-50, 0, 0.5, 0), (40, 0.3, 0.2, 0), (100, 0.9, 0.5, 0)], 2.5),
    "slicer_jump": slicer([(0, [1, 0, 0], 0.5, 1), (1, [0, 0, 1], 0.5, 0)],
                          [(0, 0.1, 0.7, 1), (1, 0.6, 0.5, 0)], 1),
    "slicer_hermite": slicer([(0, [1, 0, 0.2], 0.4, 0.3), (1, [0, 0.7, 1], 0.5, 0)],
                             [(0, 0.1, 0.6, 0.5), (1, 0.7, 0.3, 0.05), (2, 0.2, 0.5, 0)], 1),
    "slicer_from_zero": slicer([(0, [1, 1, 1], 0.5, 0)],
                               [(0, 0, 0.5, 0.2), (1, 1, 0.5, 0.2), (2, 0, 0.5, 0)], 1),
}

SPACES = {"RGB": "SetColorSpaceToRGB", "HSV": "SetColorSpaceToHSV", "Lab": "SetColorSpaceToLab",
          "Diverging": "SetColorSpaceToDiverging", "Step": "SetColorSpaceToStep"}


def functions(case):
    """VTK's two functions of a case, and the values of their nodes."""
    color, opacity = vtkColorTransferFunction(), vtkPiecewiseFunction()
    nodes = set()
    if isinstance(case, list):
        points, flat = case[0]["RGBPoints"], case[0]["Points"]
        getattr(color, SPACES[case[0]["ColorSpace"]])()
        color.SetHSVWrap(case[0].get("HSVWrap", 0))
        for i in range(0, len(points), 4):
            color.AddRGBPoint(*points[i:i + 4])
        for i in range(0, len(flat), 4):
            opacity.AddPoint(*flat[i:i + 4])
        nodes.update(points[::4] + flat[::4])
    else:
        component = case["volumeProperties"][0]["components"][0]
        for p in component["rgbTransferFunction"]["points"]:
            color.AddRGBPoint(p["x"], *p["color"], p["midpoint"], p["sharpness"])
            nodes.add(p["x"])
        for p in component["scalarOpacity"]["points"]:
            opacity.AddPoint(p["x"], p["y"], p["midpoint"], p["sharpness"])
            nodes.add(p["x"])
    return color, opacity, sorted(nodes)


def rows():
    for name, case in CASES.items():
        color, opacity, nodes = functions(case)
        span = max(nodes[-1] - nodes[0], 1)
        values = [nodes[0] - span, nodes[-1] + span]
        for a, b in zip(nodes, nodes[1:]):
            # No binary fractions, where jumps and midpoints lie.
            values += [a + (b - a) * (k + 0.37) / 12 for k in range(12)]
        for value in values:
            yield [name, value, *color.GetColor(value), opacity.GetValue(value)]


def main():
    folder = pathlib.Path(sys.argv[1])
    table = folder / "vtk_values.csv"
    if "--check" in sys.argv:
        with table.open(newline="") as file:
            stands = list(csv.reader(file))[1:]
        now = [[name, *map(float, numbers)] for name, *numbers in rows()]
        if len(now) != len(stands):
            print(f"{len(stands)} rows, but VTK gives {len(now)}")
            return 1
        jump = functions(CASES["slicer_jump"])[1].GetValue(0.69) == 0.1
        worst = 0.0
        for old, new in zip(stands, now):
            end = None if jump or old[0] != "slicer_jump" else -1
            worst = max(worst, *(abs(float(a) - b) for a, b in zip(old[1:end], new[1:end])))
        files = all(json.loads((folder / f"{name}.json").read_text()) == case
                    for name, case in CASES.items())
        print(f"{len(now)} rows; largest difference {worst:.3g}; "
              f"files {'agree' if files else 'differ'}")
        return 0 if worst <= 1e-12 and files else 1
    for name, case in CASES.items():
        (folder / f"{name}.json").write_text(json.dumps(case, indent=1) + "\n")
    with table.open("w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["case", "value", "r", "g", "b", "opacity"])
        for row in rows():
            writer.writerow([row[0], *map(repr, row[1:])])
    return 0


if __name__ == "__main__":
    sys.exit(main())
