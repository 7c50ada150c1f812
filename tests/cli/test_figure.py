# SPDX-License-Identifier: Apache-2.0
"""--figure: pictures with text and lines, as .pdf, .svg and .png."""
import json
import os
import re
import shutil
import subprocess
import unittest
import xml.etree.ElementTree
import zlib

from program import HAZE, OVERLAPPING, ProgramTest, npy, pixel, png, ramp
from svg import SVG, XLINK, is_glyph, lines, points, properties

HAS_CAIRO = os.environ.get("PELLUCID_HAS_CAIRO") == "1"
WIDTH = 85 * 72 / 25.4
# Opaque within a voxel, with colors that no others are like.
OPAQUE = {"points": [{"value": 0, "extinction": 50, "color": [1, 0, 0]},
                     {"value": 60, "extinction": 80, "color": [0.1, 0.8, 0.2]},
                     {"value": 100, "extinction": 50, "color": [0, 0, 1]}]}


def srgb(light):
    """Bytes of linear light."""
    return tuple(255 * (12.92 * x if x <= 0.0031308 else 1.055 * x ** (1 / 2.4) - 0.055)
                 for x in light)


def color_at(function, value):
    """Linear color of a transfer function at a value, by linear interpolation."""
    points = function["points"]
    for low, high in zip(points, points[1:]):
        if low["value"] <= value <= high["value"]:
            t = (value - low["value"]) / (high["value"] - low["value"])
            return [(1 - t) * a + t * b for a, b in zip(low["color"], high["color"])]
    raise ValueError(value)


# Data whose axes stand around the picture, with a legend.
TWO_CHANNELS = ("--channel", "a=builtin:marschner_lobb:8", "--channel", "b=builtin:shells:8",
                "--gaussian", "a=0.5~0.1,b=0.5~0.3;extinction 5;color #ff0000")


class Svg:
    """Boxes of pictures, lines and glyphs of an .svg, in points."""

    def __init__(self, text):
        root = xml.etree.ElementTree.fromstring(text)
        self.size = tuple(float(root.get(name).removesuffix("pt")) for name in ("width", "height"))
        elements = {e.get("id"): e for e in root.iter() if e.get("id")}
        self.images, self.lines, self.glyphs = [], [], []
        for use in root.iter(SVG + "use"):
            target = elements[use.get(XLINK)[1:]]
            matrix = re.fullmatch(r"matrix\((.*)\)", use.get("transform") or "")
            if target.tag.endswith("image") and matrix:
                across, _, _, down, left, top = (float(n) for n in matrix[1].split(","))
                width, height = (int(target.get(name)) for name in ("width", "height"))
                self.images.append((width, height, left, top, left + across * width,
                                    top + down * height))
        for use in root.iter(SVG + "use"):
            target = elements[use.get(XLINK)[1:]]
            if is_glyph(target):
                path = "".join(part.get("d") or "" for part in target)
                heights = [y for _, y in points(path)] or [0]
                self.glyphs.append((float(use.get("x")), float(use.get("y")),
                                    max(heights) - min(heights)))
        for drawn, ends in lines(root):
            self.lines.append((float(drawn["stroke-width"]), *ends[0], *ends[1]))

    def bar(self):
        """The box of the strip of colors: left, top, right, bottom."""
        return max(image[2:] for image in self.images if image[:2] == (1, 1024))

    def bar_ticks(self):
        right = self.bar()[2]
        return [y0 for width, x0, y0, x1, y1 in self.lines
                if abs(x0 - right) < 5e-3 and y0 == y1 and x1 > x0]

    def picture(self):
        return next(image[2:] for image in self.images if image[0] > 1)


def raster_in(figure, picture, box):
    """The enlargement with which a picture is in a figure, pixel for pixel, near a box in points;
    None: it is not there."""
    width, height, channels, lines = picture
    scale = figure[0] / WIDTH
    factor = round(scale * (box[2] - box[0]) / width)
    wanted = [b"".join(line[channels * x:channels * x + 3] * factor for x in range(width))
              for line in lines]
    left, top = round(scale * box[0]), round(scale * box[1])
    for row in range(top - 1, top + 2):
        for column in range(left - 1, left + 2):
            if all(figure[3][row + factor * y + j][3 * column:3 * (column + factor * width)]
                   == wanted[y] for y in range(height) for j in range(factor)):
                return factor
    return None


@unittest.skipUnless(HAS_CAIRO, "built without Cairo")
class Figures(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("ramp.npy", npy([100 * x for x in ramp(10)], (10, 10, 10)))
        self.write("tf.json", json.dumps(OPAQUE))
        self.options = ["--tf", "tf.json", "--size", "60x50", "--background", "white"]

    def figure(self, name, *arguments, data="ramp.npy"):
        result = self.run_program("render", data, *self.options, *arguments, "--figure", name)
        self.assertEqual(result.returncode, 0, result.stderr)
        return self.read(name)

    def svg(self, *arguments, **options):
        return Svg(self.figure("a.svg", *arguments, **options).decode())

    def caption(self, *arguments, data="ramp.npy"):
        """The text of a figure, read by another program."""
        if not shutil.which("pdftotext"):
            self.skipTest("no pdftotext")
        self.figure("text.pdf", *arguments, data=data)
        text = subprocess.run(["pdftotext", self.path("text.pdf"), "-"], capture_output=True,
                              check=True).stdout.decode()
        return re.sub(r"\s+", " ", text)

    def test_writes_three_formats_beside_a_picture(self):
        self.succeed("render", "ramp.npy", *self.options, "-o", "a.png", "--figure", "b.pdf",
                     "--figure", "b.svg", "--figure", "b.png")
        self.succeed("render", "ramp.npy", *self.options, "-o", "plain.png")
        self.assertEqual(self.read("a.png"), self.read("plain.png"))
        self.assertTrue(self.read("b.pdf").startswith(b"%PDF-1."))
        self.assertTrue(self.read("b.svg").startswith(b"<?xml"))
        report = self.report("render", "ramp.npy", *self.options, "--figure", "c.pdf")
        self.assertEqual(report["outputs"], ["c.pdf"])

    def test_is_the_same_file_again(self):
        for name in ("a.pdf", "a.svg", "a.png"):
            first = self.figure(name)
            self.assertEqual(self.figure(name), first, name)
        self.assertNotIn(b"/CreationDate", self.figure("a.pdf"))
        result = self.run_program("render", "ramp.npy", *self.options, "--figure", "a.pdf",
                                  env={**os.environ, "SOURCE_DATE_EPOCH": "1000000000"})
        self.assertEqual(result.returncode, 0)
        self.assertIn(b"20010909014640", self.all_streams(self.read("a.pdf")))

    @staticmethod
    def all_streams(pdf):
        """The bytes of a PDF, and what its streams hold."""
        text = pdf
        for found in re.finditer(rb"stream\r?\n", pdf):
            try:
                text += zlib.decompressobj().decompress(pdf[found.end():])
            except zlib.error:
                pass
        return text

    def test_pdf_is_valid(self):
        pdf = self.figure("a.pdf")
        at = int(re.search(rb"startxref\s+(\d+)\s+%%EOF\s*\Z", pdf)[1])
        self.assertRegex(pdf[at:at + 20], rb"\A(xref|\d+ 0 obj)")
        box = re.search(rb"/MediaBox \[ *0 0 ([0-9.]+) ([0-9.]+)", self.all_streams(pdf))
        self.assertAlmostEqual(float(box[1]), WIDTH, places=2)
        if shutil.which("pdffonts"):
            fonts = subprocess.run(["pdffonts", self.path("a.pdf")], capture_output=True,
                                   check=True).stdout.decode().splitlines()[2:]
            self.assertTrue(fonts)
            for font in fonts:  # embedded, a subset, with the characters of its glyphs
                self.assertRegex(font, r" yes +yes +yes ")

    def test_png_holds_the_picture_pixel_for_pixel(self):
        self.succeed("render", "ramp.npy", *self.options, "-o", "a.png")
        parts = ["--figure-without", "axes,scale-bar,letters"]
        box = self.svg(*parts).picture()
        figure = png(self.figure("f.png", *parts))
        factor = raster_in(figure, png(self.read("a.png")), box)
        self.assertIsNotNone(factor)
        self.assertGreater(factor, 1)
        head = self.read("f.png")
        per_metre = int.from_bytes(head[head.index(b"pHYs") + 4:][:4], "big")
        self.assertGreaterEqual(per_metre, 300 / 0.0254 - 1)
        self.assertAlmostEqual(figure[0] / per_metre, 0.085, delta=0.0005)

    def test_colors_of_the_bar_are_those_of_the_function(self):
        bar = self.svg().bar()
        figure = png(self.figure("a.png"))
        scale = figure[0] / WIDTH
        middle = int(scale * (bar[0] + bar[2]) / 2)
        tested = 0
        for row in range(figure[1]):
            share = 1 - ((row + 0.5) / scale - bar[1]) / (bar[3] - bar[1])
            if not 0.01 < share < 0.99:
                continue
            steps = [srgb(color_at(OPAQUE, 100 * (share + d))) for d in (-0.003, 0, 0.003)]
            for c, shown in enumerate(pixel(figure, middle, row)):
                values = [step[c] for step in steps]
                self.assertGreaterEqual(shown, min(values) - 1, (share, c))
                self.assertLessEqual(shown, max(values) + 1, (share, c))
            tested += 1
        self.assertGreater(tested, 300)

    def test_a_slab_has_the_color_of_its_value(self):
        for value in (10, 60, 85):
            self.write("slab.npy", npy([value] * 512, (8, 8, 8)))
            bar = self.svg(data="slab.npy").bar()
            figure = png(self.figure("slab.png", "-o", "picture.png", data="slab.npy"))
            shown = pixel(png(self.read("picture.png")), 30, 25)[:3]
            scale = figure[0] / WIDTH
            row = int(scale * (bar[3] - value / 100 * (bar[3] - bar[1])))
            in_bar = pixel(figure, int(scale * (bar[0] + bar[2]) / 2), row)
            for a, b, truth in zip(shown, in_bar, srgb(color_at(OPAQUE, value))):
                self.assertAlmostEqual(a, truth, delta=1.5)
                self.assertAlmostEqual(b, truth, delta=2.5)

    def test_ticks_of_the_bar_are_at_their_values(self):
        for low, high in ((0, 100), (3, 97), (12.5, 61), (-40, -7)):
            svg = self.svg("--range", f"{low}:{high}")
            _, top, _, bottom = svg.bar()
            values = sorted(low + (bottom - y) / (bottom - top) * (high - low)
                            for y in svg.bar_ticks())
            self.assertGreaterEqual(len(values), 3)
            step = round((values[-1] - values[0]) / (len(values) - 1), 6)
            self.assertIn(f"{step:.0e}"[0], "125")
            for value in values:
                self.assertAlmostEqual(value / step, round(value / step), places=3)
            # None that fits is left out.
            self.assertLess(values[0] - low, step)
            self.assertLess(high - values[-1], step)

    def test_numbers_stand_at_their_ticks(self):
        if not shutil.which("pdftotext"):
            self.skipTest("no pdftotext")
        arguments = ["--range", "-40:140", "--figure-without", "axes,caption,letters,scale-bar"]
        svg = self.svg(*arguments)
        self.figure("a.pdf", *arguments)
        text = subprocess.run(["pdftotext", "-bbox", self.path("a.pdf"), "-"], capture_output=True,
                              check=True).stdout.decode()
        words = re.findall(r'yMin="([0-9.]+)" xMax="[0-9.]+" yMax="([0-9.]+)">([^<]+)<', text)
        _, top, _, bottom = svg.bar()
        numbers = 0
        for low, high, word in words:
            try:
                value = float(word.replace("\u2212", "-"))
            except ValueError:
                continue
            numbers += 1
            wanted = bottom - (value + 40) / 180 * (bottom - top)
            self.assertAlmostEqual((float(low) + float(high)) / 2, wanted, delta=1)
        self.assertEqual(numbers, len(svg.bar_ticks()))

    def test_text_is_not_smaller_than_6_points(self):
        for width in ("85", "180", "30"):
            svg = self.svg("--figure-width", width, "--color-bar-title", "HHHH")
            self.assertAlmostEqual(svg.size[0], float(width) * 72 / 25.4, places=2)
            # A capital letter of a sans-serif is some 0.7 of its size.
            tallest = max(height for _, _, height in svg.glyphs)
            self.assertGreater(tallest, 0.7 * 6.5)
        if shutil.which("pdftotext"):
            self.figure("a.pdf")
            text = subprocess.run(["pdftotext", "-bbox", self.path("a.pdf"), "-"],
                                  capture_output=True, check=True).stdout.decode()
            words = re.findall(r'xMin="([0-9.]+)" yMin="([0-9.]+)" xMax="([0-9.]+)" '
                               r'yMax="([0-9.]+)">([^<]+)<', text)
            self.assertGreater(len(words), 10)
            for left, top, right, bottom, word in words:  # some are upright
                self.assertGreater(max(float(right) - float(left), float(bottom) - float(top)), 6,
                                   word)

    def test_parts_are_left_out(self):
        whole = self.svg()
        fewer = {part: self.svg("--figure-without", part)
                 for part in ("color-bar", "axes", "caption")}
        self.assertRaises(ValueError, fewer["color-bar"].bar)
        self.assertLess(len(fewer["axes"].lines), len(whole.lines))
        self.assertLess(fewer["caption"].size[1], whole.size[1])
        self.assertLess(len(fewer["caption"].glyphs), len(whole.glyphs) - 50)
        # Without its bar the picture is wider.
        none = self.svg("--figure-without", "color-bar,axes,caption,letters,scale-bar")
        self.assertEqual(none.glyphs, [])
        left, _, right, _ = none.picture()
        self.assertAlmostEqual(right - left, WIDTH - 6, delta=0.01)

    def test_caption_tells_the_accuracy(self):
        self.assertIn("Each pixel within 0.00195 of the integral; largest error", self.caption())
        self.assertIn("within 0.0001 of", self.caption("--tolerance", "1e-4"))
        self.assertIn("(proved)", self.caption("--grade", "proved"))
        self.assertIn("Sampled by the method midpoint; the error is not known.",
                      self.caption("--method", "midpoint"))
        self.assertIn("by adaptive quadrature to 1e\u221212", self.caption("--reference"))

    def test_caption_counts_pixels_over_the_tolerance(self):
        # Two cells that overlap: what is seen through them is not known.
        self.write("mesh.vtk", OVERLAPPING)
        result = self.run_program("render", "mesh.vtk", "--size", "40", "--figure", "a.pdf")
        if result.returncode == 0:
            self.skipTest("these cells are rendered to the tolerance")
        self.assertEqual(result.returncode, 3, result.stderr)
        if shutil.which("pdftotext"):
            text = subprocess.run(["pdftotext", self.path("a.pdf"), "-"], capture_output=True,
                                  check=True).stdout.decode()
            self.assertRegex(text, r"\d+ of 1600 pixels may be off")

    def test_hostile_titles(self):
        options = self.options
        for title in ("a\x01b\nc", "x" * 5000, "word " * 2000,
                      b"\xff\xfe bad \xc3".decode("utf-8", "surrogateescape"),
                      "\u05e9\u05dc\u05d5\u05dd \u0645\u0631\u062d\u0628\u0627",
                      "<&\">]]>", "%n%s\\", "\U0001f600"):
            self.options = [*options, "--color-bar-title", title, "--figure", "a.pdf",
                            "--figure", "a.png"]
            self.figure("a.svg")
            svg = Svg(self.read("a.svg").decode())
            self.assertAlmostEqual(svg.size[0], WIDTH, places=2)
            self.assertLess(svg.size[1], 2 * WIDTH)

    def test_small_and_long_pictures(self):
        for size in ("1x1", "2x2000", "2000x2", "3x5"):
            for name in ("a.svg", "a.pdf"):
                self.options[3] = size
                self.figure(name)
            self.assertLess(Svg(self.read("a.svg").decode()).size[1], 2.5 * WIDTH)
        self.options[3] = "3x5"
        self.assertGreater(png(self.figure("a.png"))[0], 900)

    def test_bars_that_are_higher_than_the_picture_end_above_the_caption(self):
        bars = 6
        layers = [{"field": {"file": "ramp.npy"}, "transfer_function": OPAQUE}] * bars
        self.write("bars.json", json.dumps({
            "pellucid": 2, "layers": layers, "image": {"width": 60, "height": 50}}))
        result = self.run_program("render", "bars.json", "--figure", "a.svg")
        self.assertEqual(result.returncode, 0, result.stderr)
        svg = Svg(self.read("a.svg").decode())
        strips = [image for image in svg.images if image[1] == 1024]
        self.assertGreaterEqual(len(strips), bars)
        caption = max(y for _, y, _ in svg.glyphs)
        self.assertLess(max(image[5] for image in strips), caption - 6)
        self.assertLess(caption, svg.size[1])
        self.assertGreaterEqual(min(image[3] for image in strips), 0)

    def test_refuses_what_is_too_large_before_rendering(self):
        self.fail_with("figure: Cairo draws pictures of at most 32767", "render", "ramp.npy",
                       "--size", "40000x40000", "--figure", "a.pdf")
        self.fail_with(r"figure: a .png of the picture's pixels would be", "render", "ramp.npy",
                       "--size", "32000x30000", "--figure", "a.png")

    def test_background_goes_on_no_farther_than_the_figure(self):
        self.succeed("render", *TWO_CHANNELS, "--size", "60", "--figure", "a.png")
        width, _, channels, rows = png(self.read("a.png"))
        left = round(3 * width / (85 / 25.4 * 72))
        self.assertTrue(all(set(row[:channels * left]) == {255} for row in rows))
        inside = [row[channels * left] < 255 for row in rows]
        self.assertGreater(inside.index(False, inside.index(True)), width / 2)

    def test_axes_without_room_stand_over_the_picture(self):
        narrow = ["--size", "32", "--figure-width", "30", "--color-bar-title", "w" * 300]
        self.succeed("render", *TWO_CHANNELS, *narrow, "--figure", "a.svg", "--figure", "a.png")
        self.assertGreater(png(self.read("a.png"))[0], 300)

    def test_no_bars(self):
        self.options = ["--size", "30", "--tf", "tf.json", "--opacity", "0"]
        svg = self.svg()
        self.assertRaises(ValueError, svg.bar)
        left, _, right, _ = svg.picture()
        self.assertGreater(right - left, WIDTH / 2)

    def test_legend_of_isosurfaces_and_labels(self):
        self.options = ["--size", "30", "--iso", "30:#ff0000", "--iso", "70:#0000ff"]
        figure = xml.etree.ElementTree.fromstring(self.figure("a.svg").decode())
        colors = {properties(element).get("fill") for element in figure.iter()}
        self.assertLessEqual({"rgb(100%,0%,0%)", "rgb(0%,0%,100%)"}, colors)
        self.write("labels.npy", npy([i % 3 for i in range(64)], (4, 4, 4), "<u1"))
        self.options = ["--size", "30"]
        self.assertRegex(self.caption("--labels", "labels.npy"), r"labels\S* 1 2")
        self.options += ["--gaussian", "value=50~10; extinction 2"]
        self.assertIn("value 50", self.caption())

    def test_refuses_in_one_line(self):
        render = ["render", "ramp.npy", *self.options]
        for pattern, arguments in (
                (r"--figure a.jpg: expected a name that ends in .pdf, .svg or .png",
                 ["--figure", "a.jpg"]),
                ("--figure-width '3': expected a width from 30 to 1000 mm",
                 ["--figure", "a.pdf", "--figure-width", "3"]),
                ("--figure-width 'wide': expected mm, or a length",
                 ["--figure", "a.pdf", "--figure-width", "wide"]),
                ("--figure-without 'axis': expected some of color-bar, axes",
                 ["--figure", "a.pdf", "--figure-without", "axis"]),
                ("--figure-with 'axes,': expected some of",
                 ["--figure", "a.pdf", "--figure-with", "axes,"]),
                ("--figure-unit: is of --figure FILE",
                 ["-o", "a.png", "--figure-unit", "mm"]),
                ("--figure ramp.npy: expected a name that ends", ["--figure", "ramp.npy"]),
                ("--figure a.png: the same file is written twice, also by -o",
                 ["-o", "a.png", "--figure", "a.png"])):
            self.fail_with(pattern, *render, *arguments, code=2)
        self.fail_with("missing", *render, "--figure", "missing/a.pdf")
        # Also a file that a scene names.
        self.succeed(*render, "-o", "behind.exr", "--depth", "d.png")
        os.rename(self.path("behind.exr"), self.path("behind.png"))
        self.fail_with("--figure behind.png: would overwrite the input", *render[:2], "--tf",
                       "behind.png", "--figure", "behind.png", code=2)

    def test_ranks_draw_none(self):
        self.fail_with("--figure: is not done by --ranks", "render", "ramp.npy", "--ranks",
                       "--figure", "a.pdf", code=2)


@unittest.skipIf(HAS_CAIRO, "built with Cairo")
class FiguresWithoutCairo(ProgramTest):
    def test_says_what_is_missing(self):
        self.write("ramp.npy", npy([100 * x for x in ramp(10)], (10, 10, 10)))
        self.write("tf.json", json.dumps(HAZE))
        self.fail_with("pellucid_cairo.so, which draws figures, is not there", "render",
                       "ramp.npy", "--figure", "a.pdf")


if __name__ == "__main__":
    unittest.main()
