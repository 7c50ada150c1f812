#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the tables of color maps: src/scene/looks/color_map_table.cpp and
tests/scene/color_maps.csv.

    tools/color_maps.py --paraview ColorMaps.json --batlow batlow.cpt

Needs matplotlib and VTK's Python packages (Debian: python3-matplotlib, python3-vtk9).
ColorMaps.json is ParaView's Remoting/Views/ColorMaps.json. Debian has its text only inside of
libvtkRemotingViews-pv5.11.so, which may be given instead. batlow.cpt is GMT's
(Debian: gmt-common, /usr/share/gmt/cpt/SCM/batlow.cpt).

The renderer interpolates colors linearly in linear light. Each map gets the points that a greedy
search finds, from the left, such that this interpolation differs from the map by less than `STEP`
8-bit steps of any sRGB channel, at 2041 positions.
"""
import argparse
import csv
import json
import pathlib

import numpy

ROOT = pathlib.Path(__file__).resolve().parent.parent
STEP = 0.9  # of 255; below the 1 that color_map.h states, for the rounding of the table
GRID = numpy.linspace(0, 1, 2041)

# The order is the one in which names are listed.
MATPLOTLIB = [
    "viridis", "plasma", "inferno", "magma", "cividis", "turbo", "twilight", "grey", "hot",
    "afmhot", "gist_heat", "gist_earth", "bone", "copper", "pink", "cubehelix", "coolwarm", "bwr",
    "seismic", "RdBu", "RdYlBu", "Spectral", "PuOr", "BrBG", "PRGn", "PiYG", "Greys", "Blues",
    "Greens", "Oranges", "Reds", "Purples", "YlGnBu", "YlOrRd", "jet", "rainbow", "hsv"]
PARAVIEW = {
    "cool to warm": "Cool to Warm", "cool to warm (extended)": "Cool to Warm (Extended)",
    "black-body radiation": "Black-Body Radiation", "x ray": "X Ray",
    "cold and hot": "Cold and Hot", "blue orange (divergent)": "Blue Orange (divergent)",
    "rainbow desaturated": "Rainbow Desaturated", "rainbow uniform": "Rainbow Uniform",
    "blue to red rainbow": "Blue to Red Rainbow"}
CHECKED = ["viridis", "inferno", "cividis", "turbo", "twilight", "hot", "coolwarm", "RdBu", "jet",
           "cool to warm", "cool to warm (extended)", "black-body radiation", "batlow"]


def matplotlib_map(name):
    import matplotlib
    from matplotlib.colors import LinearSegmentedColormap, ListedColormap
    colormap = matplotlib.colormaps[name]
    if isinstance(colormap, ListedColormap):
        table = numpy.array(colormap.colors)[:, :3]
        at = numpy.linspace(0, 1, len(table))
        return numpy.stack([numpy.interp(GRID, at, column) for column in table.T], axis=1)
    fine = LinearSegmentedColormap("fine", colormap._segmentdata, N=len(GRID))
    return fine(numpy.arange(len(GRID)))[:, :3]


def paraview_maps(path):
    data = path.read_bytes()
    if path.suffix != ".json":  # a string of the library, cut into parts with zeros between them
        data = data[data.find(b'[\n  {\n    "ColorSpace"'):].replace(b"\0", b"")
    maps, _ = json.JSONDecoder().raw_decode(data.decode("latin-1"))
    return {entry["Name"]: entry for entry in maps}


def paraview_map(entry):
    import vtk
    function = vtk.vtkColorTransferFunction()
    getattr(function, "SetColorSpaceTo" + entry["ColorSpace"])()
    points = numpy.array(entry["RGBPoints"]).reshape(-1, 4)
    first, last = points[0, 0], points[-1, 0]
    for x, r, g, b in points:
        function.AddRGBPoint((x - first) / (last - first), r, g, b)
    return numpy.array([function.GetColor(x) for x in GRID])


def batlow(path):
    rows = [line.split() for line in path.read_text().splitlines() if line[:1].isdigit()]
    table = numpy.array([[float(v) / 255 for v in row[1].split("/")] for row in rows])
    table = numpy.vstack([table, [float(v) / 255 for v in rows[-1][3].split("/")]])
    at = [float(row[0]) for row in rows] + [1.0]
    return numpy.stack([numpy.interp(GRID, at, column) for column in table.T], axis=1)


def to_linear(signal):
    return numpy.where(signal <= 0.04045, signal / 12.92, ((signal + 0.055) / 1.055) ** 2.4)


def to_signal(light):
    light = numpy.maximum(light, 0)
    return numpy.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)


def fits(signals, light, begin, end):
    share = numpy.linspace(0, 1, end - begin + 1)[:, None]
    between = to_signal(light[begin] * (1 - share) + light[end] * share)
    return numpy.abs(between - signals[begin:end + 1]).max() * 255 <= STEP


def points_of(signals):
    """Returns whole numbers (2040 position, 2550 r, 2550 g, 2550 b) of the points."""
    signals = numpy.clip(signals, 0, 1)
    rounded = numpy.round(signals * 2550) / 2550
    light = to_linear(rounded)
    points, begin, last = [0], 0, len(signals) - 1
    while begin < last:
        # Doubling, then halving: the farthest end that fits.
        reach = 1
        while begin + 2 * reach <= last and fits(signals, light, begin, begin + 2 * reach):
            reach *= 2
        end = min(begin + reach, last)
        step = reach
        while step >= 1:
            if end + step <= last and fits(signals, light, begin, end + step):
                end += step
            else:
                step //= 2
        points.append(end)
        begin = end
    return [(i, *numpy.round(rounded[i] * 2550).astype(int)) for i in points]


HEADER = '''// SPDX-License-Identifier: Apache-2.0
// Made by tools/color_maps.py.
//
// Sources and licences. matplotlib 3.6 (PSF-based): viridis, plasma, inferno, magma (N. J. Smith,
// S. van der Walt, E. Firing), cividis (J. R. Nunez, C. R. Anderton, R. S. Renslow) and twilight
// (B. Bechtold) are CC0; turbo is Apache-2.0 (A. Mikhailov, Google); RdBu to YlOrRd are by C.
// Brewer, Apache-2.0: "This product includes color specifications and designs developed by Cynthia
// Brewer (http://colorbrewer.org/)". ParaView 5.11 (BSD-3-Clause): cool to warm (K. Moreland 2009)
// to blue to red rainbow; cool to warm (extended) and blue orange are by F. Samsel. batlow:
// Scientific colour maps 7.0.1, MIT, F. Crameri.
#include "color_map_table.h"

#include <array>
#include <cstdint>

namespace pellucid {
namespace {

// Of each point its position times 2040, and the sRGB signals of red, green, blue times 2550.

'''


def write_table(maps):
    text = HEADER
    listed = []
    for name, signals in maps.items():
        identifier = "".join(c if c.isalnum() else "_" for c in name.lower())
        while "__" in identifier:
            identifier = identifier.replace("__", "_")
        identifier = "map_" + identifier.strip("_")
        rows = points_of(signals)
        text += (f"constexpr std::array<std::uint16_t, {4 * len(rows)}> {identifier}{{"
                 + ", ".join(str(number) for row in rows for number in row) + "};\n")
        listed.append(f'    {{"{name}", {identifier}}}')
        print(f"{name:28} {len(rows)} points")
    text += f"\nconstexpr std::array<NamedColorMap, {len(listed)}> maps{{{{\n"
    text += ",\n".join(listed) + "}};\n\n}  // namespace\n\n"
    text += "std::span<const NamedColorMap> color_map_table() noexcept {\n  return maps;\n}\n\n"
    text += "}  // namespace pellucid\n"
    (ROOT / "src/scene/looks/color_map_table.cpp").write_text(text)


def write_checks(maps):
    with open(ROOT / "tests/scene/color_maps.csv", "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        file.write("# Made by tools/color_maps.py from matplotlib, ParaView's ColorMaps.json by "
                   "VTK, and GMT: name, position, sRGB times 255\n")
        for name in CHECKED:
            for i in range(0, len(GRID), 60):
                row = [name, f"{GRID[i]:.10g}"]
                writer.writerow(row + [f"{255 * v:.2f}" for v in maps[name][i]])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--paraview", type=pathlib.Path, required=True)
    parser.add_argument("--batlow", type=pathlib.Path, required=True)
    arguments = parser.parse_args()
    paraview = paraview_maps(arguments.paraview)
    maps = {name: matplotlib_map("gray" if name == "grey" else name) for name in MATPLOTLIB}
    maps.update({name: paraview_map(paraview[key]) for name, key in PARAVIEW.items()})
    maps["batlow"] = batlow(arguments.batlow)
    write_table(maps)
    write_checks(maps)


if __name__ == "__main__":
    main()
