# SPDX-License-Identifier: Apache-2.0
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
