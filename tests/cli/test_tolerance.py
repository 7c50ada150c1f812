# SPDX-License-Identifier: Apache-2.0
"""What is asked of an image's error, what is told of it, and what happens where it is too large."""

import json
import unittest

from program import (HAZE, ProgramTest, exr_channels, exr_texts, npy, pixel, png, png_texts,
                     ramp)

FIELD = ("render", "builtin:marschner_lobb:12", "--tf", "tf.json", "--size", "16")
# More than binary32 can give.
OVER = (*FIELD, "--precision", "float", "--tolerance", "1e-7")
SPANS = ("skipped", "constant", "strides", "lines", "closed", "panels", "in_double")


class Tolerance(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("tf.json", json.dumps(HAZE))

    def scene(self, **integration):
        return json.dumps({
            "volumes": [{"field": {"builtin": "marschner_lobb", "points": 12},
                         "transfer_function": HAZE}],
            "image": {"width": 16, "height": 16}, "integration": integration})

    def test_report(self):
        report = self.report(*FIELD, "-o", "a.exr")
        self.assertEqual(report["tolerance_asked"], 1 / 512)
        self.assertEqual(report["tolerance"], 1 / 512)
        self.assertEqual(report["grade"], "estimated")
        self.assertEqual(report["precision"], "automatic")
        self.assertEqual((report["pixels"], report["pixels_over"]), (256, 0))
        self.assertLessEqual(report["pixels_proved"], 256)
        self.assertGreater(report["largest_error"], 0)
        self.assertLessEqual(report["largest_error"], 1 / 512)
        self.assertGreater(report["evaluations"], 0)
        self.assertEqual(report["evaluations_per_ray"], report["evaluations"] / 256)
        self.assertEqual(tuple(report["spans"]), SPANS)
        self.assertGreater(sum(report["spans"].values()), 0)
        self.assertEqual(report["transfer_function_error"], 0)

        report = self.report(*FIELD, "-o", "a.exr", "--tolerance", "1/4096", "--grade", "proved",
                             "--precision", "double")
        self.assertEqual((report["tolerance_asked"], report["tolerance"]), (1 / 4096, 1 / 4096))
        self.assertEqual((report["grade"], report["precision"]), ("proved", "double"))
        self.assertEqual(report["pixels_proved"], 256)

    def test_what_has_no_error_reports_none(self):
        keys = ("tolerance_asked", "tolerance", "grade", "largest_error", "pixels_proved",
                "pixels_over", "evaluations", "evaluations_per_ray", "spans")
        for arguments in (("--reference",), ("--method", "midpoint")):
            report = self.report(*FIELD, "-o", "a.exr", *arguments)
            self.assertEqual([report[key] for key in keys], [None] * len(keys))
            self.assertEqual(sorted(exr_channels(self.read("a.exr"))), ["A", "B", "G", "R", "Z"])
            texts = exr_texts(self.read("a.exr"))
            self.assertNotIn("pellucid.tolerance", texts)
            self.assertNotIn("pellucid.largest_error", texts)

    def test_text_report(self):
        lines = self.run_program(*FIELD, "-o", "a.exr").stderr.decode().splitlines()
        self.assertEqual(len(lines), 1)
        self.assertRegex(lines[0], r"of the pixels, [0-9.e-]+ s$")
        lines = self.run_program(*FIELD, "-o", "a.exr", "--verbose").stderr.decode().splitlines()
        self.assertEqual(len(lines), 2)
        self.assertRegex(lines[0], r"^pellucid: largest error of a pixel [0-9.e-]+, tolerance "
                                   r"0\.00195 \(grade estimated\); proved for .* of the pixels$")
        self.assertRegex(lines[1], r"^pellucid: [0-9.]+ field evaluations per ray, .* s; spans: ")
        lines = self.run_program(*FIELD, "-o", "a.exr", "--method", "linear").stderr.decode()
        self.assertRegex(lines,
                         r"\Apellucid: method linear, [^\n]* not known [^\n]*compare[^\n]*\n\Z")
        lines = self.run_program(*FIELD, "-o", "a.exr", "--reference").stderr.decode()
        self.assertRegex(lines, r"\Apellucid: adaptive quadrature to 1e-12[^\n]*\n\Z")
        for silent in ("--json", "--quiet"):
            self.assertEqual(self.run_program(*FIELD, "-o", "a.exr", silent).stderr, b"")

    def test_metadata(self):
        report = self.report(*FIELD, "-o", "a.exr", "-o", "a.png", "--tolerance", "1/1000",
                             "--grade", "proved", "--samples", "2")
        for texts in (exr_texts(self.read("a.exr")), png_texts(self.read("a.png"))):
            self.assertEqual(float(texts["pellucid.tolerance"]), 1 / 1000)
            self.assertEqual(texts["pellucid.grade"], "proved")
            self.assertEqual(texts["pellucid.samples"], "2")
            self.assertEqual(float(texts["pellucid.largest_error"]), report["largest_error"])
            self.assertEqual(int(texts["pellucid.pixels_proved"]), report["pixels_proved"])
            self.assertEqual(int(texts["pellucid.pixels_over"]), 0)
            self.assertEqual(texts["pellucid.precision"], "automatic")

    def test_error_channels(self):
        self.succeed(*FIELD, "-o", "a.exr")
        # Half for the mark: 1, float for the rest: 2.
        self.assertEqual(exr_channels(self.read("a.exr")),
                         {"A": 2, "B": 2, "G": 2, "R": 2, "Z": 2, "error": 2, "error.proved": 1})

    def test_every_pixel_keeps_what_it_says(self):
        self.succeed(*FIELD, "-o", "truth.exr", "--reference")
        for grade in ("estimated", "proved"):
            for tolerance in ("1e-2", "1/512", "1e-4", "1e-6"):
                with self.subTest(grade=grade, tolerance=tolerance):
                    made = self.report(*FIELD, "-o", "a.exr", "--tolerance", tolerance,
                                       "--grade", grade)
                    report = self.report("compare", "a.exr", "truth.exr", "--tolerance", tolerance)
                    self.assertEqual(report["pixels_over"], 0)
                    error = report["error"]
                    self.assertEqual((error["over"], error["unknown"]), (0, 0))
                    self.assertEqual(error["proved"], made["pixels_proved"])
                    self.assertGreaterEqual(error["tightness_smallest"], 0.99)
                    self.assertLessEqual(made["largest_error"], made["tolerance"])

    def faint(self, extinction):
        self.write("faint.json", json.dumps({"points": [
            {"value": point["value"], "extinction": extinction, "color": point["color"]}
            for point in HAZE["points"]]}))
        return ("render", "builtin:marschner_lobb:12", "--tf", "faint.json", "--size", "16")

    def test_black_pictures_are_told(self):
        faint = self.faint(1e-4)
        result = self.run_program(*faint, "-o", "a.exr")
        self.assertEqual(result.returncode, 0)
        self.assertRegex(result.stderr.decode(), r"(?m)^pellucid: no channel of any pixel is above "
                         r"the tolerance, 0\.00195: [^\n]*--tolerance 1%[^\n]*$")
        self.assertEqual(self.run_program(*faint, "-o", "a.exr", "--quiet").stderr, b"")
        report = self.report(*faint, "-o", "a.exr")
        self.assertIs(report["below_tolerance"], True)
        self.assertLess(report["largest_channel"], 1 / 512)
        report = self.report(*FIELD, "-o", "a.exr")
        self.assertIs(report["below_tolerance"], False)
        self.assertGreater(report["largest_channel"], 0.1)
        self.assertIsNone(report["relative_tolerance"])
        report = self.report(*FIELD, "-o", "a.exr", "--method", "midpoint")
        self.assertIsNone(report["below_tolerance"])
        # Nothing absorbs at all.
        empty = self.run_program(*self.faint(0), "-o", "a.exr")
        self.assertEqual(empty.returncode, 0)
        self.assertRegex(empty.stderr.decode(), "pellucid: the picture is empty: no ray meets")

    def test_relative_to_the_range_of_the_picture(self):
        for extinction in (1, 1e-3, 1e-5):
            faint = self.faint(extinction)
            self.succeed(*faint, "-o", "truth.exr", "--reference")
            for percent, share in (("10%", 0.1), ("1%", 0.01), ("2.5 %", 0.025)):
                with self.subTest(extinction=extinction, percent=percent):
                    if extinction == 1e-5 and share != 0.1:
                        continue  # below the smallest tolerance
                    result = self.run_program(*faint, "-o", "a.exr", "--tolerance", percent,
                                              "--json")
                    self.assertEqual(result.returncode, 0, result.stderr)
                    self.assertEqual(result.stderr, b"")
                    report = json.loads(result.stdout)
                    largest, used = report["largest_channel"], report["tolerance"]
                    self.assertEqual(report["relative_tolerance"], share)
                    self.assertLessEqual(used, share * largest)
                    self.assertGreater(used, 0.3 * share * largest)
                    self.assertIs(report["below_tolerance"], False)
                    report = self.report("compare", "a.exr", "truth.exr", "--tolerance",
                                         str(share * largest))
                    self.assertEqual(report["pixels_over"], 0)
        lines = self.run_program(*self.faint(1e-3), "-o", "a.exr", "--tolerance", "1%")
        self.assertRegex(lines.stderr.decode(), r"(?m)^pellucid: tolerance [0-9.e-]+: within 1 % "
                         r"of the largest channel, 0\.00[0-9]+$")
        texts = exr_texts(self.read("a.exr"))
        self.assertEqual(float(texts["pellucid.relative_tolerance"]), 0.01)
        # What 8 bits show as 0 is told beside a .png.
        dark = self.run_program(*self.faint(1e-5), "-o", "a.png", "--tolerance", "10%")
        self.assertRegex(dark.stderr.decode(), r"(?m)^pellucid: the largest channel is [0-9.e-]+, "
                         r"which is 0 in a \.png: write an \.exr")

    def test_ranges_below_the_smallest_tolerance(self):
        # 1e-9 of opacity cannot be told from nothing at 1e-7.
        result = self.run_program(*self.faint(1e-9), "-o", "a.exr", "--tolerance", "1%")
        self.assertEqual(result.returncode, 3, result.stderr)
        self.assertRegex(result.stderr.decode(), r"more than 1 % of the largest channel, "
                         r"[^\n]*; the smallest tolerance is 1e-07")
        self.fail_with("smallest tolerance", *self.faint(1e-9), "-o", "b.exr", "--tolerance", "1%",
                       "--strict", "--quiet", code=3)

    def test_relative_tolerances_that_are_none(self):
        for wrong in ("0%", "-1%", "101%", "%", "x%", "1/2%"):
            self.fail_with(r"--tolerance[^\n]*1%", *FIELD, "-o", "a.png", f"--tolerance={wrong}",
                           code=2)
        self.fail_with("--tolerance", *FIELD, "-o", "a.png", "--tolerance", "1%", "--method",
                       "midpoint", code=2)

    def test_relative_tolerance_of_a_scene(self):
        faint = {"points": [{"value": 0, "extinction": 1e-3, "color": [1, 0, 0]},
                            {"value": 1, "extinction": 2e-3, "color": [0, 0, 1]}]}
        scene = json.loads(self.scene(relative_tolerance=0.02))
        scene["volumes"][0]["transfer_function"] = faint
        self.write("scene.json", json.dumps(scene))
        report = self.report("render", "scene.json", "-o", "a.exr", "--save-scene", "used.json")
        self.assertEqual(report["relative_tolerance"], 0.02)
        self.assertLessEqual(report["tolerance"], 0.02 * report["largest_channel"])
        # The saved scene has the tolerance that was used, and gives the same picture.
        used = json.loads(self.read("used.json"))["integration"]
        self.assertEqual(used["tolerance"], report["tolerance"])
        self.assertNotIn("relative_tolerance", used)
        self.succeed("render", "used.json", "-o", "b.exr")
        self.assertTrue(self.report("compare", "a.exr", "b.exr")["identical"])
        # Not rendered, it stays relative.
        self.succeed("render", "scene.json", "--save-scene", "kept.json")
        self.assertEqual(json.loads(self.read("kept.json"))["integration"]["relative_tolerance"],
                         0.02)
        # A number on the command line stands in its place.
        report = self.report("render", "scene.json", "-o", "a.exr", "--tolerance", "1e-3")
        self.assertEqual((report["tolerance"], report["relative_tolerance"]), (1e-3, None))
        for wrong in (0, -1, 1.5, "1%"):
            self.write("wrong.json", self.scene(relative_tolerance=wrong))
            self.fail_with("/integration/relative_tolerance", "render", "wrong.json", "-o", "c.exr")
        self.write("wrong.json", self.scene(relative_tolerance=0.1, tolerance=0.1))
        self.fail_with("beside", "render", "wrong.json", "-o", "c.exr")

    def test_opacity_tables_follow_a_relative_tolerance(self):
        self.write("table.json", json.dumps({"unit_distance": 1, "points": [
            {"value": 0, "opacity": 0, "color": [1, 0, 0]},
            {"value": 1, "opacity": 2e-3, "color": [0, 0, 1]}]}))
        table = ("render", "builtin:marschner_lobb:12", "--tf", "table.json", "--size", "16")
        report = self.report(*table, "-o", "a.exr", "--tolerance", "1%")
        self.assertLessEqual(report["transfer_function_error"], report["tolerance"] / 8)
        self.assertLessEqual(report["largest_error"], 0.01 * report["largest_channel"])

    def test_tolerances_that_are_none(self):
        for wrong in ("nan", "inf", "-inf", "0", "-0", "-1", "1/0", "0/1", "-1/-2", "1/2/3", "1/",
                      " ", "small", "1e400", "0.001mm", "1e-3 "):
            self.fail_with(r"--tolerance[^\n]*1/512", *FIELD, "-o", "a.png",
                           f"--tolerance={wrong}", code=2)
            self.fail_with("--tolerance", *FIELD, "--save-scene", "s.json", f"--tolerance={wrong}",
                           code=2)
        for nothing in (("--tolerance",), ("--tolerance", ""), ("--tolerance=",)):
            self.fail_with("--tolerance", *FIELD, "-o", "a.png", *nothing, code=2)

    def test_tolerances_beyond_the_limits_are_moved_to_them(self):
        for asked, used in (("1e-300", 1e-7), ("1e-8", 1e-7), ("2", 1), ("1e300", 1)):
            run = (*FIELD, "-o", "a.exr", "--tolerance", asked)
            result = self.run_program(*run, "--json")
            self.assertEqual(result.returncode, 0, result.stderr)
            report = json.loads(result.stdout)
            self.assertEqual((report["tolerance_asked"], report["tolerance"]), (float(asked), used))
            self.assertRegex(result.stderr.decode(),
                             rf"\Apellucid: tolerance [^\n]* is outside the limits: "
                             rf"using {used:g}\n\Z")
            self.assertEqual(self.run_program(*run, "--quiet").stderr, b"")
        for limit in ("1e-7", "1"):
            result = self.run_program(*FIELD, "-o", "a.exr", "--tolerance", limit, "--json")
            self.assertEqual(result.stderr, b"")

    def test_grades(self):
        for wrong in ("prooved", "Proved", "proven", "", "estimate", "1"):
            self.fail_with("--grade", *FIELD, "-o", "a.png", f"--grade={wrong}", code=2)

    def test_precisions(self):
        for name in ("automatic", "float", "double"):
            report = self.report(*FIELD, "-o", "a.png", "--precision", name)
            self.assertEqual(report["precision"], name)
        for wrong in ("single", "auto", "half", ""):
            self.fail_with("--precision", *FIELD, "-o", "a.png", f"--precision={wrong}", code=2)
        # A sampling method knows no tolerance to choose by.
        report = self.report(*FIELD, "-o", "a.png", "--method", "midpoint")
        self.assertEqual(report["precision"], "float")
        # Packets that sample know no depth: rays go one by one, in double.
        report = self.report(*FIELD, "-o", "a.exr", "--method", "midpoint")
        self.assertEqual(report["precision"], "double")
        self.succeed(*FIELD, "-o", "b.exr", "--method", "midpoint", "--precision", "float")
        self.assertEqual(self.read("a.exr"), self.read("b.exr"))

    def test_methods_without_an_error_refuse_to_be_asked_for_one(self):
        options = (("--tolerance", "1e-3"), ("--grade", "proved"), ("--error-map", "e.png"),
                   ("--strict",))
        self.write("midpoint.json", self.scene(method="midpoint", tolerance=0.25))
        for option in options:
            for method in ("midpoint", "linear", "simpson"):
                self.fail_with(rf"{option[0]}: [^\n]*{method}[^\n]*pellucid compare", *FIELD, "-o",
                               "a.exr", "--method", method, *option, code=2)
            self.fail_with(rf"{option[0]}: [^\n]*--reference[^\n]*pellucid compare", *FIELD, "-o",
                           "a.exr", "--reference", *option, code=2)
            # The method of a scene counts as well, and can be replaced.
            self.fail_with(rf"{option[0]}: [^\n]*midpoint[^\n]*--method exact", "render",
                           "midpoint.json", "-o", "a.exr", *option, code=2)
            self.succeed("render", "midpoint.json", "-o", "a.exr", "--method", "exact", *option)
        # What a scene says of its tolerance is no argument.
        self.succeed("render", "midpoint.json", "-o", "a.exr")
        self.succeed("render", "midpoint.json", "-o", "a.exr", "--reference")

    def test_exit_code_where_pixels_are_over(self):
        result = self.run_program(*OVER, "-o", "a.exr", "-o", "a.png", "--json")
        self.assertEqual(result.returncode, 3)
        report = json.loads(result.stdout)
        over = report["pixels_over"]
        self.assertGreater(over, 0)
        self.assertGreater(report["largest_error"], 1e-7)
        self.assertEqual(report["outputs"], ["a.exr", "a.png"])
        self.assertRegex(result.stderr.decode(),
                         rf"\Apellucid: error: {over} of 256 pixels [^\n]*1e-07"
                                                 r"[^\n]*--precision automatic[^\n]*\n\Z")
        self.assertEqual(png(self.read("a.png"))[0], 16)
        self.assertEqual(int(exr_texts(self.read("a.exr"))["pellucid.pixels_over"]), over)
        result = self.run_program(*OVER, "-o", "b.exr", "--quiet")
        self.assertEqual(result.returncode, 3)
        self.assertRegex(result.stderr.decode(), r"\Apellucid: error: [^\n]*\n\Z")
        self.assertEqual(self.read("a.exr"), self.read("b.exr"))
        # Without --quiet the report comes before it.
        result = self.run_program(*OVER, "-o", "b.exr")
        self.assertRegex(result.stderr.decode(),
                         r"\A(pellucid: [^\n]+\n){1}pellucid: error: [^\n]*\n\Z")
        # What it advises helps.
        self.succeed(*FIELD, "-o", "b.exr", "--tolerance", "1e-7", "--precision", "automatic")

    def test_strict_writes_nothing_where_pixels_are_over(self):
        self.fail_with(r"of 256 pixels[^\n]*--strict", *OVER, "--strict", "-o", "a.exr",
                       "-o", "a.png",
                       "--error-map", "e.png", "--depth", "d.png", "--save-tf", "saved.json",
                       "--save-scene", "s.json", "--json", code=3)
        self.fail_with("--strict", *OVER, "--strict", "-o", "a.exr", "--print-tf", code=3)
        self.write("a.exr", "old")
        self.fail_with("--strict", *OVER, "--strict", "-o", "a.exr", code=3)
        # Where none is over it changes nothing.
        self.succeed(*FIELD, "--strict", "-o", "a.exr", "--error-map", "e.png")
        self.succeed(*FIELD, "-o", "b.exr")
        self.assertEqual(self.read("a.exr"), self.read("b.exr"))
        for arguments in (("--save-tf", "x.json"), ("--print-tf",), ("--save-scene", "x.json")):
            self.fail_with("--strict", *FIELD, *arguments, "--strict", code=2)

    def test_error_map_as_a_picture(self):
        report = self.report(*FIELD, "--error-map", "e.png", "--tolerance", "1e-3")
        self.assertEqual(report["outputs"], ["e.png"])
        picture = png(self.read("e.png"))
        self.assertEqual(picture[:3], (16, 16, 3))
        texts = png_texts(self.read("e.png"))
        self.assertRegex(texts["pellucid.error_map"], r"0 \(dark\) to 0\.001 \(bright\)")
        self.assertEqual(texts["pellucid.tolerance"], "0.001")
        pixels = [pixel(picture, c, r) for r in range(16) for c in range(16)]
        proved = sum(1 for p in pixels if len(set(p)) > 1)
        self.assertEqual(proved, report["pixels_proved"])
        self.assertNotIn((255, 0, 0), pixels)
        # Empty pixels have no error: the dark end of viridis.
        self.assertEqual(pixel(picture, 0, 0), (68, 1, 84))

        result = self.run_program(*OVER, "--error-map", "o.png", "--json")
        self.assertEqual(result.returncode, 3)
        picture = png(self.read("o.png"))
        red = sum(1 for r in range(16) for c in range(16) if pixel(picture, c, r) == (255, 0, 0))
        self.assertEqual(red, json.loads(result.stdout)["pixels_over"])

    def test_error_map_as_numbers(self):
        self.succeed(*FIELD, "-o", "a.exr", "--error-map", "e.exr", "--tolerance", "1/1000")
        self.assertEqual(exr_channels(self.read("e.exr")), {"Y": 2, "error": 2, "error.proved": 1})
        texts = exr_texts(self.read("e.exr"))
        self.assertIn("error / 0.001", texts["pellucid.error_map"])
        self.assertEqual(texts["pellucid.grade"], "estimated")

    def test_error_map_arguments(self):
        for wrong in ("e.gif", "e", "png", ".png.txt"):
            self.fail_with(r"--error-map [^\n]*\.png or \.exr", *FIELD, "--error-map", wrong,
                           code=2)
        self.fail_with("missing", *FIELD, "--error-map", "missing/e.png")
        self.fail_with("twice", *FIELD, "-o", "a.png", "--error-map", "a.png", code=2)
        self.write("tf.png", "x")
        self.fail_with("overwrite", "render", "builtin:shells:8", "--tf", "tf.png", "--error-map",
                       "tf.png", code=2)

    def test_samples(self):
        self.write("ramp.npy", npy(ramp(4), (4, 4, 4)))
        run = ("render", "ramp.npy", "--tf", "tf.json", "--view", "left")
        # 2 x 2 samples of 5 x 4 pixels are the pixels of 10 x 8.
        report = self.report(*run, "--size", "5x4", "--samples", "2", "-o", "coarse.exr", "--json")
        self.assertEqual((report["samples"], report["pixels"], report["rays"]), (2, 20, 80))
        for arguments in (("--reference",), ("--method", "linear"), ()):
            self.succeed(*run, "--size", "5x4", "--samples", "3", "-o", "a.exr", *arguments)
            self.succeed(*run, "--size", "5x4", "--samples", "3", "-o", "b.exr", "--reference")
            tolerance = "1e-6" if "--reference" in arguments else "0.01"
            self.succeed("compare", "a.exr", "b.exr", "--tolerance", tolerance)
        error = self.report("compare", "a.exr", "b.exr")["error"]
        self.assertEqual((error["over"], error["unknown"]), (0, 0))
        # Samples change what is seen where things end.
        self.succeed(*run, "--size", "5x4", "-o", "one.exr", "--reference")
        self.assertGreater(self.report("compare", "one.exr", "b.exr")["largest"], 0.01)
        for wrong in ("0", "-1", "65", "1.5", "two", "1e9", "nan", "", "99999999999999999999"):
            self.fail_with("--samples", *run, "-o", "x.exr", f"--samples={wrong}", code=2)
            self.fail_with("--samples", *run, "-o", "x.exr", "--reference", f"--samples={wrong}",
                           code=2)

    def test_saved_scene_keeps_what_was_asked(self):
        arguments = ("--tolerance", "1/3000", "--grade", "proved", "--samples", "2", "--precision",
                     "double")
        self.succeed(*FIELD, *arguments, "-o", "a.exr", "--save-scene", "s.json")
        saved = json.loads(self.read("s.json"))
        self.assertEqual(saved["integration"]["tolerance"], 1 / 3000)
        self.assertEqual(saved["integration"]["grade"], "proved")
        self.assertEqual(saved["integration"]["precision"], "double")
        self.assertEqual(saved["image"]["samples"], 2)
        report = self.report("render", "s.json", "-o", "b.exr")
        self.assertEqual((report["tolerance"], report["tolerance_asked"]), (1 / 3000, 1 / 3000))
        self.assertEqual((report["grade"], report["precision"], report["samples"]),
                         ("proved", "double", 2))
        self.assertEqual(self.report("compare", "a.exr", "b.exr")["largest"], 0)
        # Arguments stand above it.
        report = self.report("render", "s.json", "-o", "b.exr", "--tolerance", "0.01", "--grade",
                             "estimated", "--samples", "1", "--precision", "automatic")
        self.assertEqual((report["tolerance"], report["grade"], report["samples"],
                          report["precision"]), (0.01, "estimated", 1, "automatic"))

    def test_opacity_tables_are_part_of_the_error(self):
        table = {"type": "piecewise_linear", "unit_distance": 0.5, "points": [
            {"value": 0, "opacity": 0, "color": [1, 0, 0]},
            {"value": 1, "opacity": 0.875, "color": [0, 0, 1]}]}
        self.write("table.json", json.dumps(table))
        run = ("render", "builtin:marschner_lobb:12", "--tf", "table.json", "--size", "16")
        for tolerance in (1e-2, 1e-4):
            report = self.report(*run, "-o", "a.exr", "--tolerance", str(tolerance),
                                 "--save-tf", "saved.json", "--save-scene", "s.json")
            self.assertGreater(report["transfer_function_error"], 0)
            self.assertLessEqual(report["transfer_function_error"], tolerance / 8 * (1 + 1e-9))
            # As given, not as the points that stand for it.
            self.assertEqual(report["transfer_function"], table)
            self.assertEqual(json.loads(self.read("saved.json")), table)
            scene = json.loads(self.read("s.json"))
            self.assertEqual(scene["layers"][0]["transfer_function"], table)
            # The reference is more exact than the scene, and says how exact.
            made = self.report("render", "s.json", "-o", "truth.exr", "--reference")
            self.assertLess(made["transfer_function_error"], 1.3e-6)
            texts = exr_texts(self.read("truth.exr"))
            self.assertEqual(float(texts["pellucid.transfer_function_error"]),
                             made["transfer_function_error"])
            report = self.report("compare", "a.exr", "truth.exr", "--tolerance", str(tolerance))
            self.assertEqual(report["error"]["over"], 0)
            self.succeed(*run, "-o", "again.exr", "--reference")
            self.succeed("compare", "truth.exr", "again.exr", "--largest", "0")


if __name__ == "__main__":
    unittest.main()
