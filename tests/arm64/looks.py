#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Renders a frame of each look by two programs and compares the frames pixel by pixel.

  looks.py --beside PROGRAM PROGRAM [ARGUMENT...]

The last arguments are the command under test, such as an emulator and the program that it runs.
Both programs read the same files and keep the same tolerance, so that no channel of a pixel may
differ by more than twice the tolerance. Standard library only.
"""
import argparse
import json
import math
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

SIZE = 32
TOLERANCES = (1 / 512, 1e-4)
# Methods that sample have no tolerance; both programs take the same samples, in binary32.
SAMPLED = 2e-5
POINTS = 20


def write_npy(path, kind, values):
    """POINTS³ values, those along x next to each other. `kind` is of numpy and of struct."""
    shape = (POINTS,) * 3
    header = f"{{'descr': '{kind[0]}', 'fortran_order': False, 'shape': {shape}, }}"
    header += " " * (-(len(header) + 11) % 64) + "\n"
    path.write_bytes(b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header.encode() +
                     struct.pack(f"<{len(values)}{kind[1]}", *values))


def write_mesh(folder):
    """The same values on a curvilinear grid, as PLOT3D, which needs no module."""
    sides, step = struct.pack("<3i", *(POINTS,) * 3), (POINTS - 1) / 2
    points = [(step * (x + 1) + 0.3 * math.sin(3 * y), step * (y + 1), step * (z + 1))
              for x, y, z in places()]
    numbers = [point[axis] for axis in range(3) for point in points]
    (folder / "mesh.xyz").write_bytes(sides + struct.pack(f"<{len(numbers)}f", *numbers))
    # Mach number and the like; density, momentum along three axes, energy.
    numbers = [0.0] * 4 + [wave(*p) for p in places()] + [1.0] * (4 * POINTS ** 3)
    (folder / "mesh.q").write_bytes(sides + struct.pack(f"<{len(numbers)}f", *numbers))


def places():
    """Of all values, the place in [-1,1]³."""
    step = 2 / (POINTS - 1)
    for k in range(POINTS):
        for j in range(POINTS):
            for i in range(POINTS):
                yield step * i - 1, step * j - 1, step * k - 1


def wave(x, y, z):
    r = math.sqrt(x * x + y * y + z * z)
    return 0.5 + 0.3 * math.sin(5 * x + 2 * y) * math.cos(4 * z - y) - 0.2 * r * r


def write_data(folder):
    write_npy(folder / "value.npy", ("<f4", "f"), [wave(*p) for p in places()])
    write_npy(folder / "bytes.npy", ("|u1", "B"),
              [max(0, min(255, round(255 * wave(*p)))) for p in places()])
    write_npy(folder / "shorts.npy", ("<i2", "h"), [round(2000 * wave(*p)) for p in places()])
    write_npy(folder / "second.npy", ("<f4", "f"), [0.5 + 0.4 * math.cos(3 * x * y + 2 * z)
                                                    for x, y, z in places()])
    write_npy(folder / "labels.npy", ("|u1", "B"),
              [0 if x * x + y * y + z * z > 0.9 else 1 + (x > 0) + 2 * (y > z)
               for x, y, z in places()])

    def function(path, points, **more):
        listed = [{"value": v, "extinction": 0.2 * e, "color": list(c)} for v, e, c in points]
        (folder / path).write_text(json.dumps({"transfer_function": {"points": listed}, **more}))

    middle = (POINTS - 1) / 2
    (folder / "camera.json").write_text(json.dumps(
        {"position": [-20, 45, -32], "focal_point": [middle] * 3, "up": [0, 1, 0],
         "vertical_angle": 35}))

    warm = [(0.0, 0.0, (0.1, 0.1, 0.4)), (0.4, 0.05, (0.2, 0.5, 0.9)), (0.55, 0.4, (0.9, 0.6, 0.2)),
            (0.8, 0.9, (1.0, 0.9, 0.8))]
    function("haze.json", warm)
    function("spike.json", [(0.0, 0.0, (0, 0, 0)), (0.49, 0.0, (0.9, 0.2, 0.1)),
                            (0.5, 6.0, (0.9, 0.7, 0.1)), (0.51, 0.0, (0.2, 0.8, 0.3)),
                            (1.0, 0.0, (0, 0, 0))])
    function("jump.json", [(0.0, 0.0, (0.1, 0.3, 0.9)), (0.5, 0.0, (0.1, 0.3, 0.9)),
                           (0.5, 0.7, (0.9, 0.5, 0.1)), (1.0, 0.7, (0.9, 0.8, 0.5))])
    function("bytes.json", [(255 * v, e, c) for v, e, c in warm])
    function("shorts.json", [(2000 * v, e, c) for v, e, c in warm])
    function("vanishing.json", warm, gradient_opacity={
        "points": [{"gradient": 0.02, "factor": 0}, {"gradient": 0.15, "factor": 1}]})


def looks():
    """(name, arguments) of each."""
    haze = ["value.npy", "--tf", "haze.json"]
    middle = (POINTS - 1) / 2
    mesh = ["mesh.xyz", "--solution", "mesh.q", "--array", "Density", "--tf", "haze.json"]
    gaussians = ["--gaussian", "value=0.5~0.1, second=0.6~0.2; extinction 0.2; color #e08020",
                 "--gaussian", "value=0.7~0.05, second=0.5~0.3; extinction 0.3; color #2080e0"]
    channels = ["--channel", "value=value.npy", "--channel", "second=second.npy", *gaussians]
    point_light = ["--shading", "on", "--light", f"point:{middle},{middle},-30"]
    return [
        ("unlit", haze),
        ("unlit, a spike", ["value.npy", "--tf", "spike.json"]),
        ("unlit, a jump, proved", ["value.npy", "--tf", "jump.json", "--grade", "proved"]),
        ("unlit, bytes", ["bytes.npy", "--tf", "bytes.json"]),
        ("unlit, 16 bits", ["shorts.npy", "--tf", "shorts.json"]),
        ("unlit, doubles alone", [*haze, "--precision", "double"]),
        ("lit", [*haze, "--shading", "on"]),
        ("lit, a jump", ["value.npy", "--tf", "jump.json", "--shading", "on"]),
        ("point light", [*haze, *point_light]),
        ("isosurface", ["value.npy", "--iso", "0.5:#c08040"]),
        ("isosurface in a medium", [*haze, "--iso", "0.55:#40c080:0.5", *point_light]),
        ("gradient opacity", ["value.npy", "--tf", "vanishing.json"]),
        ("gradient opacity, lit", ["value.npy", "--tf", "vanishing.json", "--shading", "on"]),
        ("overlap", [*haze, "--layer", "second.npy"]),
        ("channels", channels),
        ("channels, of one volume", ["value.npy", "--gaussian",
                                     "value=0.5~0.1, gradient_magnitude=0.1~0.1; extinction 0.2; "
                                     "color #ff8040"]),
        ("mesh", mesh),
        ("mesh, lit", [*mesh, "--shading", "on"]),
        ("labels", [*haze, "--labels", "labels.npy"]),
        ("labels alone", ["labels.npy", "--look", "labels"]),
        ("clips", [*haze, "--clip", f"plane:{middle},{middle},{middle},1,2,3",
                   "--clip", f"-sphere:{middle},{middle},{middle},5"]),
        ("slice", [*haze, "--slice", f"z={middle}"]),
        ("maximum", ["value.npy", "--projection", "maximum"]),
        ("preintegrated", [*haze, "--method", "preintegrated", "--step", "0.5"]),
        ("channels, preintegrated", [*channels, "--method", "gaussian", "--step", "0.5"]),
    ]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--beside", required=True, help="the program to compare with")
    parser.add_argument("program", nargs=argparse.REMAINDER, help="the command under test")
    arguments = parser.parse_args()
    beside = [arguments.beside]
    failed = frames = 0
    with tempfile.TemporaryDirectory(prefix="pellucid_looks_") as name:
        folder = Path(name)
        write_data(folder)
        write_mesh(folder)

        def run(command, *options):
            result = subprocess.run([*command, *options], cwd=folder, capture_output=True,
                                    text=True, check=False)
            if result.returncode != 0:
                raise RuntimeError(f"{' '.join(options)}: {result.stderr.strip()}")
            return result.stdout

        for look, options in looks():
            sampled = "--method" in options
            for tolerance in (None,) if sampled else TOLERANCES:
                allowed = SAMPLED if sampled else 2 * tolerance
                asked = [] if sampled else ["--strict", "--tolerance", repr(tolerance)]
                frames += 1
                try:
                    brightest = 0
                    for file, command in (("a.exr", beside), ("b.exr", arguments.program)):
                        report = json.loads(run(command, "render", *options, *asked, "--json",
                                                "--camera", "camera.json", "--size", str(SIZE),
                                                "--threads", "2", "-o", file))
                        brightest = max(brightest, report["largest_channel"])
                    found = json.loads(run(beside, "compare", "a.exr", "b.exr", "--json"))
                except RuntimeError as error:
                    print(f"FAILED: {look}: {error}")
                    failed += 1
                    continue
                apart = found["largest"]
                good = apart <= allowed and found["not_finite"] == 0 and brightest > 0.05
                failed += not good
                print(f"{'' if good else 'FAILED: '}{look}, tolerance {tolerance or 'none'}: apart "
                      f"{apart:.2g} of {allowed:.2g} allowed, brightest {brightest:.2f}")
    print(f"{frames} frames, {failed} failed")
    return 1 if failed or not frames else 0


if __name__ == "__main__":
    sys.exit(main())
