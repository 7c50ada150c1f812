# SPDX-License-Identifier: Apache-2.0
import base64
import json
import os
import struct
import unittest
import zipfile
import zlib

from program import HAZE, ProgramTest, npy, ramp


def metaimage(matrix="1 0 0 0 1 0 0 0 1"):
    header = ("ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n"
              f"CompressedData = False\nTransformMatrix = {matrix}\nOffset = 10 20 30\n"
              "ElementSpacing = 1 2 3\nDimSize = 2 3 4\nElementType = MET_SHORT\n"
              "ElementDataFile = LOCAL\n")
    return header.encode() + struct.pack("<24h", *range(-5, 19))


class Info(ProgramTest):
    def test_json_of_a_numpy_file(self):
        values = [0.0, 1.0, 2.0, float("nan"), 4.0, 5.0, 6.0, 8.0]
        self.write("a.npy", npy(values, (2, 2, 2)))
        report = self.report("info", "a.npy", "--spacing", "1,2,3", "--origin", "-1,0,1")
        self.assertEqual(report["dimensions"], [2, 2, 2])
        self.assertEqual(report["type"], "f32")
        self.assertEqual(report["bytes"], 32)
        self.assertEqual(report["centering"], "point")
        self.assertEqual(report["spacing"], [1, 2, 3])
        self.assertEqual(report["origin"], [-1, 0, 1])
        self.assertEqual(report["world_box"], [[-1, 0, 1], [0, 2, 4]])
        self.assertEqual(report["range"], [0, 8])
        self.assertAlmostEqual(report["mean"], 26 / 7, places=12)
        self.assertEqual(report["nan"], 1)
        self.assertIsNone(report["orientation"])
        histogram = report["histogram"]
        self.assertEqual(len(histogram["count"]), 256)
        self.assertEqual(sum(histogram["count"]), 7)
        self.assertEqual(histogram["count"][0], 1)
        self.assertEqual(histogram["count"][255], 1)

    def test_text(self):
        self.write("a.npy", npy(ramp(3), (3, 3, 3)))
        text = self.succeed("info", "a.npy")
        self.assertRegex(text, r"(?m)^dimensions +3 x 3 x 3$")
        self.assertRegex(text, r"(?m)^type +f32, 108 B$")
        self.assertRegex(text, r"(?m)^range +0 to 1$")
        self.assertRegex(text, r"(?m)^NaN +0$")
        bars = text[text.index("histogram"):].splitlines()[1:]
        self.assertEqual(len(bars), 24)
        self.assertRegex(bars[0], r"^ +0 +9 #{48}$")
        self.assertRegex(bars[1], r"^ +[0-9.]+ +0$")

    def test_builtin_field(self):
        report = self.report("info", "builtin:marschner_lobb:16")
        self.assertEqual(report["dimensions"], [16, 16, 16])
        for bound in range(2):
            for x in report["world_box"][bound]:
                self.assertAlmostEqual(x, [-1, 1][bound], places=12)

    def test_raw_file(self):
        self.write("a.raw", b"HEAD" + struct.pack(">8H", *range(100, 108)))
        report = self.report("info", "a.raw", "--dimensions", "2,2,2", "--type", "u16",
                             "--big-endian", "--skip-bytes", "4", "--centering", "cell")
        self.assertEqual(report["range"], [100, 107])
        self.assertEqual(report["centering"], "cell")
        self.assertEqual(report["world_box"], [[-0.5, -0.5, -0.5], [1.5, 1.5, 1.5]])

    def test_components(self):
        values = [float(i % 3 * 10 + i // 3) for i in range(24)]
        values[1] = float("nan")
        self.write("a.npy", npy(values, (3, 2, 2, 2)))
        report = self.report("info", "a.npy")
        self.assertEqual(report["name"], "a.npy")
        self.assertEqual(report["dimensions"], [2, 2, 2])
        self.assertEqual(report["bytes"], 96)
        components = report["components"]
        self.assertEqual([c["range"] for c in components], [[0, 7], [11, 17], [20, 27]])
        for component, mean in zip(components, [3.5, 14, 23.5]):
            self.assertAlmostEqual(component["mean"], mean, places=12)
        self.assertEqual([c["nan"] for c in components], [0, 1, 0])
        self.assertEqual([sum(c["histogram"]["count"]) for c in components], [8, 7, 8])
        self.assertNotIn("range", report)
        text = self.succeed("info", "a.npy")
        self.assertRegex(text, r"(?m)^type +f32, 96 B$")
        self.assertRegex(text, r"(?m)^components +3$")
        self.assertRegex(text, r"(?m)^component 0 +0 to 7, mean 3\.5$")
        self.assertRegex(text,
                         r"(?m)^component 1 +11 to 17, mean 14, NaN 1 \(rendered as vacuum\)$")
        self.assertNotIn("histogram", text)

    def test_one_component(self):
        self.write("a.raw", struct.pack("<16B", *range(100, 116)))
        raw = ("info", "a.raw", "--dimensions", "2,2,2", "--type", "u8", "--components", "2")
        self.assertEqual(len(self.report(*raw)["components"]), 2)
        report = self.report(*raw, "--component", "1")
        self.assertEqual(report["range"], [101, 115])
        self.assertNotIn("components", report)
        self.assertIn("component 1", report["name"])
        result = self.run_program(*raw, "--component", "2")
        self.assertEqual(result.returncode, 1)
        self.assertIn(b"there is no component 2", result.stderr)
        result = self.run_program(*raw, "--component", "x")
        self.assertEqual(result.returncode, 1)
        self.assertIn(b"x", result.stderr)

    def test_all_nan(self):
        self.write("a.npy", npy([float("nan")] * 8, (2, 2, 2)))
        report = self.report("info", "a.npy")
        self.assertEqual(report["nan"], 8)
        self.assertIsNone(report["range"])
        self.assertIsNone(report["mean"])
        self.assertIsNone(report["histogram"])
        self.assertIn("no finite value", self.succeed("info", "a.npy"))

    def test_labels_are_told(self):
        n = 12
        blocks = [7 * (i // 4) + 20 * (j // 4) + 60 * (k // 4)
                  for k in range(n) for j in range(n) for i in range(n)]
        for kind in ("|u1", "<i2", "<f4"):
            self.write("labels.npy", npy(blocks, (n, n, n), kind))
            self.assertEqual(self.report("info", "labels.npy")["labels"], 27)
            self.assertRegex(self.succeed("info", "labels.npy"),
                             r"(?m)^labels +looks like labels: 27 whole numbers[^\n]*interpolating")
            result = self.run_program("render", "labels.npy", "-o", "a.exr", "--size", "4")
            self.assertRegex(result.stderr.decode(), r"(?m)^pellucid: look labels, for whole")
            result = self.run_program("render", "labels.npy", "-o", "a.exr", "--size", "4",
                                      "--look", "haze")
            self.assertRegex(result.stderr.decode(),
                             r"(?m)^pellucid: looks like labels: 27 whole numbers")
            report = self.report("render", "labels.npy", "-o", "a.exr", "--size", "4", "--look",
                                 "haze")
            self.assertEqual(report["labels"], {"value": 27})
        self.write("ramp.npy", npy([round(255 * x) for x in ramp(n)], (n, n, n), "|u1"))
        self.assertIsNone(self.report("info", "ramp.npy")["labels"])
        self.assertNotIn("labels", self.succeed("info", "ramp.npy"))
        result = self.run_program("render", "ramp.npy", "-o", "a.exr", "--size", "4")
        self.assertNotIn("looks like labels", result.stderr.decode())

    def test_orientation_of_a_medical_file(self):
        self.write("a.mha", metaimage())
        result = self.run_program("info", "a.mha")
        if result.returncode != 0 and b"ITK" in result.stderr:
            self.skipTest("built without ITK")
        report = self.report("info", "a.mha")
        self.assertEqual(report["orientation"], "LPS")
        self.assertEqual(report["spacing"], [1, 2, 3])
        self.assertEqual(report["origin"], [10, 20, 30])
        self.assertEqual(report["type"], "i16")
        self.write("b.mha", metaimage("-1 0 0 0 0.8 0.6 0 -0.6 0.8"))
        text = self.succeed("info", "b.mha")
        self.assertRegex(text, r"(?m)^orientation +RPS, oblique by 36\.87 degrees")

    def test_files_of_no_patient_are_not_called_lps(self):
        self.write("none.nii", nifti(0))
        result = self.run_program("info", "none.nii")
        self.assertRegex(result.stderr.decode(), r"states no orientation \(qform_code and sform")
        self.assertNotRegex(result.stdout.decode(), r"orientation|LPS")
        report = self.report("info", "none.nii")
        self.assertIsNone(report["orientation"])
        self.assertIsNone(report["space"])
        self.assertEqual(report["origin"], [-0.5, 1, -1.5])
        self.write("one.nii", nifti(1))
        report = self.report("info", "one.nii")
        self.assertEqual((report["orientation"], report["space"]), ("RAS", "LPS"))
        header = ("NRRD0005\ntype: uchar\ndimension: 3\nsizes: 2 2 2\nencoding: raw\n"
                  "space: %s\nspace directions: (1,0,0) (0,1,0) (0,0,1)\n\n")
        for space in "3D-left-handed", "3D-right-handed", "scanner-xyz":
            self.write("a.nrrd", (header % space).encode() + bytes(range(8)))
            result = self.run_program("info", "a.nrrd")
            if result.returncode != 0 and b"ITK" in result.stderr:
                self.skipTest("built without ITK")
            text = result.stdout.decode()
            self.assertRegex(text, rf"(?m)^space +{space} \(the file's name for it")
            self.assertNotIn("LPS", text)
            report = self.report("info", "a.nrrd")
            self.assertEqual((report["orientation"], report["space"]), (None, space))

    def test_stdout_that_cannot_be_written(self):
        self.write("a.npy", npy(ramp(2), (2, 2, 2)))
        with open("/dev/full", "wb") as full:
            import subprocess
            from program import PROGRAM
            result = subprocess.run([PROGRAM, "info", self.path("a.npy")], stdout=full,
                                    stderr=subprocess.PIPE, check=False)
        self.assertEqual(result.returncode, 1)
        self.assertRegex(result.stderr.decode(), r"\Apellucid: error: stdout: [^\n]+\n\Z")


def nifti(sform_code):
    """2 x 2 x 2 bytes of spacing 1, 2, 3."""
    header = bytearray(352)
    struct.pack_into("<i", header, 0, 348)
    struct.pack_into("<8h", header, 40, 3, 2, 2, 2, 1, 1, 1, 1)
    struct.pack_into("<2h", header, 70, 2, 8)
    struct.pack_into("<8f", header, 76, 1, 1, 2, 3, 0, 0, 0, 0)
    struct.pack_into("<f", header, 108, 352)
    struct.pack_into("<2h", header, 252, 0, sform_code)
    struct.pack_into("<12f", header, 280, 1, 0, 0, 5, 0, 2, 0, 6, 0, 0, 3, 7)
    header[344:348] = b"n+1\0"
    return bytes(header) + bytes(range(8))


# 3 x 3 x 2 points.
VTK_IMAGE = """# vtk DataFile Version 3.0
an image
ASCII
DATASET STRUCTURED_POINTS
DIMENSIONS 3 3 2
ORIGIN 0 0 0
SPACING 1 2 3
POINT_DATA 18
VECTORS v float
""" + " ".join(map(str, range(54))) + """
SCALARS a unsigned_char 1
LOOKUP_TABLE default
""" + " ".join(map(str, range(18))) + """
CELL_DATA 4
SCALARS c double 1
LOOKUP_TABLE default
1 2 3 4
"""


@unittest.skipUnless(os.environ.get("PELLUCID_HAS_VTK") == "1", "the program was built without VTK")
class Arrays(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("a.vtk", VTK_IMAGE)

    def test_all_are_listed_and_one_is_shown(self):
        report = self.report("info", "a.vtk")
        self.assertEqual(report["array"], "a")
        self.assertEqual(report["type"], "u8")
        arrays = {array["name"]: array for array in report["arrays"]}
        self.assertEqual(sorted(arrays), ["a", "c", "v"])
        self.assertEqual(arrays["c"]["centering"], "cell")
        self.assertEqual(arrays["c"]["dimensions"], [2, 2, 1])
        self.assertEqual([c["range"] for c in arrays["v"]["components"]],
                         [[0, 51], [1, 52], [2, 53]])
        text = self.succeed("info", "a.vtk")
        self.assertRegex(text, r"(?m)^  a \(point, u8\), shown here  0 to 17$")
        self.assertRegex(text, r"(?m)^  v \(point, f32 x 3\)  0 to 51; 1 to 52; 2 to 53$")

    def test_one_is_chosen(self):
        report = self.report("info", "a.vtk", "--array", "c")
        self.assertEqual((report["array"], report["centering"]), ("c", "cell"))
        self.assertEqual(report["range"], [1, 4])
        self.assertEqual(self.report("info", "a.vtk", "--array", "v:1")["range"], [1, 52])
        self.assertEqual(self.report("info", "a.vtk", "--array", "v", "--component", "2")["range"],
                         [2, 53])
        self.assertEqual(len(self.report("info", "a.vtk", "--array", "v")["components"]), 3)
        self.fail_with('no array "b"; its arrays are .*a', "info", "a.vtk", "--array", "b")

    def test_they_are_rendered(self):
        self.write("tf.json", json.dumps(HAZE))
        self.succeed("render", "a.vtk", "--array", "v:2", "--tf", "tf.json", "-o", "v.exr",
                     "--size", "16", "--save-scene", "scene.json")
        field = json.loads(self.read("scene.json"))["layers"][0]["field"]
        self.assertEqual((field["array"], field["component"]), ("v", 2))
        self.succeed("render", "scene.json", "-o", "w.exr")
        self.assertTrue(self.report("compare", "v.exr", "w.exr")["identical"])
        self.fail_with("3 components", "render", "a.vtk", "--array", "v", "-o", "x.exr")
        self.fail_with("--array applies to mesh files", "render", "builtin:ramp", "--array", "v",
                       "-o", "x.exr", code=2)

    def test_several_are_channels(self):
        gaussian = "up=30~10, a=9~4; extinction 0.5; color #ffcc99"
        self.succeed("render", "a.vtk", "--array", "up=v:2", "--array", "a", "--gaussian", gaussian,
                     "-o", "v.exr", "--size", "16", "--save-scene", "scene.json")
        channels = json.loads(self.read("scene.json"))["layers"][0]["channels"]
        self.assertEqual([c["name"] for c in channels], ["up", "a"])
        self.assertEqual([c["array"] for c in channels], ["v", "a"])


def net_cdf():
    """A classic file: v of floats at the times 1 and 4, on axes z, y, x of 2, 3, 4."""
    def text(name):
        return struct.pack(">i", len(name)) + name.encode() + b"\0" * (-len(name) % 4)

    axes = b"".join(text(name) + struct.pack(">i", n)
                    for name, n in (("t", 2), ("z", 2), ("y", 3), ("x", 4)))
    head = b"CDF\1" + struct.pack(">iii", 0, 10, 4) + axes + struct.pack(">iiii", 0, 0, 11, 2)
    of_v = text("v") + struct.pack(">iiiiiii", 4, 0, 1, 2, 3, 0, 0) + struct.pack(">ii", 5, 192)
    of_t = text("t") + struct.pack(">iiii", 1, 0, 0, 0) + struct.pack(">ii", 5, 8)
    begin = len(head) + len(of_v) + len(of_t) + 8
    return (head + of_v + struct.pack(">i", begin) + of_t + struct.pack(">i", begin + 192)
            + struct.pack(">48f", *range(48)) + struct.pack(">2f", 1, 4))


@unittest.skipUnless(os.environ.get("PELLUCID_HAS_NETCDF") == "1",
                     "the program was built without NetCDF")
class NetCdf(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("a.nc", net_cdf())

    def test_steps(self):
        report = self.report("info", "a.nc")
        self.assertEqual(report["array"], "v")
        self.assertEqual(report["dimensions"], [4, 3, 2])
        self.assertEqual([c["range"] for c in report["components"]], [[0, 23], [24, 47]])
        self.assertEqual(self.report("info", "a.nc", "--time", "3")["range"], [24, 47])
        self.assertEqual(self.report("info", "a.nc", "--component", "0")["range"], [0, 23])
        self.fail_with("2 steps", "render", "a.nc", "-o", "a.exr")

    def test_times_are_told(self):
        notes = self.run_program("info", "a.nc").stderr.decode()
        self.assertIn('"v" holds 2 times (1, 4); --time chooses one', notes)
        notes = self.run_program("info", "a.nc", "--time", "3").stderr.decode()
        self.assertIn("step 2 of 2 is read, time 4 (nearest to 3)", notes)
        for option in ("--time", "--skip-bytes", "--level"):
            self.fail_with(f"{option}: needs a number", "info", "a.nc", option, "", code=2)
        for option in ("--component", "--array", "--series", "--spacing", "--type", "--array-axes"):
            self.fail_with(f"{option}: needs a value", "info", "a.nc", option, "", code=2)

    def test_a_time_is_kept_in_the_scene(self):
        self.succeed("render", "a.nc", "--time", "5", "-o", "a.exr", "--size", "16",
                     "--save-scene", "scene.json")
        field = json.loads(self.read("scene.json"))["layers"][0]["field"]
        self.assertEqual(field["time"], 5)
        self.succeed("render", "scene.json", "-o", "b.exr")
        self.assertTrue(self.report("compare", "a.exr", "b.exr")["identical"])
        self.succeed("convert", "a.nc", "--time", "5", "-o", "a.raw", "-q")
        self.assertEqual(self.read("a.raw"), struct.pack("<24f", *range(24, 48)))

    def test_cut_off(self):
        self.write("cut.nc", net_cdf()[:-60])
        self.fail_with("cut off", "info", "cut.nc")


# Written by OpenVDB 10.0.1: float grids "density" (0 to 23) and "heat" (100 to 123) of 4 x 3 x 2
# voxels of 1/2.
OPENVDB = (
    "eNrt2j9oE1EABvAXo1bEP3EoOGbSKWAv1zadksaulYJ/Rs93l5d6cH9C7nIk4NCxYydxdHSsm4vgKCIiUkREJIiIiEgR"
    "cfZ73J1NghUcKkq+H3x87y7vXV5y6ys3V64JGCLHRapg1KQyFo25iqy25yqmsaQqS4u2U6mZJm7UjHl7wdETDyEzSEsF"
    "kRsPShhe6Spltb1Qxta8ZVpVPe1W9tyH59K+fj5tvfwYcgRxPBlFRzGI4q4brOuttMP1chJ6PV+d1FeupyzbDvuWL/t6"
    "RaKcqnsCg2L2qAIyMdMNxmaOKuUzndDvdFUUuWGw9/36OdKJ3USVE+n1VHQmn95SnhyoloWf2NKzrPyOvjGbbeOntaxP"
    "5ct95Vv2IFaR3pgbxAum/ge27h8e31QS9pWHrfWCeGzi2ex5enogfbW345H3cBrDq4HbDrv+ZUd6alV20lXD+p+1aPy6"
    "S/v0bn2yR/+MwsQbmLwmIiIiIiIiIiIiIiIiIiKi/xAPABBNsWKx+Ns+6PWZxrIQGw0ELZC7+rouxJoe4/4muoTc05/j"
    "+gb6EXoLXUa2kQauO+gh+g76AvJgWR/TuqlkvN/JuNvZSbid1bR7l9KegpNxF7M++JNx+UvgsTgiIiIiIiIiIiIiIiIi"
    "IiL6W3gAgGiK/QPH4h43hRgiz5GPyCtkF3mCvENeIJ+Q18hX5CnyHtlBPiNvkG/IM+QD8hL5grxFvjd/AAiVBFw="
)


@unittest.skipUnless(os.environ.get("PELLUCID_HAS_OPENVDB") == "1",
                     "the program was built without OpenVDB")
class OpenVdb(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("a.vdb", zlib.decompress(base64.b64decode(OPENVDB)))

    def test_grids(self):
        report = self.report("info", "a.vdb")
        self.assertEqual(report["array"], "density")
        self.assertEqual(report["dimensions"], [4, 3, 2])
        self.assertEqual(report["spacing"], [0.5, 0.5, 0.5])
        self.assertEqual(report["range"], [0, 23])
        self.assertEqual([array["name"] for array in report["arrays"]], ["density", "heat"])
        self.assertEqual(self.report("info", "a.vdb", "--array", "heat")["range"], [100, 123])
        self.fail_with("it has density, heat", "info", "a.vdb", "--array", "cold")
        self.succeed("convert", "a.vdb", "--array", "heat", "-o", "a.raw", "-q")
        self.assertEqual(self.read("a.raw"), struct.pack("<24f", *range(100, 124)))

    def test_a_picture(self):
        self.succeed("render", "a.vdb", "-o", "a.exr", "--size", "16", "--save-scene", "scene.json")
        self.succeed("render", "scene.json", "-o", "b.exr")
        self.assertTrue(self.report("compare", "a.exr", "b.exr")["identical"])

    def test_cut_off(self):
        self.write("cut.vdb", zlib.decompress(base64.b64decode(OPENVDB))[:-60])
        self.fail_with("cut.vdb: ", "info", "cut.vdb")


def array(shape, kind="<i2", fortran=False):
    """A .npy file; an element's value has its indices as its digits."""
    def values(index):
        if len(index) == len(shape):
            order = index[::-1] if fortran else index
            return [int("".join(map(str, order)))]
        axis = len(shape) - 1 - len(index) if fortran else len(index)
        return [v for i in range(shape[axis]) for v in values(index + [i])]
    header = f"{{'descr': '{kind}', 'fortran_order': {fortran}, 'shape': {tuple(shape)}, }}\n"
    code = {"i2": "h", "i8": "q", "u8": "Q", "b1": "?"}[kind[1:]]
    data = values([])
    return (b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header.encode() +
            struct.pack(f"<{len(data)}{code}", *data))


class NumpyArrays(ProgramTest):
    def test_axes(self):
        self.write("c.npy", array([3, 4, 5]))
        self.write("f.npy", array([3, 4, 5], fortran=True))
        for name in ("c.npy", "f.npy"):
            self.assertEqual(self.report("info", name)["dimensions"], [5, 4, 3])
            named = self.report("info", name, "--axes", "xyz")
            self.assertEqual(named["dimensions"], [3, 4, 5])
            self.assertEqual(named["range"], [0, 234])
            self.succeed("render", name, "--axes", "zxy", "-o", f"{name}.exr", "--size", "8")
            self.succeed("convert", name, "--axes", "xyz", "-o", f"{name}.raw", "-q")
            self.report("histogram", name, "--axes", "xyz", "--bins", "4")
            self.report("histogram", name, "--array-axes", "xyz", "--axes", "value", "--bins", "4")
            self.succeed("suggest", name, "--array-axes", "xyz")
        self.assertTrue(self.report("compare", "c.npy.exr", "f.npy.exr")["identical"])
        self.assertEqual(self.read("c.npy.raw"), self.read("f.npy.raw"))
        self.assertEqual(struct.unpack("<4h", self.read("c.npy.raw")[:8]), (0, 100, 200, 10))
        self.fail_with("give x, y and z", "info", "c.npy", "--axes", "zyq", code=2)
        self.fail_with("3 axes", "info", "c.npy", "--axes", "czyx")
        self.fail_with("leave the axes out", "info", "c.npy.raw", "--dimensions", "3,4,5",
                       "--type", "i16", "--axes", "xyz")

    def test_four_axes(self):
        self.write("a.npy", array([3, 9, 9, 9]))
        result = self.run_program("info", "a.npy", "--json")
        self.assertEqual(result.returncode, 0)
        self.assertIn(b"axes czyx", result.stderr)
        self.assertIn(b"zyxc", result.stderr)
        self.assertEqual(json.loads(result.stdout)["dimensions"], [9, 9, 9])
        self.assertEqual(len(self.report("info", "a.npy", "--axes", "zyxc")["components"]), 9)

    def test_a_scene_says_axes(self):
        self.write("a.npy", array([3, 4, 5]))
        self.succeed("render", "a.npy", "--axes", "xyz", "-o", "a.exr", "--size", "8",
                     "--save-scene", "scene.json")
        self.assertEqual(json.loads(self.read("scene.json"))["layers"][0]["field"]["axes"],
                         "xyz")
        self.succeed("render", "scene.json", "-o", "b.exr")
        self.assertTrue(self.report("compare", "a.exr", "b.exr")["identical"])
        scene = json.loads(self.read("scene.json"))
        scene["layers"][0]["field"]["axes"] = "abc"
        self.write("scene.json", json.dumps(scene))
        self.fail_with("axes", "render", "scene.json", "-o", "b.exr")

    def test_whole_numbers_of_64_bits(self):
        self.write("a.npy", array([3, 4, 5], "<i8"))
        self.assertEqual(self.report("info", "a.npy")["type"], "u8")
        header = array([2, 2, 2], "<u8")[:-64]
        self.write("b.npy", header + struct.pack("<8Q", 2**53 + 1, *range(7)))
        result = self.run_program("info", "b.npy", "--json")
        self.assertEqual(json.loads(result.stdout)["type"], "f64")
        self.assertIn(b"1 of 8 whole numbers of 64 bits", result.stderr)

    def test_npz(self):
        for name, compression in (("s.npz", zipfile.ZIP_STORED), ("d.npz", zipfile.ZIP_DEFLATED)):
            with zipfile.ZipFile(self.path(name), "w", compression) as archive:
                archive.writestr("a.npy", array([3, 4, 5]))
                with archive.open("b.npy", "w", force_zip64=True) as entry:
                    entry.write(array([2, 4, 5], "<i8"))
            self.fail_with(r"choose one of them by its name: a \(3, 4, 5\), b \(2, 4, 5\)",
                           "render", name, "-o", "a.png")
            report = self.report("info", name)
            self.assertEqual([one["name"] for one in report["arrays"]], ["a", "b"])
            self.assertEqual([one["type"] for one in report["arrays"]], ["i16", "u8"])
            self.assertEqual(report["array"], "a")
            self.assertEqual(self.report("info", name, "--array", "b")["dimensions"], [5, 4, 2])
            self.succeed("render", name, "--array", "a", "-o", "a.exr", "--size", "8",
                         "--save-scene", "scene.json")
            self.succeed("render", "scene.json", "-o", "b.exr")
            self.assertTrue(self.report("compare", "a.exr", "b.exr")["identical"])
            self.succeed("convert", name, "--array", "b", "-o", "b.nrrd", "-q")


if __name__ == "__main__":
    unittest.main()
