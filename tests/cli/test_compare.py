# SPDX-License-Identifier: Apache-2.0
import json
import math
import unittest

from program import ProgramTest, exr, pixel, png


class Compare(ProgramTest):
    def setUp(self):
        super().setUp()
        rows = [[(0.25, 0.5, 0.75, 1.0)] * 4 for _ in range(3)]
        self.write("a.exr", exr(rows))
        rows[1][2] = (0.25, 0.0, 0.75, 1.0)
        rows[2][3] = (0.25, 0.5, 0.75, 0.75)
        self.write("b.exr", exr(rows))

    def test_identical(self):
        report = self.report("compare", "a.exr", "a.exr", "--largest", "0")
        self.assertTrue(report["identical"])
        self.assertEqual(report["largest"], 0)
        self.assertEqual(report["rms"], 0)
        self.assertIsNone(report["psnr"])
        self.assertIn("inf dB", self.succeed("compare", "a.exr", "a.exr"))

    def test_different(self):
        report = self.report("compare", "a.exr", "b.exr")
        self.assertFalse(report["identical"])
        self.assertEqual(report["size"], [4, 3])
        self.assertEqual(report["largest"], 0.5)
        self.assertEqual(report["largest_at"], [2, 1])
        mean_square = (0.5 ** 2 + 0.25 ** 2) / 48
        self.assertAlmostEqual(report["rms"], math.sqrt(mean_square), places=14)
        self.assertAlmostEqual(report["psnr"], -10 * math.log10(mean_square), places=10)
        self.assertEqual(report["percentile_99_9"], 0.5)
        channels = report["channels"]
        self.assertEqual(channels["red"]["largest"], 0)
        self.assertEqual(channels["green"]["largest"], 0.5)
        self.assertEqual(channels["blue"]["largest"], 0)
        self.assertEqual(channels["alpha"]["largest"], 0.25)
        text = self.succeed("compare", "a.exr", "b.exr")
        self.assertIn("largest at column 2, row 1", text)

    def test_largest_decides_the_exit_code(self):
        self.succeed("compare", "a.exr", "b.exr", "--largest", "0.5")
        result = self.run_program("compare", "a.exr", "b.exr", "--largest", "0.4999")
        self.assertEqual(result.returncode, 1)
        self.assertRegex(result.stderr.decode(),
                         r"\Apellucid: error: [^\n]*0\.5, at column 2, row 1[^\n]*\n\Z")
        self.assertIn(b"largest", result.stdout)
        self.fail_with("--largest", "compare", "a.exr", "b.exr", "--largest", "nan", code=2)
        self.fail_with("--largest", "compare", "a.exr", "b.exr", "--largest", "-1", code=2)

    def test_tolerance_decides_the_exit_code(self):
        for tolerance in ("0.5", "1/2", "1"):
            report = self.report("compare", "a.exr", "b.exr", "--tolerance", tolerance)
            self.assertEqual(report["pixels_over"], 0)
        self.assertNotIn("pixels_over", self.report("compare", "a.exr", "b.exr"))
        result = self.run_program("compare", "a.exr", "b.exr", "--tolerance", "1/5", "--json")
        self.assertEqual(result.returncode, 3)
        self.assertRegex(result.stderr.decode(),
                         r"\Apellucid: error: 2 of 12 pixels differ by more "
                         r"than 0\.2, [^\n]*column 2, row 1[^\n]*\n\Z")
        report = json.loads(result.stdout)
        self.assertEqual((report["tolerance"], report["pixels_over"]), (0.2, 2))
        result = self.run_program("compare", "a.exr", "b.exr", "--tolerance", "0.3")
        self.assertEqual(result.returncode, 3)
        self.assertIn(b"pixels that differ by more than 0.3: 1\n", result.stdout)
        for wrong in ("nan", "inf", "0", "-1", "1/0", "one", ""):
            self.fail_with("--tolerance", "compare", "a.exr", "b.exr", "--tolerance", wrong, code=2)

    def test_not_finite_is_over_any_tolerance(self):
        self.write("n.exr",
                   exr([[(0.25, float("inf"), 0.75, 1.0)] + [(0.25, 0.5, 0.75, 1.0)] * 3] * 3))
        result = self.run_program("compare", "a.exr", "n.exr", "--tolerance", "1e300")
        self.assertEqual(result.returncode, 3)
        self.assertIn(b"3 of 12 pixels", result.stderr)

    def test_error_of_the_first_image_is_held_against_the_difference(self):
        rows = [[(0.25, 0.5, 0.75, 1.0)] * 4 for _ in range(3)]
        self.assertNotIn("error", self.report("compare", "a.exr", "b.exr"))
        self.write("e.exr", exr(rows, error=[[0.5] * 4] * 3, proved=[[1, 0, 1, 1]] * 3))
        self.assertNotIn("error", self.report("compare", "b.exr", "e.exr"))
        error = self.report("compare", "e.exr", "b.exr")["error"]
        self.assertEqual((error["pixels"], error["over"], error["share_over"]), (12, 0, 0))
        self.assertEqual((error["proved"], error["unknown"]), (9, 0))
        self.assertEqual(error["tightness_smallest"], 1)  # differences of 0.5 and 0.25
        self.assertEqual(error["tightness_median"], 2)
        self.assertEqual(error["worst_at"], [2, 1])
        self.assertIn("0 of 12 pixels differ by more", self.succeed("compare", "e.exr", "b.exr"))
        # Without a mark all are estimates.
        self.write("f.exr", exr(rows, error=[[0.5, 0.5, 0.375, float("inf")]] * 3))
        error = self.report("compare", "f.exr", "b.exr")["error"]
        self.assertEqual((error["over"], error["unknown"], error["proved"]), (1, 3, 0))
        self.assertAlmostEqual(error["share_over"], 1 / 9)
        self.assertEqual((error["worst_difference"], error["worst_error"]), (0.5, 0.375))
        text = self.succeed("compare", "f.exr", "b.exr")
        self.assertIn("unknown in 3 pixels", text)
        self.assertIn("worst at column 2, row 1", text)

    def test_hostile_errors(self):
        nan = float("nan")
        rows = [[(0.25, 0.5, 0.75, 1.0)] * 4 for _ in range(3)]
        self.write("e.exr", exr(rows, error=[[nan, -1.0, float("-inf"), 0.0]] * 3,
                                proved=[[nan, 7.0, -1.0, 0.25]] * 3))
        error = self.report("compare", "e.exr", "a.exr")["error"]
        self.assertEqual((error["unknown"], error["over"], error["proved"]), (6, 3, 3))
        self.assertIsNone(error["tightness_median"])

    def test_values_that_are_not_finite(self):
        nan = float("nan")
        self.write("n.exr", exr([[(0.25, nan, 0.75, 1.0)] + [(0.25, 0.5, 0.75, 1.0)] * 3] * 3))
        report = self.report("compare", "a.exr", "n.exr")
        self.assertEqual(report["not_finite"], 3)
        self.assertFalse(report["identical"])
        result = self.run_program("compare", "a.exr", "n.exr", "--largest", "1")
        self.assertEqual(result.returncode, 1)
        self.assertIn(b"not finite", result.stderr)

    def test_difference_picture(self):
        report = self.report("compare", "a.exr", "b.exr", "--difference", "d.png")
        self.assertEqual(report["difference"]["path"], "d.png")
        self.assertIn("times 2", report["difference"]["shows"])
        picture = png(self.read("d.png"))
        self.assertEqual(picture[:3], (4, 3, 3))
        self.assertEqual(pixel(picture, 0, 0), (0, 0, 0))
        self.assertEqual(pixel(picture, 2, 1), (255, 255, 255))
        self.assertEqual(pixel(picture, 3, 2), (188, 188, 188))  # sRGB of linear 0.5

    def test_difference_image(self):
        self.succeed("compare", "a.exr", "b.exr", "--difference", "d.exr")
        self.write("zero.exr", exr([[(0.0, 0.0, 0.0, 0.0)] * 4 for _ in range(3)]))
        report = self.report("compare", "d.exr", "zero.exr")
        self.assertEqual(report["channels"]["green"]["largest"], 0.5)
        self.assertEqual(report["channels"]["alpha"]["largest"], 0.25)
        self.assertEqual(report["channels"]["red"]["largest"], 0)

    def test_bad_input(self):
        self.fail_with("nothing.exr", "compare", "a.exr", "nothing.exr")
        self.write("small.exr", exr([[(0.0, 0.0, 0.0, 0.0)] * 2]))
        self.fail_with("4 x 3.*2 x 1", "compare", "a.exr", "small.exr")
        self.write("cut.exr", self.read("a.exr")[:-20])
        self.fail_with("cut.exr", "compare", "a.exr", "cut.exr")
        self.write("text.exr", "not an image")
        self.fail_with("text.exr", "compare", "text.exr", "a.exr")
        self.fail_with("text.exr", "compare", "text.exr", "a.exr", "--difference", "d.png")
        self.fail_with(r"\.png or \.exr", "compare", "a.exr", "b.exr", "--difference", "d.gif",
                       code=2)
        self.fail_with("missing", "compare", "a.exr", "b.exr", "--difference", "missing/d.png")


if __name__ == "__main__":
    unittest.main()
