# SPDX-License-Identifier: Apache-2.0
import json
import os
import struct
import unittest

from program import ProgramTest

# Two tetrahedra with "p" and "q" on their points, "c" and vectors "v" on themselves.
TETRAHEDRA = """# vtk DataFile Version 3.0
two tetrahedra
ASCII
DATASET UNSTRUCTURED_GRID
POINTS 5 float
0 0 0 1 0 0 0 1 0 0 0 1 1 1 1
CELLS 2 10
4 0 1 2 3
4 1 2 3 4
CELL_TYPES 2
10 10
CELL_DATA 2
SCALARS c float 1
LOOKUP_TABLE default
1 2
VECTORS v float
3 4 0 0 0 2
POINT_DATA 5
SCALARS q float 1
LOOKUP_TABLE default
5 6 7 8 9
SCALARS p float 1
LOOKUP_TABLE default
0 1 2 3 4
"""


def legacy_vtk(points, cells):
    """A file of cells, each a type of VTK's and its points; "p" counts the points."""
    lines = ["# vtk DataFile Version 3.0", "cells", "ASCII", "DATASET UNSTRUCTURED_GRID",
             f"POINTS {len(points)} float"]
    lines += [" ".join(str(x) for x in point) for point in points]
    lines += [f"CELLS {len(cells)} {sum(len(c) + 1 for _, c in cells)}"]
    lines += [" ".join(str(x) for x in [len(c), *c]) for _, c in cells]
    lines += [f"CELL_TYPES {len(cells)}", *(str(kind) for kind, _ in cells)]
    lines += [f"POINT_DATA {len(points)}", "SCALARS p float 1", "LOOKUP_TABLE default"]
    return "\n".join(lines + [str(i) for i in range(len(points))]) + "\n"


VTK = os.environ.get("PELLUCID_HAS_VTK") == "1"


def plot3d():
    """A grid of 3 x 2 x 2 points, little-endian f32, and its solution."""
    points = [(x, y, z) for z in range(2) for y in range(2) for x in range(3)]
    head = struct.pack("<3i", 3, 2, 2)
    grid = head + struct.pack("<36f", *(p[a] for a in range(3) for p in points))
    q = [1.0 + p[0] for p in points] + [0.0] * 36 + [10.0] * 12
    return grid, head + struct.pack("<4f", 0, 0, 0, 0) + struct.pack("<60f", *q)


class Plot3d(ProgramTest):
    def setUp(self):
        super().setUp()
        grid, q = plot3d()
        self.write("grid.bin", grid)
        self.write("q.bin", q)

    def test_info(self):
        report = self.report("info", "grid.bin", "--q", "q.bin")
        self.assertEqual(report["format"], "PLOT3D")
        self.assertEqual(report["points"], 12)
        self.assertEqual(report["cells"], {"hexahedra": 2})
        self.assertEqual(report["world_box"], [[0, 0, 0], [2, 1, 1]])
        self.assertAlmostEqual(report["mesh"]["volume"], 2)
        self.assertEqual(report["mesh"]["folded_faces"], 0)
        self.assertEqual(report["default_array"], "Density")
        arrays = {array["name"]: array for array in report["arrays"]}
        self.assertEqual(arrays["Density"]["components"][0]["range"], [1, 3])
        self.assertEqual(len(arrays["Momentum"]["components"]), 3)
        text = self.succeed("info", "grid.bin", "--q=q.bin")
        self.assertRegex(text, r"(?m)^cells +2 hexahedra$")
        self.assertRegex(text, r"Density \(point, f32\), shown by default +1 to 3")

    def test_render(self):
        report = self.report("render", "grid.bin", "--solution", "q.bin", "-o", "a.exr", "--size",
                             "16")
        self.assertEqual(report["mesh"]["arrays"], [{"array": "Density", "component": None}])
        self.assertIsNone(report["dimensions"])
        self.assertEqual(report["pixels_over"], 0)

    def test_methods(self):
        for method in ("homogeneous", "average", "linear", "partial"):
            report = self.report("render", "grid.bin", "--q", "q.bin", "-o", "a.exr",
                                 "--size", "16", "--method", method)
            self.assertEqual(report["method"], method)
            self.assertIsNone(report["step"])
            self.assertEqual(report["precision"], "double")
        report = self.report("render", "grid.bin", "--q", "q.bin", "-o", "a.exr", "--size", "16",
                             "--method", "midpoint", "--step", "0.25")
        self.assertEqual(report["step"], 0.25)

    def test_scene_is_the_same_picture(self):
        gaussian = ["--gaussian", "d=2~1, Momentum_0=0~1; extinction 2; color #ff8040"]
        self.succeed("render", "grid.bin", "--q", "q.bin", "--array", "d=Density", "--array",
                     "Momentum:0", *gaussian, "-o", "a.exr", "--size", "16", "--save-scene",
                     "s.json")
        with open(self.path("s.json"), encoding="utf-8") as file:
            mesh = json.load(file)["layers"][0]["mesh"]
        self.assertEqual(mesh["channels"][1],
                         {"name": "Momentum_0", "array": "Momentum", "component": 0})
        self.succeed("render", "s.json", "-o", "b.exr")
        self.succeed("compare", "a.exr", "b.exr", "--largest", "0")

    def test_refusals(self):
        for arguments, part in [
                (["--step", "1"], "--step"),
                (["--channel", "a=gradient_magnitude:value"], "--array"),
                (["--spacing", "1,1,1"], "--spacing applies to volume files"),
                (["--method", "kniss"], "Gaussians"),
                (["--array", "none"], "none"),
                (["--array", "Density", "--array", "Pressure"], "several arrays"),
                (["--time", "3"], "no steps"),
        ]:
            with self.subTest(arguments=arguments):
                error = self.fail_with(arguments)
                self.assertIn(part, error)
        self.assertIn("--array applies to mesh files", self.fail_with(
            ["--array", "a"], ["builtin:sphere:8"]))
        self.assertIn("is a mesh", self.error_of("histogram", self.write("a.vtu", "x"), "-o",
                                                 "h.png"))

    def error_of(self, *arguments):
        result = self.run_program(*arguments)
        self.assertIn(result.returncode, (1, 2))
        error = result.stderr.decode()
        self.assertEqual(error.count("\n"), 1, error)
        return error

    def fail_with(self, arguments, source=("grid.bin", "--q", "q.bin")):
        return self.error_of("render", *source, "-o", "a.png", "-q", "--size", "8", *arguments)


@unittest.skipUnless(VTK, "built without VTK")
class Vtk(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("a.vtk", TETRAHEDRA)

    def test_default_array_is_noted(self):
        result = self.run_program("render", "a.vtk", "-o", "a.png", "--size", "8")
        self.assertEqual(result.returncode, 0, result.stderr.decode())
        self.assertIn(b"showing \"", result.stderr)
        result = self.run_program("render", "a.vtk", "--array", "p", "-o", "a.png", "--size", "8")
        self.assertNotIn(b"showing", result.stderr)

    def test_cell_data_and_vectors(self):
        report = self.report("render", "a.vtk", "--array", "c", "--array", "speed=v", "--gaussian",
                             "c=2~1, speed=5~9; extinction 1", "-o", "a.exr", "--size", "8")
        channels = {channel["name"]: channel for channel in report["channels"]}
        self.assertEqual((channels["c"]["minimum"], channels["c"]["maximum"]), (1, 2))
        self.assertEqual((channels["speed"]["minimum"], channels["speed"]["maximum"]), (2, 5))

    def test_more_points_than_the_shape_has_are_noted(self):
        points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1),
                  (0, 1, 1)] + [(0.5, 0.5, 0.5)] * 12
        self.write("twenty.vtk", legacy_vtk(points, [(12, list(range(20)))]))
        note = "1 of 1 cells list more points than their shape has (the first is cell 0"
        result = self.run_program("render", "twenty.vtk", "-o", "a.png", "--size", "8")
        self.assertEqual(result.returncode, 0, result.stderr.decode())
        self.assertIn(note, result.stderr.decode())
        self.assertNotIn(b"cells", self.run_program("render", "twenty.vtk", "-q", "-o", "a.png",
                                                    "--size", "8").stderr)
        self.assertIn(note, self.succeed("info", "twenty.vtk"))
        report = self.report("info", "twenty.vtk")
        self.assertEqual(report["trimmed_cells"], 1)
        self.assertEqual(len(report["notes"]), 1)
        self.assertAlmostEqual(report["mesh"]["volume"], 1)

    def test_the_order_of_nodes_is_named_where_cells_overlap(self):
        # Edges as another program numbers them: those along z before those of the top.
        corners = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2),
                   (0, 2, 2)]
        edges = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5),
                 (2, 6), (3, 7)]
        points = corners + [tuple((corners[a][i] + corners[b][i]) / 2 for i in range(3))
                            for a, b in edges]
        right = list(range(20))
        wrong = right[:12] + right[16:] + right[12:16]
        self.write("right.vtk", legacy_vtk(points, [(25, right)]))
        self.write("wrong.vtk", legacy_vtk(points, [(5, [0, 1, 2]), (25, wrong)]))
        self.assertNotIn("note", self.succeed("info", "right.vtk"))
        self.assertEqual(self.report("info", "right.vtk")["mesh"]["overlapping_cells"], 0)
        result = self.run_program("render", "right.vtk", "-o", "a.png", "--size", "8")
        self.assertNotIn(b"overlap", result.stderr)
        note = ("1 of 1 cells overlap themselves or a neighbour (the first is cell 1, counted "
                "from 0)")
        result = self.run_program("render", "wrong.vtk", "-o", "a.png", "--size", "8")
        self.assertEqual(result.returncode, 3)
        for part in (note, "the likely cause is the order of the cells' nodes"):
            self.assertIn(part, result.stderr.decode())
            self.assertIn(part, self.succeed("info", "wrong.vtk"))
        report = self.report("info", "wrong.vtk")
        self.assertEqual(report["mesh"]["overlapping_cells"], 1)
        self.assertEqual(report["mesh"]["first_overlapping_cell"], 1)
        self.assertIn(note, report["notes"][0])

    def test_a_broken_file_is_one_line(self):
        self.write("cut.vtk", TETRAHEDRA[:150])
        result = self.run_program("info", "cut.vtk")
        self.assertEqual(result.returncode, 1)
        self.assertEqual(result.stderr.count(b"\n"), 1, result.stderr)
        self.assertEqual(result.stdout, b"")

    def test_the_program_loads_vtk_only_for_its_files(self):
        self.assertNotIn(b"libvtk", self.run_program(
            "--version", env={**os.environ, "LD_DEBUG": "files"}).stderr)


if __name__ == "__main__":
    unittest.main()
