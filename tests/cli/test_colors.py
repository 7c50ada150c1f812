# SPDX-License-Identifier: Apache-2.0
"""--colormap, --range, --opacity and --color-bar."""
import json
import os
import struct
import unittest

from program import HAZE, ProgramTest, exr_channels, npy, pixel, png, ramp

HAS_CAIRO = os.environ.get("PELLUCID_HAS_CAIRO") == "1"


def colored_nifti(pixels, sides):
    """A NIfTI file of bytes of color, three or four at each point."""
    samples = len(pixels[0])
    header = bytearray(352)
    struct.pack_into("<i", header, 0, 348)
    struct.pack_into("<8h", header, 40, 3, *sides, 1, 1, 1, 1)
    struct.pack_into("<hh", header, 70, 128 if samples == 3 else 2304, 8 * samples)
    struct.pack_into("<8f", header, 76, 1, 1, 1, 1, 1, 1, 1, 1)
    struct.pack_into("<f", header, 108, 352)
    header[344:348] = b"n+1\0"
    return bytes(header) + bytes(part for pixel in pixels for part in pixel)


class Colors(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("ramp.npy", npy([100 * x for x in ramp(10)], (10, 10, 10)))
        self.write("tf.json", json.dumps(HAZE))

    def function(self, *arguments):
        printed = json.loads(self.succeed("render", "ramp.npy", *arguments, "--print-tf"))
        return printed.get("transfer_function", printed)

    def test_lists_color_maps(self):
        names = self.succeed("presets", "--colormaps").split("\n")
        self.assertIn("viridis", names)
        self.assertIn("cool to warm", names)
        self.assertEqual(json.loads(self.succeed("presets", "--colormaps", "--json")), names[:-1])

    def test_colors_any_function(self):
        for source in ([], ["--tf", "tf.json"], ["--preset", "x-ray"], ["--projection", "maximum"]):
            plain = self.function(*source)["points"]
            points = self.function(*source, "--colormap", "Inferno")["points"]
            self.assertGreater(len(points), 20, source)
            # inferno goes from nearly black to a pale yellow, brighter and brighter.
            self.assertLess(max(points[0]["color"]), 0.02)
            self.assertGreater(min(points[-1]["color"][:2]), 0.9)
            light = [sum(weight * part for weight, part in
                         zip((0.2126, 0.7152, 0.0722), point["color"])) for point in points]
            self.assertEqual(light, sorted(light))
            self.assertEqual([points[0]["value"], points[-1]["value"]],
                             [plain[0]["value"], plain[-1]["value"]])
            self.assertEqual(max(p["extinction"] for p in points),
                             max(p["extinction"] for p in plain))
            back = self.function(*source, "--colormap", "inferno_r")["points"]
            self.assertEqual(back[0]["color"], points[-1]["color"])

    def test_range_moves_function_and_colors(self):
        for source in ([], ["--tf", "tf.json"], ["--preset", "x-ray"]):
            for text, ends in (("20:60", [20, 60]), ("-5,1e3", [-5, 1000])):
                points = self.function(*source, "--range", text)["points"]
                self.assertEqual([points[0]["value"], points[-1]["value"]], ends, source)
            points = self.function(*source, "--range", "25%:75%", "--colormap", "jet")["points"]
            # Ten values along an axis: 0, 11.1, …, 100.
            self.assertAlmostEqual(points[0]["value"], 200 / 9, delta=0.01)
            self.assertAlmostEqual(points[-1]["value"], 700 / 9, delta=0.01)

    def test_opacity_is_a_factor(self):
        for source in ([], ["--tf", "tf.json"], ["--preset", "x-ray"],
                       ["--gaussian", "value=50~10; extinction 2"]):
            plain, more = (self.function(*source, *rest) for rest in ([], ["--opacity", "2.5"]))
            kind = "gaussians" if "gaussians" in plain else "points"
            for a, b in zip(plain[kind], more[kind]):
                self.assertAlmostEqual(2.5 * a["extinction"], b["extinction"], places=12)

    def test_opacity_tables_stay_tables(self):
        table = {"points": [{"value": 0, "opacity": 0, "color": [1, 0, 0]},
                            {"value": 100, "opacity": 0.9, "color": [1, 0, 0]}],
                 "unit_distance": 6}
        self.write("table.json", json.dumps(table))
        made = self.function("--tf", "table.json", "--opacity", "3", "--colormap", "viridis",
                             "--range", "0:50")
        self.assertEqual(made["unit_distance"], 2)
        self.assertEqual(made["points"][-1]["opacity"], 0.9)
        self.assertEqual(made["points"][-1]["value"], 50)
        self.assertGreater(len(made["points"]), 10)

    def test_a_saved_scene_gives_the_same_picture(self):
        options = ["--size", "24", "--view", "front"]
        self.succeed("render", "ramp.npy", "--colormap", "coolwarm", "--range", "5%:80%",
                     "--opacity", "2", "-o", "a.exr", "--save-scene", "scene.json", *options)
        self.succeed("render", "scene.json", "-o", "b.exr")
        compared = self.report("compare", "a.exr", "b.exr")
        self.assertEqual(compared["largest"], 0)

    def test_shows_colors_as_they_are(self):
        options = ["--view", "front", "--size", "33", "--background", "black"]
        for color in ((200, 100, 50), (40, 60, 230)):
            self.write("rgb.nii", colored_nifti([color] * 512, (8, 8, 8)))
            result = self.run_program("render", "rgb.nii", "-o", "a.png", *options)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertIn(b"the data are colors", result.stderr)
            shown = pixel(png(self.read("a.png")), 16, 16)[:3]
            for ours, own in zip(shown, color):
                self.assertAlmostEqual(ours, own, delta=2)
        # A scene that is saved renders to the same.
        self.succeed("render", "rgb.nii", "-o", "a.exr", "--save-scene", "scene.json", *options)
        self.succeed("render", "scene.json", "-o", "b.exr")
        self.assertEqual(self.report("compare", "a.exr", "b.exr")["largest"], 0)
        # One component is data like others.
        self.succeed("render", "rgb.nii", "--component", "1", "-o", "c.png", *options)

    def test_opacity_of_colors_is_their_alpha(self):
        options = ["--view", "front", "--size", "33", "--background", "black"]
        # Alpha is 0 in one half (x), 255 in the other; the dark color of that is opaque.
        self.write("rgba.nii", colored_nifti(
            [(60, 20, 10, 0 if i % 8 < 4 else 255) for i in range(512)], (8, 8, 8)))
        self.succeed("render", "rgba.nii", "-o", "a.png", *options)
        _, _, channels, rows = picture = png(self.read("a.png"))
        row = [tuple(rows[16][channels * x:channels * x + 3]) for x in range(33)]
        self.assertIn((0, 0, 0), row[6:27])
        self.assertTrue(any(abs(r - 60) <= 2 and abs(g - 20) <= 2 for r, g, _ in row), row)
        self.assertEqual(picture[0], 33)
        # The same alpha everywhere says nothing: the luminance does.
        self.write("rgba.nii", colored_nifti(
            [(200, 200, 200, 255) if i % 8 < 4 else (0, 0, 0, 255) for i in range(512)],
            (8, 8, 8)))
        self.succeed("render", "rgba.nii", "-o", "b.exr", *options)
        self.assertLess(self.report("render", "rgba.nii", "-o", "b.exr", *options)["pixels_over"],
                        1)

    def test_refuses_in_one_line(self):
        gaussian = ["--gaussian", "value=50~10; extinction 2"]
        self.write("labels.npy", npy([i % 3 for i in range(64)], (4, 4, 4), "<u1"))
        for pattern, arguments in (
                ('did you mean viridis, .*presets --colormaps', ["--colormap", "virdis"]),
                ("--range '60:20': expected two ascending values", ["--range", "60:20"]),
                ("--range '5': expected", ["--range", "5"]),
                ("--range '1%:120%': expected", ["--range", "1%:120%"]),
                ("--opacity -1: expected a factor", ["--opacity", "-1"]),
                ("--colormap: is for a function of one variable",
                 ["--colormap", "jet", *gaussian]),
                ("--range: is for a function of one variable", ["--range", "0:1", *gaussian])):
            self.fail_with(pattern, "render", "ramp.npy", *arguments, "-o", "a.png", code=2)
        self.fail_with("range: got 99% to 3, which is", "render", "ramp.npy", "--range", "99%:3",
                       "-o", "a.png")
        self.fail_with("--colormap: is for INPUT", "render", "--labels", "labels.npy",
                       "--colormap", "jet", "-o", "a.png", code=2)

    def test_color_bar_is_for_pictures(self):
        self.fail_with("--color-bar: is drawn in a .png", "render", "ramp.npy", "--color-bar",
                       "-o", "a.exr", code=2)

    @unittest.skipUnless(HAS_CAIRO, "built without Cairo")
    def test_color_bar(self):
        options = ["--tf", "tf.json", "--range", "0:100", "--colormap", "viridis", "--size",
                   "160x120", "--background", "black", "--view", "front"]
        self.succeed("render", "ramp.npy", *options, "-o", "plain.png", "-o", "plain.exr")
        self.succeed("render", "ramp.npy", *options, "-o", "bar.png", "-o", "bar.exr",
                     "--color-bar")
        self.assertEqual(exr_channels(self.read("bar.exr")), exr_channels(self.read("plain.exr")))
        self.assertEqual(self.read("bar.exr"), self.read("plain.exr"))
        plain, bar = (png(self.read(name))[3] for name in ("plain.png", "bar.png"))
        columns = [x for x in range(160)
                   if any(a[3 * x:3 * x + 3] != b[3 * x:3 * x + 3] for a, b in zip(plain, bar))]
        self.assertGreater(min(columns), 80)  # over the right edge
        colors = {row[3 * x:3 * x + 3] for row in bar for x in columns}
        for wanted in ((72, 34, 115), (33, 145, 140), (187, 223, 39)):  # of viridis
            self.assertTrue(any(all(abs(a - b) < 8 for a, b in zip(color, wanted))
                                for color in colors), wanted)
        titled = [*options, "-o", "titled.png", "--color-bar-title", "temperature (K)"]
        self.succeed("render", "ramp.npy", *titled)
        self.assertNotEqual(self.read("titled.png"), self.read("bar.png"))

    @unittest.skipUnless(HAS_CAIRO, "built without Cairo")
    def test_says_that_there_is_nothing_to_draw(self):
        result = self.run_program("render", "ramp.npy", "--tf", "tf.json", "--opacity", "0",
                                  "--color-bar", "-o", "a.png", "--size", "16")
        self.assertEqual(result.returncode, 0)
        self.assertIn(b"no color bar: it shows functions, surfaces and labels", result.stderr)

    @unittest.skipUnless(HAS_CAIRO, "built without Cairo")
    def test_legend_of_gaussians(self):
        self.succeed("render", "ramp.npy", "--gaussian", "value=50~10; extinction 2; color #30c060",
                     "--color-bar", "-o", "a.png", "--size", "160", "--background", "black")
        _, _, _, rows = png(self.read("a.png"))
        colors = {row[3 * x:3 * x + 3] for row in rows for x in range(100, 160)}
        self.assertIn(bytes((0x30, 0xc0, 0x60)), colors)

    @unittest.skipIf(HAS_CAIRO, "built with Cairo")
    def test_color_bar_needs_cairo(self):
        self.fail_with("pellucid_cairo.so, which draws color bars, is not there", "render",
                       "ramp.npy", "--color-bar", "-o", "a.png")


if __name__ == "__main__":
    unittest.main()
