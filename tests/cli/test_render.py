# SPDX-License-Identifier: Apache-2.0
import json
import math
import os
import pty
import resource
import select
import signal
import subprocess
import time
import unittest

from program import (HAZE, PROGRAM, ProgramTest, exr_attributes, is_finite, npy, pixel, png, ramp)

# Looks along +x through the middle of a cube of side 3 at the origin.
CAMERA = {"projection": "orthographic", "position": [-5, 1.5, 1.5], "focal_point": [1.5, 1.5, 1.5],
          "up": [0, 0, 1], "parallel_scale": 1}
SAMPLING = ("rectangle", "taylor", "midpoint", "trapezoid", "simpson", "linear")


class Render(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("ramp.npy", npy(ramp(4), (4, 4, 4)))
        self.write("tf.json", json.dumps(HAZE))
        self.write("camera.json", json.dumps(CAMERA))
        self.small = ("--tf", "tf.json", "--camera", "camera.json", "--size", "4")

    def largest_difference(self, a, b):
        return self.report("compare", a, b)["largest"]

    def test_a_file_alone_gives_a_picture(self):
        result = self.run_program("render", "ramp.npy", "-o", "a.png")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(result.stdout, b"")
        self.assertRegex(result.stderr.decode(),
                         r"\Apellucid: look scan, for data with surfaces \(--look NAME takes "
                         r"another: ct, [^\n]*\)\npellucid: largest error [^\n]+ s\n\Z")
        width, height, channels, rows = png(self.read("a.png"))
        self.assertEqual((width, height, channels), (512, 512, 3))
        self.assertGreater(max(max(row) for row in rows), 60)
        self.assertEqual(self.files(), ["a.png", "camera.json", "ramp.npy", "tf.json"])

    def test_quiet(self):
        result = self.run_program("render", "ramp.npy", "-o", "a.png", "--size", "4", "--quiet")
        self.assertEqual((result.returncode, result.stdout, result.stderr), (0, b"", b""))

    def test_a_known_pixel(self):
        # Constant extinction 0.5 and color over a path of 3: opacity 1 - exp(-1.5).
        self.write("one.npy", npy([1.0] * 64, (4, 4, 4)))
        self.write("tf.json", json.dumps({"points": [
            {"value": 1, "extinction": 0.5, "color": [0.5, 0.25, 1]}]}))
        self.succeed("render", "one.npy", "-o", "a.exr", "-o", "a.png", *self.small,
                     "--background", "transparent")
        alpha = 1 - math.exp(-1.5)
        picture = png(self.read("a.png"))
        self.assertEqual(picture[:3], (4, 4, 4))
        # sRGB of 0.5, 0.25 and 1, straight.
        self.assertEqual(pixel(picture, 1, 2), (188, 137, 255, round(255 * alpha)))
        self.succeed("render", "one.npy", "-o", "b.png", *self.small, "--background", "white")
        picture = png(self.read("b.png"))
        self.assertEqual(picture[2], 3)
        over = [0.5 * alpha + 1 - alpha, 0.25 * alpha + 1 - alpha, 1.0]
        srgb = [round(255 * (1.055 * x ** (1 / 2.4) - 0.055)) for x in over]
        self.assertEqual(pixel(picture, 1, 2), tuple(srgb))
        # The reference agrees, and so does every sampling method, as nothing varies.
        self.succeed("render", "one.npy", "-o", "r.exr", *self.small, "--reference")
        self.assertLess(self.largest_difference("a.exr", "r.exr"), 1e-6)

    def test_json_report(self):
        report = self.report("render", "ramp.npy", "-o", "a.png", "-o", "a.exr", *self.small,
                             "--threads", "2")
        self.assertEqual(report["input"], "ramp.npy")
        self.assertEqual(report["dimensions"], [4, 4, 4])
        self.assertEqual(report["type"], "f32")
        self.assertEqual(report["nan"], 0)
        self.assertEqual(report["size"], [4, 4])
        self.assertEqual(report["method"], "exact")
        self.assertIsNone(report["step"])
        self.assertEqual(report["precision"], "automatic")
        self.assertEqual(report["samples"], 1)
        self.assertEqual(report["threads"], 2)
        self.assertEqual(report["rays"], 16)
        self.assertGreater(report["cells"], 0)
        self.assertTrue(is_finite(report["seconds"]))
        self.assertEqual(report["transfer_function_from"], "tf.json")
        self.assertEqual(report["transfer_function"]["points"], HAZE["points"])
        self.assertEqual(report["camera"]["parallel_scale"], 1)
        self.assertEqual(report["outputs"], ["a.png", "a.exr"])

    def test_metadata(self):
        self.succeed("render", "ramp.npy", "-o", "a.exr", *self.small, "--method", "midpoint",
                     "--step", "0.25", "--precision", "double")
        attributes = exr_attributes(self.read("a.exr"))
        text = {name: value.decode() for name, (kind, value) in attributes.items()
                if kind == "string" and name.startswith("pellucid.")}
        self.assertEqual(text["pellucid.method"], "midpoint")
        self.assertEqual(text["pellucid.step"], "0.25")
        self.assertEqual(text["pellucid.precision"], "double")
        self.assertEqual(text["pellucid.source"], "ramp.npy")
        self.assertEqual(self.succeed("--version").split()[1], text["pellucid.version"])
        self.assertEqual(json.loads(text["pellucid.transfer_function"])["points"], HAZE["points"])
        self.assertEqual(json.loads(text["pellucid.camera"])["position"], CAMERA["position"])
        channels = attributes["channels"][1]
        for name in b"ABGRZ":
            self.assertIn(bytes([name]) + b"\0", channels)

    def test_the_same_bytes_for_any_number_of_threads(self):
        # More tiles than threads, and another run.
        for name, threads in (("1.exr", "1"), ("2.exr", "2"), ("7.exr", "7"), ("again.exr", "2")):
            self.succeed("render", "builtin:marschner_lobb:24", "-o", name, "--size", "97x61",
                         "--threads", threads)
        for name in ("2.exr", "7.exr", "again.exr"):
            self.assertEqual(self.read("1.exr"), self.read(name), name)

    def test_methods_approach_the_exact_one(self):
        arguments = ("render", "builtin:marschner_lobb:12", "--tf", "tf.json", "--size", "12",
                     "--precision", "double")
        self.succeed(*arguments, "-o", "exact.exr", "--tolerance", "1e-6")
        for method in SAMPLING:
            self.succeed(*arguments, "-o", "coarse.exr", "--method", method, "--step", "1")
            self.succeed(*arguments, "-o", "fine.exr", "--method", method, "--step", "0.05")
            coarse = self.largest_difference("exact.exr", "coarse.exr")
            fine = self.largest_difference("exact.exr", "fine.exr")
            self.assertLess(fine, 0.03, method)
            self.assertLess(fine, 0.2 * coarse, method)

    def test_exact_agrees_with_the_reference(self):
        arguments = ("render", "builtin:marschner_lobb:10", "--tf", "tf.json", "--size", "9x7")
        self.succeed(*arguments, "-o", "float.exr", "--precision", "float", "--tolerance", "1e-4")
        self.succeed(*arguments, "-o", "double.exr", "--precision", "double", "--tolerance", "1e-6")
        report = self.report(*arguments, "-o", "reference.exr", "--reference")
        self.assertEqual(report["method"], "reference")
        self.assertEqual(report["precision"], "double")
        self.succeed("compare", "float.exr", "reference.exr", "--largest", "1e-4")
        self.succeed("compare", "double.exr", "reference.exr", "--largest", "1e-6")
        self.assertGreater(self.largest_difference("float.exr", "double.exr"), 0)

    def test_scaled_data_give_the_same_picture(self):
        n = 12
        values = [math.exp(-((i - 5) ** 2 + (j - 6) ** 2 + (k - 4.5) ** 2) / 12)
                  + 0.01 * math.sin(7 * i + 3 * j + k)
                  for k in range(n) for j in range(n) for i in range(n)]
        def render(scale, offset, name, *arguments):
            self.write("a.npy", npy([scale * v + offset for v in values], (n, n, n), "<f8"))
            return self.report("render", "a.npy", "-o", name, "--size", "32", *arguments)
        for preset in ((), ("--preset", "simulation-diverging"), ("--preset", "x-ray")):
            render(1, 0, "plain.exr", *preset)
            for scale, offset in ((1e30, 0), (1e34, 0), (2e37, 0), (1e-30, 0), (1e-34, 0), (1, 1e6),
                                  (100, -1e6)):
                with self.subTest(preset=preset, scale=scale, offset=offset):
                    report = render(scale, offset, "scaled.exr", "--save-scene", "scene.json",
                                    *preset)
                    self.assertEqual(report["pixels_over"], 0)
                    # Values of the transfer function are rounded to a thousandth of the range. A
                    # file alone is in light, with a steeper function.
                    self.report("compare", "plain.exr", "scaled.exr", "--tolerance",
                                "0.02" if preset else "0.08")
                    self.succeed("render", "scene.json", "-o", "again.exr", "--size", "32")
                    self.assertTrue(
                        self.report("compare", "scaled.exr", "again.exr")["identical"])

    def test_scaled_lengths_give_the_same_picture(self):
        field = ("render", "ramp.npy", "--size", "16")
        self.report(*field, "-o", "plain.exr", "--spacing", "1,1,1")
        for spacing in ("1e-6", "1e6", "1e-12", "1e12"):
            self.report(*field, "-o", "scaled.exr", "--spacing", ",".join([spacing] * 3))
            # Extinctions are rounded to two digits.
            self.report("compare", "plain.exr", "scaled.exr", "--tolerance", "0.03")

    def test_backgrounds(self):
        # Nothing but the background: dark and brighter above, unless another is given.
        self.write("empty.json", json.dumps({"points": [
            {"value": 0, "extinction": 0, "color": [0, 0, 0]}]}))
        def column(*arguments):
            self.succeed("render", "ramp.npy", "-o", "a.png", "--tf", "empty.json", "--size", "9",
                         "--quiet", *arguments)
            picture = png(self.read("a.png"))
            return [pixel(picture, 4, row) for row in range(9)]
        calm = column()
        self.assertEqual(len(calm[0]), 3)
        self.assertEqual(calm, sorted(calm, reverse=True))
        self.assertLess(max(calm[0]), 80)
        self.assertNotEqual(calm[0], calm[8])
        self.assertEqual(set(column("--background", "transparent")), {(0, 0, 0, 0)})
        self.assertEqual(set(column("--background", "white")), {(255, 255, 255)})
        two = column("--background", "white:black")
        self.assertEqual(two, sorted(two, reverse=True))
        self.assertGreater(two[0][0], 230)
        self.assertLess(two[8][0], 25)
        self.fail_with("--background", "render", "ramp.npy", "-o", "a.png", "--background",
                       "white:", code=2)

    def frame(self, name):
        """The share of the picture's larger side that is seen, and its mean brightness."""
        _, _, _, rows = png(self.read(name))
        seen = [[max(row[3 * x:3 * x + 3]) > 8 for x in range(len(row) // 3)] for row in rows]
        width, height = len(seen[0]), len(seen)
        columns = [x for x in range(width) if any(row[x] for row in seen)]
        lines = [y for y in range(height) if any(seen[y])]
        bright = [sum(rows[y][3 * x:3 * x + 3]) / 3 for y in lines for x in columns if seen[y][x]]
        return (max((columns[-1] - columns[0] + 1) / width, (lines[-1] - lines[0] + 1) / height),
                sum(bright) / len(bright))

    def test_brightness_and_size_do_not_depend_on_resolution(self):
        self.write("soft.json", json.dumps({"points": [
            {"value": 0.3, "extinction": 0, "color": [1, 1, 1]},
            {"value": 0.6, "extinction": 20, "color": [1, 1, 1]}]}))
        for look in (("--iso", "0.5"), ("--tf", "soft.json", "--shading", "on")):
            brightness = []
            for points in (32, 64, 128, 256):
                self.succeed("render", f"builtin:sphere:{points}", *look, "-o", "s.png", "--size",
                             "200", "--background", "black", "--quiet")
                share, mean = self.frame("s.png")
                self.assertAlmostEqual(share, 0.88, delta=0.02, msg=f"{look} {points}")
                brightness.append(mean)
            self.assertLess(max(brightness) - min(brightness), 2, f"{look} {brightness}")

    def test_looks(self):
        def scene(*arguments):
            self.succeed("render", *arguments, "--save-scene", "s.json", "--quiet")
            return json.loads(self.read("s.json"))
        layer = scene("ramp.npy", "--look", "scan")["layers"][0]
        self.assertIn("shading", layer)
        self.assertNotIn("isosurfaces", layer)
        ball = "builtin:sphere:24"
        saved = scene(ball)
        self.assertGreaterEqual(len(saved["layers"][0]["isosurfaces"]), 2)
        self.assertEqual([light["type"] for light in saved["lights"]], ["head", "directional"])
        self.assertNotIn("lights", scene(ball, "--look", "haze"))
        # What was saved gives the same picture.
        saved = scene(ball, "--camera", "camera.json")
        self.succeed("render", ball, "-o", "a.exr", "--size", "32", "--camera", "camera.json")
        self.write("s.json", json.dumps(saved))
        self.succeed("render", "s.json", "-o", "b.exr", "--size", "32")
        self.assertTrue(self.report("compare", "a.exr", "b.exr")["identical"])
        # Light that is given is taken.
        self.assertNotIn("shading", scene(ball, "--shading", "off")["layers"][0])
        lights = scene(ball, "--light", "head:0,0.5,1")["lights"]
        self.assertEqual([light["type"] for light in lights], ["head"])
        # Colors, range and opacity change surfaces and functions alike.
        plain = scene(ball)["layers"][0]["isosurfaces"]
        changed = scene(ball, "--colormap", "grey", "--opacity", "2")["layers"][0]["isosurfaces"]
        self.assertEqual([s["value"] for s in plain], [s["value"] for s in changed])
        self.assertEqual([changed[0]["color"], changed[-1]["color"]], [[0, 0, 0], [1, 1, 1]])
        self.assertGreater(changed[0]["opacity"], plain[0]["opacity"])
        # Labels become labels.
        blocks = [7 * (i // 4) + 20 * (j // 4) + 60 * (k // 4)
                  for k in range(12) for j in range(12) for i in range(12)]
        self.write("labels.npy", npy(blocks, (12, 12, 12), "<i2"))
        layer = scene("labels.npy")["layers"][0]
        self.assertIn("labels", layer)
        # A look with a function is saved; one without gives way to one that has it.
        self.succeed("render", ball, "--save-tf", "f.json", "-o", "a.png", "--size", "9")
        self.assertGreater(len(json.loads(self.read("f.json"))["points"]), 2)
        self.fail_with("has surfaces and no function", "render", ball, "--look", "simulation",
                       "--save-tf", "f.json", code=2)
        self.fail_with("--look bones: unknown; there are ct,", "render", "ramp.npy", "--look",
                       "bones", "-o", "a.png", code=2)
        self.assertIn("shading", scene("ramp.npy", "--look", "SCAN")["layers"][0])
        self.fail_with("--iso shows surfaces alone", "render", "ramp.npy", "--iso", "0.5",
                       "--opacity", "0.5", "-o", "a.png", code=2)
        for arguments in (("--tf", "tf.json"), ("--preset", "x-ray"), ("--iso", "0.5")):
            self.fail_with("--look", "render", "ramp.npy", "--look", "scan", "-o", "a.png",
                           *arguments, code=2)

    def test_advice(self):
        self.write("far.json", json.dumps({"points": [
            {"value": 5, "extinction": 0, "color": [1, 1, 1]},
            {"value": 6, "extinction": 1, "color": [1, 1, 1]}]}))
        self.write("bright.json", json.dumps({"points": [
            {"value": 0, "extinction": 50, "color": [1, 1, 1]}]}))
        run = ("render", "ramp.npy", "-o", "a.png", "--size", "16")
        text = self.run_program(*run, "--preset", "ct-bone").stderr.decode()
        self.assertRegex(text, r"\Apellucid: error: preset ct-bone [^\n]*range[^\n]*: the data are "
                               r"0 to 1, but it is for Hounsfield units[^\n]*\n\Z")
        text = self.run_program(*run, "--tf", "bright.json", "--shading", "1,1,1").stderr.decode()
        self.assertIn("brighter than white", text)

    def test_step_needs_a_sampling_method(self):
        run = ("render", "ramp.npy", "-o", "a.png")
        self.fail_with("exact method has no step", *run, "--step", "1", code=2)
        self.fail_with("exact method has no step", *run, "--step", "1", "--method", "exact", code=2)
        for step in ("0", "-1", "nan", "inf", "0.9999e-4", "1.0001e6"):
            self.fail_with("from 0.0001 to 1000000", *run, "--step", step, "--method", "midpoint",
                           code=2)
            self.fail_with("--step", "render", "ramp.npy", "--save-scene", "s.json", "--step", step,
                           "--method", "midpoint", code=2)
        for step in ("1e-4", "1e6"):
            self.succeed(*run, "--step", step, "--method", "midpoint", "--size", "2")
        for option in (("--method", "exact"), ("--step", "1"), ("--precision", "float"),
                       ("--precision", "automatic")):
            self.fail_with("--reference", *run, "--reference", *option, code=2)

    def test_bad_arguments(self):
        run = ("render", "ramp.npy")
        self.fail_with("nothing to write", *run, code=2)
        self.fail_with("nothing to write", *run, "--quiet", code=2)
        self.fail_with(r"\.png or \.exr", *run, "-o", "a.gif", code=2)
        self.fail_with("twice", *run, "-o", "a.png", "-o", "a.png", code=2)
        self.fail_with("--size", *run, "-o", "a.png", "--size", "0x4", code=2)
        self.fail_with("--size", *run, "-o", "a.png", "--size", "big", code=2)
        self.fail_with("--threads", *run, "-o", "a.png", "--threads", "-1", code=2)
        self.fail_with("--threads", *run, "-o", "a.png", "--threads", "two", code=2)
        self.fail_with("--background", *run, "-o", "a.png", "--background", "pink", code=2)
        self.fail_with("--method", *run, "-o", "a.png", "--method", "magic", code=2)
        self.fail_with("--view", *run, "-o", "a.png", "--view", "inside", code=2)
        self.fail_with("--camera", *run, "-o", "a.png", "--view", "left", "--camera", "camera.json",
                       code=2)
        self.fail_with("--json", *run, "--print-tf", "--json", code=2)
        self.fail_with("--json", *run, "--save-tf", "x.json", "--json", code=2)
        self.fail_with("--depth", *run, "-o", "a.png", "--depth", "b.exr", code=2)

    def test_transfer_function_is_printed_saved_and_taken_back(self):
        printed = json.loads(self.succeed("render", "ramp.npy", "--print-tf"))
        self.assertGreater(len(printed["transfer_function"]["points"]), 1)
        self.succeed("render", "ramp.npy", "--save-tf", "saved.json")
        self.assertEqual(json.loads(self.read("saved.json")), printed)
        self.succeed("render", "ramp.npy", "-o", "a.exr", "--size", "16", "--quiet", "--light",
                     "head")
        self.succeed("render", "ramp.npy", "-o", "b.exr", "--size", "16", "--tf", "saved.json",
                     "--light", "head")
        self.assertEqual(self.read("a.exr"), self.read("b.exr"))
        both = self.run_program("render", "ramp.npy", "--print-tf", "-o", "c.png", "--size", "4",
                                "--quiet")
        self.assertEqual(json.loads(both.stdout), printed)
        self.assertEqual(both.stderr, b"")
        self.assertIn("c.png", self.files())

    def test_scene(self):
        scene = {"volumes": [{"field": {"file": "ramp.npy"}, "transfer_function": HAZE}],
                 "camera": CAMERA, "image": {"width": 4, "height": 4},
                 "integration": {"method": "simpson", "precision": "double", "step": 0.5}}
        self.write("scene.json", json.dumps(scene))
        report = self.report("render", "scene.json", "-o", "a.exr")
        self.assertEqual(report["size"], [4, 4])
        self.assertEqual(report["method"], "simpson")
        self.assertEqual(report["step"], 0.5)
        self.assertEqual(report["precision"], "double")
        self.assertEqual(report["transfer_function_from"], "scene.json")
        # Arguments stand above the scene; the picture is that of the same arguments without one.
        report = self.report("render", "scene.json", "-o", "b.exr", "--method", "exact",
                             "--precision", "automatic")
        self.assertEqual(report["method"], "exact")
        self.succeed("render", "ramp.npy", "-o", "c.exr", *self.small)
        self.assertEqual(self.largest_difference("b.exr", "c.exr"), 0)
        self.assertEqual(self.report("render", "scene.json", "-o", "a.exr",
                                     "--step", "0.25")["step"],
                         0.25)

    def test_saved_scene_renders_the_same_from_another_folder(self):
        os.mkdir(self.path("scenes"))
        self.succeed("render", "ramp.npy", "-o", "a.exr", "--size", "12x10", "--view", "left",
                     "--spacing", "1,1,2", "--save-scene", os.path.join("scenes", "s.json"))
        saved = json.loads(self.read(os.path.join("scenes", "s.json")))
        self.assertEqual(saved["layers"][0]["field"]["file"], os.path.join("..", "ramp.npy"))
        self.succeed("render", os.path.join("scenes", "s.json"), "-o", "b.exr")
        self.assertEqual(self.largest_difference("a.exr", "b.exr"), 0)
        self.succeed("render", "builtin:shells:8", "--save-scene", "t.json")
        self.assertEqual(json.loads(self.read("t.json"))["layers"][0]["field"],
                         {"builtin": "shells", "points": 8})

    def test_views_show_their_side(self):
        # Opaque where x is large (the patient's left): seen from the left it is in front.
        self.write("tf.json", json.dumps({"points": [
            {"value": 0, "extinction": 20, "color": [1, 0, 0]},
            {"value": 1, "extinction": 20, "color": [0, 0, 1]}]}))
        colors = {}
        for view in ("left", "right", "front", "back", "top", "bottom", "oblique"):
            name = view + ".png"
            self.succeed("render", "ramp.npy", "-o", name, "--tf", "tf.json", "--view", view,
                         "--size", "9", "--background", "black")
            colors[view] = pixel(png(self.read(name)), 4, 4)
        self.assertGreater(colors["left"][2], colors["left"][0])
        self.assertGreater(colors["right"][0], colors["right"][2])
        front = png(self.read("front.png"))
        self.assertGreater(pixel(front, 7, 4)[2], pixel(front, 1, 4)[2])
        back = png(self.read("back.png"))
        self.assertLess(pixel(back, 7, 4)[2], pixel(back, 1, 4)[2])

    def test_nan_is_vacuum_and_counted(self):
        values = [1.0] * 64
        for i in (21, 22, 25):
            values[i] = float("nan")
        self.write("nan.npy", npy(values, (4, 4, 4)))
        result = self.run_program("render", "nan.npy", "-o", "a.exr", "--json", *self.small)
        self.assertEqual(result.returncode, 0)
        self.assertEqual(result.stderr.decode(), "pellucid: 3 values are NaN: rendered as vacuum\n")
        self.assertEqual(json.loads(result.stdout)["nan"], 3)
        self.write("zero.exr", self.read("a.exr"))
        self.assertEqual(self.report("compare", "a.exr", "zero.exr")["not_finite"], 0)
        self.write("all.npy", npy([float("nan")] * 64, (4, 4, 4)))
        self.succeed("render", "all.npy", "-o", "b.png", "--size", "4", "--quiet",
                     "--background", "transparent")
        self.assertEqual(pixel(png(self.read("b.png")), 2, 2), (0, 0, 0, 0))

    def test_depth_picture(self):
        self.succeed("render", "builtin:sphere:16", "--depth", "d.png", "--view", "front",
                     "--size", "33", "--quiet")
        picture = png(self.read("d.png"))
        self.assertEqual(picture[2], 4)
        self.assertEqual(pixel(picture, 0, 0)[3], 0)
        values = [pixel(picture, c, r) for r in range(33) for c in range(33)]
        opaque = [v for v in values if v[3] == 255]
        self.assertGreater(len(opaque), 50)
        self.assertEqual(max(v[0] for v in opaque), 255)
        self.assertEqual(min(v[0] for v in opaque), 0)

    def test_existing_outputs_are_replaced(self):
        self.write("a.png", "old")
        self.succeed("render", "ramp.npy", "-o", "a.png", *self.small)
        self.assertEqual(png(self.read("a.png"))[0], 4)

    def test_not_enough_memory(self):
        def limit():
            resource.setrlimit(resource.RLIMIT_AS, (2 << 30, 2 << 30))
        probe = subprocess.run([PROGRAM, "--version"], capture_output=True, preexec_fn=limit,
                               check=False)
        if probe.returncode != 0:
            self.skipTest("a sanitizer needs more address space than this test allows")
        result = subprocess.run([PROGRAM, "render", "ramp.npy", "-o", "a.exr", "--size",
                                 "65536x65536"], cwd=self.folder, capture_output=True,
                                preexec_fn=limit, check=False)
        self.assertEqual(result.returncode, 1)
        self.assertRegex(result.stderr.decode(), r"\Apellucid: error: [^\n]*memory[^\n]*\n\Z")
        self.assertNotIn("a.exr", self.files())


class Terminal(ProgramTest):
    """Progress and interruption, with a pseudo-terminal as stderr."""

    def start(self, *arguments):
        master, slave = pty.openpty()
        self.addCleanup(os.close, master)
        process = subprocess.Popen([PROGRAM, *arguments], cwd=self.folder, stdout=subprocess.PIPE,
                                   stderr=slave)
        self.addCleanup(process.stdout.close)
        os.close(slave)
        return process, master

    def read_until(self, master, text, seconds=60):
        seen, end = b"", time.monotonic() + seconds
        while time.monotonic() < end and text not in seen:
            if not select.select([master], [], [], 0.1)[0]:
                continue
            try:
                chunk = os.read(master, 4096)
            except OSError:  # the other end is closed
                break
            if not chunk:
                break
            seen += chunk
        return seen

    def test_progress_is_one_line_that_is_removed(self):
        process, master = self.start("render", "builtin:shells:8", "-o", "a.png", "--size", "64")
        seen = self.read_until(master, b"\n").decode()
        self.assertEqual(process.wait(60), 0)
        self.assertRegex(seen, r"\rrendering [ 0-9]{3} %")
        self.assertIn("\r\x1b[K", seen)
        self.assertNotIn("\n", seen[:seen.rindex("\r\x1b[K")])

    def test_interruption_leaves_nothing(self):
        for number, code in ((signal.SIGINT, 130), (signal.SIGTERM, 143)):
            process, master = self.start("render", "builtin:marschner_lobb:64", "-o", "a.exr", "-o",
                                         "a.png", "--save-tf", "tf.json", "--size", "2048",
                                         "--threads", "1")
            self.assertIn(b"rendering", self.read_until(master, b"rendering"))
            process.send_signal(number)
            message = self.read_until(master, b"\n").decode()
            self.assertEqual(process.wait(60), code)
            self.assertRegex(message.split("\x1b[K")[-1],
                             r"\Apellucid: error: interrupted[^\n]*\n\Z")
            self.assertEqual(self.files(), [])


if __name__ == "__main__":
    unittest.main()
