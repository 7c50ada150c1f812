# SPDX-License-Identifier: Apache-2.0
import math
import unittest

from program import ProgramTest, npy, png, png_texts, ramp

NAN = float("nan")


class Histogram(ProgramTest):
    def test_one_file_is_value_by_gradient_magnitude(self):
        # The ramp's gradient is 2 per world unit everywhere: 3 steps over a length of 1.5.
        self.write("a.npy", npy(ramp(4), (4, 4, 4)))
        report = self.report("histogram", "a.npy", "--spacing", "0.5,1,1", "--bins", "4x2")
        self.assertEqual([axis["channel"] for axis in report["axes"]],
                         ["value", "gradient_magnitude"])
        self.assertEqual(report["dimensions"], [4, 4, 4])
        value, gradient = report["axes"]
        self.assertEqual(value["range"], [0, 1])
        self.assertEqual(value["edges"], [0, 0.25, 0.5, 0.75, 1])
        for end in gradient["range"]:
            self.assertAlmostEqual(end, 2 / 3, places=6)
        self.assertEqual(len(report["count"]), 2)
        # Both neighbours of the one gradient there is: which bin it falls into is rounding's.
        columns = [sum(row[i] for row in report["count"]) for i in range(4)]
        self.assertEqual(columns, [16, 16, 16, 16])
        self.assertEqual(report["counted"], 64)
        self.assertEqual((report["nan"], report["outside"]), (0, 0))

    def test_two_files_are_counted_together(self):
        self.write("a.npy", npy([0, 1, 2, 3, 3, 3, 0, 9], (2, 2, 2), "|u1"))
        self.write("b.x.npy", npy([0, 0.5, 1, 2, 2, 0.9, NAN, 1], (2, 2, 2)))
        report = self.report("histogram", "a.npy", "b.x.npy", "--bins", "4x2", "--range-x", "0,4",
                             "--range-y", "0,2")
        self.assertEqual([axis["channel"] for axis in report["axes"]], ["a", "b"])
        self.assertEqual(report["count"], [[1, 1, 0, 1], [0, 0, 1, 2]])
        self.assertEqual(report["nan"], 1)
        self.assertEqual(report["outside"], 1)
        self.assertEqual(report["axes"][1]["nan"], 1)
        self.assertEqual(report["axes"][1]["type"], "f32")
        turned = self.report("histogram", "a.npy", "b.x.npy", "--bins", "2x4", "--axes", "b,a",
                             "--range-y", "0,4", "--range-x", "0,2")
        self.assertEqual(turned["count"], [list(c) for c in zip(*report["count"])])

    def test_one_axis(self):
        self.write("a.npy", npy([0, 1, 2, 3, 3, 3, 0, 9], (2, 2, 2), "|u1"))
        report = self.report("histogram", "a.npy", "--axes", "value")
        # Bins of one integer each, and no more than there are.
        self.assertEqual(report["count"], [2, 1, 1, 3, 0, 0, 0, 0, 0, 1])
        self.assertEqual(report["axes"][0]["edges"], [i - 0.5 for i in range(11)])
        self.assertIsNone(report["output"])

    def test_further_channels(self):
        self.write("a.npy", npy(ramp(4), (4, 4, 4)))
        report = self.report("histogram", "a.npy", "--channel", "soft=smoothed:value:1.5",
                             "--channel", "edge=gradient_magnitude:soft", "--axes", "soft,edge")
        self.assertEqual([axis["channel"] for axis in report["axes"]], ["soft", "edge"])
        lower, upper = report["axes"][0]["range"]
        self.assertTrue(0 < lower < upper < 1)
        report = self.report("histogram", "--channel", "f=builtin:ramp:8", "--axes", "f")
        self.assertEqual(report["axes"][0]["range"], [-1, 1])

    def test_components_of_a_file(self):
        self.write("c.raw", bytes([0, 10, 1, 11, 2, 12, 3, 13, 4, 14, 5, 15, 6, 16, 7, 17]))
        options = ("--dimensions", "2,2,2", "--type", "u8", "--components", "2")
        report = self.report("histogram", "--channel", "x=c.raw[0]", "--channel", "z=c.raw[1]",
                             *options)
        self.assertEqual([axis["range"] for axis in report["axes"]], [[0, 7], [10, 17]])
        # Brackets go before the option.
        report = self.report("histogram", "--channel", "x=c.raw[0]", "--channel", "z=c.raw",
                             *options, "--component", "1")
        self.assertEqual([axis["range"] for axis in report["axes"]], [[0, 7], [10, 17]])

    def test_picture(self):
        self.write("a.npy", npy(ramp(4), (4, 4, 4)))
        self.succeed("histogram", "a.npy", "-o", "h.png", "--bins", "16")
        width, height, channels, rows = png(self.read("h.png"))
        self.assertEqual(channels, 3)
        self.assertGreater(width, 512)
        self.assertGreater(height, 512)
        self.assertEqual(bytes(rows[0][:3]), b"\xff\xff\xff")
        self.assertEqual(png_texts(self.read("h.png"))["pellucid.source"], "a.npy")
        self.succeed("histogram", "a.npy", "-o", "h1.png", "--axes", "value")
        self.assertEqual(self.files(), ["a.npy", "h.png", "h1.png"])

    def test_is_the_same_for_any_number_of_threads(self):
        arguments = ("histogram", "builtin:hydrogen:40", "--json", "--threads")
        self.assertEqual(self.succeed(*arguments, "1"), self.succeed(*arguments, "3"))

    def test_all_nan(self):
        self.write("a.npy", npy([NAN] * 8, (2, 2, 2)))
        report = self.report("histogram", "a.npy", "--axes", "value", "--bins", "3")
        self.assertEqual(report["count"], [0, 0, 0])
        self.assertEqual(report["nan"], 8)
        self.assertIsNone(report["axes"][0]["range"])
        result = self.run_program("histogram", "a.npy", "-o", "h.png")
        self.assertEqual(result.returncode, 0)
        self.assertIn(b"8 points with a NaN", result.stderr)

    def test_numbers_are_json(self):
        self.write("a.npy", npy([-1e37, 1e37, 0, 1, 2, 3, 4, NAN], (2, 2, 2), "<f8"))
        report = self.report("histogram", "a.npy", "--axes", "value", "--bins", "5")
        self.assertTrue(all(math.isfinite(edge) for edge in report["axes"][0]["edges"]))
        self.assertEqual(report["counted"], 7)

    def test_wrong_arguments(self):
        self.write("a.npy", npy(ramp(2), (2, 2, 2)))
        self.write("b.npy", npy(ramp(2), (2, 2, 2)))
        self.write("c.npy", npy(ramp(3), (3, 3, 3)))
        self.fail_with("nothing to write; give -o", "histogram", "a.npy", code=2)
        self.fail_with(r"-o a\.jpg: expected a name that ends in \.png", "histogram", "a.npy", "-o",
                       "a.jpg", code=2)
        self.fail_with("give FILE or --channel", "histogram", "--json", code=2)
        self.fail_with("unknown channel 'b'; the channels are value, gradient_magnitude",
                       "histogram", "a.npy", "--axes", "b", "--json", code=2)
        self.fail_with("'value' is given twice", "histogram", "a.npy", "--axes", "value,value",
                       "--json", code=2)
        self.fail_with("3 channels are too many, at most 2 can be used; choose by --axes from a, "
                       "b, c", "histogram", "a.npy", "b.npy", "c.npy", "--json", code=2)
        for bins in ("0", "x", "4097", "3x4x5", "-1", "2x", "1.5"):
            self.fail_with(rf"--bins '{bins}': expected a number of bins from 1 to 4096",
                           "histogram", "a.npy", "--json", f"--bins={bins}", code=2)
        for ends in ("1,1", "2,1", "0", "0,nan", "0,1,2", "a,b"):
            self.fail_with(rf"--range-y '{ends}': expected two finite numbers", "histogram",
                           "a.npy", "--json", f"--range-y={ends}", code=2)
        self.fail_with("--range-y: there is one axis only", "histogram", "a.npy", "--json",
                       "--axes", "value", "--range-y", "0,1", code=2)
        self.fail_with("--channel: .*expected NAME=SOURCE", "histogram", "a.npy", "--json",
                       "--channel", "b", code=2)
        self.fail_with("--type applies to volume files, not to built-in fields", "histogram",
                       "--json", "--channel", "f=builtin:ramp:8", "--type", "u8", code=2)
        self.fail_with("not on one grid", "histogram", "a.npy", "c.npy", "--json")
        self.fail_with("missing", "histogram", "missing.npy", "--json")
        self.fail_with("no/h.png", "histogram", "a.npy", "-o", "no/h.png")
        self.write("d.png", npy(ramp(2), (2, 2, 2)))
        self.fail_with("d.png", "histogram", "d.png", "-o", "d.png", "--dimensions", "2,2,2",
                       "--type", "f32", code=2)


if __name__ == "__main__":
    unittest.main()
