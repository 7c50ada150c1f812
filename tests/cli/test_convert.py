# SPDX-License-Identifier: Apache-2.0
import json
import os
import re
import struct
import unittest

from program import HAZE, ProgramTest, npy

# Two tetrahedra on a wedge's place, in VTK's legacy format: 0 1 2 and 3 4 5 are its triangles.
LEGACY_WEDGE = """# vtk DataFile Version 2.0
a wedge
ASCII
DATASET UNSTRUCTURED_GRID
POINTS 6 float
0 0 0  1 0 0  0 1 0  0 0 1  1 0 1  0 1 1
CELLS 1 7
6 0 1 2 3 4 5
CELL_TYPES 1
13
CELL_DATA 1
SCALARS p double 1
LOOKUP_TABLE default
4.5
POINT_DATA 6
VECTORS v float
1 2 3  0 0 0  0 0 0  0 0 0  0 0 0  7 8 9
"""

CODES = {"Float32": "f", "Float64": "d", "Int32": "i", "Int64": "q", "UInt8": "B", "Int16": "h"}


def read_vtu(content):
    """The arrays of a file with raw appended data, by name: tuples of numbers."""
    head, rest = content.split(b'<AppendedData encoding="raw">\n_', 1)
    arrays = {}
    for kind, name, components, offset in re.findall(
            r'<DataArray type="(\w+)" Name="([^"]*)" NumberOfComponents="(\d+)" '
            r'format="appended" offset="(\d+)"/>', head.decode()):
        offset = int(offset)
        (size,) = struct.unpack_from("=Q", rest, offset)
        count = size // struct.calcsize(CODES[kind])
        values = struct.unpack_from(f"={count}{CODES[kind]}", rest, offset + 8)
        n = int(components)
        arrays[name] = values if n == 1 else [values[i:i + n] for i in range(0, len(values), n)]
    return head.decode(), arrays


def volume_of(arrays):
    """The sum of the tetrahedra's volumes."""
    total, corners, points = 0, arrays["connectivity"], arrays["Points"]
    for first in range(0, len(corners), 4):
        o, a, b, c = (points[i] for i in corners[first:first + 4])
        p, q, r = ([x - y for x, y in zip(end, o)] for end in (a, b, c))
        total += abs(p[0] * (q[1] * r[2] - q[2] * r[1]) + p[1] * (q[2] * r[0] - q[0] * r[2])
                     + p[2] * (q[0] * r[1] - q[1] * r[0])) / 6
    return total


class Convert(ProgramTest):
    def test_a_volume_becomes_tetrahedra_with_its_values(self):
        self.write("v.npy", npy(list(range(24)), (4, 3, 2)))
        report = self.report("convert", "v.npy", "-o", "v.vtu", "--spacing", "1,2,0.5")
        self.assertEqual(self.files(), ["v.npy", "v.vtu"])
        self.assertEqual(report["cells"], 6)
        self.assertEqual(report["points"], 24)
        self.assertEqual(report["arrays"], [
            {"name": "value", "centering": "point", "components": 1, "type": "f32"}])
        head, arrays = read_vtu(self.read("v.vtu"))
        self.assertIn('NumberOfPoints="24"', head)
        self.assertIn(f'NumberOfCells="{report["tetrahedra"]}"', head)
        self.assertEqual(arrays["value"], tuple(range(24)))
        self.assertEqual(set(arrays["types"]), {10})
        self.assertEqual(arrays["offsets"], tuple(range(4, 4 * report["tetrahedra"] + 1, 4)))
        self.assertAlmostEqual(volume_of(arrays), 3 * 4 * 0.5)

    def test_cells_keep_one_value_each(self):
        self.write("v.npy", npy(list(range(24)), (4, 3, 2)))
        report = self.report("convert", "v.npy", "-o", "v.vtu", "--centering", "cell")
        self.assertEqual(report["cells"], 24)
        _, arrays = read_vtu(self.read("v.vtu"))
        self.assertEqual(len(arrays["value"]), report["tetrahedra"])
        for t, value in enumerate(arrays["value"]):
            corners = [arrays["Points"][i] for i in arrays["connectivity"][4 * t:4 * t + 4]]
            # Inside of the cell whose centre is the place of the value.
            middle = [sum(p[a] for p in corners) / 4 for a in range(3)]
            i, j, k = (round(x) for x in middle)
            self.assertEqual(value, i + 4 * (j + 3 * k))

    def test_a_built_in_field(self):
        report = self.report("convert", "builtin:marschner_lobb:5", "-o", "ml.vtu")
        self.assertEqual(report["cells"], 64)
        self.assertEqual(report["points"], 125)

    def test_says_what_it_did(self):
        result = self.run_program("convert", "builtin:marschner_lobb:3", "-o", "ml.vtu")
        self.assertRegex(result.stderr.decode(), r"cut 8 cells into \d+ tetrahedra of 27 points\n$")
        self.assertEqual(self.run_program("convert", "builtin:marschner_lobb:3", "-o", "ml.vtu",
                                          "-q").stderr, b"")

    def test_a_mesh_keeps_all_arrays(self):
        self.write("wedge.vtk", LEGACY_WEDGE)
        result = self.run_program("convert", "wedge.vtk", "-o", "wedge.vtu")
        if b"this build does not read" in result.stderr:
            self.skipTest("the program was built without VTK")
        self.assertEqual(result.returncode, 0, result.stderr)
        _, arrays = read_vtu(self.read("wedge.vtu"))
        self.assertEqual(len(arrays["connectivity"]), 12)
        self.assertEqual(arrays["p"], (4.5, 4.5, 4.5))
        self.assertEqual(arrays["v"][5], (7, 8, 9))
        self.assertAlmostEqual(volume_of(arrays), 0.5)
        # What is written can be read, and is not cut again.
        self.succeed("convert", "wedge.vtu", "-o", "again.vtu")
        self.assertEqual(self.read("again.vtu"), self.read("wedge.vtu"))

    def test_a_volume_in_other_formats_makes_the_same_picture(self):
        n = 9
        values = [((7 * x) % 5 + y * z % 3) / 6 for z in range(n) for y in range(n)
                  for x in range(n)]
        self.write("v.npy", npy(values, (n, n, n)))
        self.write("tf.json", json.dumps(HAZE))
        place = ("--spacing", "0.5,1,2", "--origin", "-8,4,0.25")
        self.succeed("render", "v.npy", *place, "--tf", "tf.json", "-o", "v.exr", "--size", "48")
        for name in ("v.nrrd", "v.nii", "v.nii.gz", "v.vti", "v.raw"):
            with self.subTest(name=name):
                report = self.report("convert", "v.npy", *place, "-o", name)
                self.assertEqual(report["dimensions"], [n, n, n])
                self.assertEqual((report["type"], report["components"]), ("f32", 1))
                self.assertEqual(report["array"], "v")
                self.assertEqual(report["output"], name)
                options = ()
                if name == "v.raw":
                    (note,) = report["losses"]
                    options = tuple(note.split("read it with ")[1].split())
                else:
                    self.assertEqual(report["losses"], [])
                picture = name + ".exr"
                result = self.run_program("render", name, *options, "--tf", "tf.json",
                                          "-o", picture, "--size", "48")
                if b"this build does not read" in result.stderr or b"without ITK" in result.stderr:
                    continue
                self.assertEqual(result.returncode, 0, result.stderr)
                self.assertTrue(self.report("compare", "v.exr", picture)["identical"])

    def test_components_are_kept(self):
        values = list(range(48))
        self.write("v.raw", struct.pack("<48H", *values))
        read = ("--dimensions", "4,3,2", "--type", "u16", "--components", "2")
        self.succeed("convert", "v.raw", *read, "-o", "w.raw")
        self.assertEqual(self.read("w.raw"), self.read("v.raw"))
        self.succeed("convert", "v.raw", *read, "--component", "1", "-o", "one.raw")
        self.assertEqual(self.read("one.raw"), struct.pack("<24H", *values[1::2]))
        result = self.run_program("convert", "v.raw", *read, "-o", "w.nii")
        self.assertEqual((result.returncode, result.stderr), (0, b""))
        result = self.run_program("convert", "v.raw", *read, "--centering", "cell", "-o", "w.nii")
        self.assertRegex(result.stderr.decode(), r"\Apellucid: [^\n]*--centering cell\n\Z")
        self.assertEqual(self.run_program("convert", "v.raw", *read, "--centering", "cell", "-o",
                                          "w.nii", "-q").stderr, b"")
        report = self.report("convert", "builtin:ramp:4", "-o", "ramp.raw")
        self.assertEqual(report["array"], "ramp")

    def test_refuses(self):
        self.write("v.npy", npy(list(range(24)), (4, 3, 2)))
        self.write("wedge.vtk", LEGACY_WEDGE)
        self.fail_with(r"\.vtu", "convert", "v.npy", "-o", "v.vtk", code=2)
        self.fail_with("a mesh is written as", "convert", "wedge.vtk", "-o", "w.nrrd", code=2)
        self.fail_with("no arrays", "convert", "v.npy", "-o", "v.raw", "--array", "a")
        self.fail_with("--output", "convert", "v.npy", code=2)
        self.fail_with("no steps in time", "convert", "v.npy", "-o", "v.vtu", "--time", "1")
        self.fail_with("--time applies to files", "convert", "builtin:ramp", "-o", "v.vtu",
                       "--time", "1", code=2)
        self.fail_with("--spacing applies to volume files", "convert", "wedge.vtk", "-o", "w.vtu",
                       "--spacing", "1,1,1", code=2)
        self.fail_with("nothere", "convert", "nothere.vtu", "-o", "w.vtu")
        self.fail_with("folder", "convert", "v.npy", "-o", "nowhere/v.vtu")
        self.write("same.vtu", "")
        self.fail_with("same.vtu", "convert", "same.vtu", "-o", "same.vtu", code=2)
        os.mkdir(self.path("folder.vtu"))
        self.fail_with("folder.vtu", "convert", "v.npy", "-o", "folder.vtu")


if __name__ == "__main__":
    unittest.main()
