# SPDX-License-Identifier: Apache-2.0
import json
import math
import os
import unittest

from program import ProgramTest, npy, pixel, png

COOL_TO_WARM = [{"Name": "warm", "ColorSpace": "Diverging",
                 "RGBPoints": [0, 0.23, 0.3, 0.75, 1, 0.7, 0.02, 0.15],
                 "Points": [0, 0.2, 0.5, 0, 1, 0.6, 0.5, 0]},
                {"Name": "plain", "ColorSpace": "RGB", "RGBPoints": [0, 1, 0, 0, 1, 0, 0, 1],
                 "Points": [0, 0.5, 0.5, 0, 1, 0.5, 0.5, 0]}]


def constant(value, n=4):
    return npy([value] * n ** 3, (n, n, n))


class TransferFunctions(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("maps.json", json.dumps(COOL_TO_WARM))
        self.write("half.npy", constant(0.5))

    def test_render_takes_another_programs_function(self):
        # Opacity 1/2 per unit distance over three units, seen along an axis: 1 - 1/8 of (0.5, 0,
        # 0.5).
        result = self.run_program("render", "half.npy", "--tf", "maps.json", "--map", "plain",
                                  "--colors", "linear", "-o", "a.exr", "-o", "a.png", "--view",
                                  "front", "--size", "33", "--save-tf", "tf.json",
                                  "--background", "transparent")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn(b'maps.json: ParaView color map "plain"', result.stderr)
        self.assertIn(b"colors: exact", result.stderr)
        saved = json.loads(self.read("tf.json"))
        self.assertEqual(saved["unit_distance"], 1)
        self.assertNotIn("deviation", saved)
        alpha = pixel(png(self.read("a.png")), 16, 16)[3]
        self.assertAlmostEqual(alpha / 255, 7 / 8,
                               delta=0.02)  # 1/255, and the view is a perspective

    def test_deviations_count(self):
        report = self.report("render", "half.npy", "--tf", "maps.json", "-o", "a.png",
                             "--size", "16")
        self.assertEqual(report["transfer_function_from"], "maps.json")
        deviation = report["transfer_function"]["deviation"]
        self.assertGreater(deviation["color"], 0)
        self.assertLess(deviation["color"], report["tolerance"] / 15)
        self.assertGreaterEqual(report["transfer_function_error"], deviation["color"])
        self.assertGreaterEqual(report["largest_error"], deviation["color"])
        self.assertEqual(report["pixels_over"], 0)
        fine = self.report("render", "half.npy", "--tf", "maps.json", "-o", "a.png", "--size", "16",
                           "--tolerance", "1e-4")
        self.assertLess(fine["transfer_function"]["deviation"]["color"], 1e-4 / 8)

    def test_convert_there_and_back(self):
        result = self.run_program("transfer-function", "maps.json", "tf.json", "--range", "-10,30",
                                  "--unit-distance", "0.5", "--deviation", "1e-3")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn(b"the first of 2 maps is taken", result.stderr)
        self.assertIn(b"fitted by lines in linear light, within", result.stderr)
        ours = json.loads(self.read("tf.json"))
        self.assertEqual([ours["points"][0]["value"], ours["points"][-1]["value"]], [-10, 30])
        self.assertEqual(ours["unit_distance"], 0.5)
        for form in ("slicer", "paraview", "table"):
            self.succeed("transfer-function", "tf.json", "out", "--format", form, "-q")
            self.succeed("transfer-function", "out", "back.json", "--unit-distance", "0.5", "-q")
            back = json.loads(self.read("back.json"))
            self.assertAlmostEqual(back["points"][-1]["opacity"], 0.6, delta=1e-12)
            for mine, theirs in zip(ours["points"][-1]["color"], back["points"][-1]["color"]):
                self.assertAlmostEqual(mine, theirs, delta=1e-7)
        text = self.succeed("transfer-function", "tf.json", "--format", "table", "-q")
        self.assertTrue(text.startswith("value,r,g,b,a\n-10,"))

    def test_refuses_in_one_line(self):
        self.write("bad.json", '[{"RGBPoints": [0, 0, 0, 2]}]')
        self.write("own.json",
                   json.dumps({"points": [{"value": 0, "extinction": 1, "color": [1, 1, 1]}]}))
        for code, arguments in [(1, ["render", "half.npy", "--tf", "bad.json", "-o", "a.png"]),
                                (1, ["transfer-function", "bad.json", "out.json"]),
                                (2, ["transfer-function", "own.json", "out.json",
                                     "--range", "0,1"]),
                                (2, ["transfer-function", "maps.json", "maps.json"]),
                                (2, ["transfer-function", "maps.json", "out.json",
                                     "--deviation", "1"]),
                                (2, ["render", "half.npy", "--tf", "own.json", "--colors", "srgb",
                                     "-o", "a.png"]),
                                (2, ["render", "half.npy", "--preset", "ct-bones", "-o", "a.png"]),
                                (2, ["render", "half.npy", "--preset", "x-ray", "--map", "a",
                                     "-o", "a.png"]),
                                (2, ["render", "half.npy", "--preset", "x-ray", "--tf", "own.json",
                                     "-o", "a.png"])]:
            result = self.run_program(*arguments)
            self.assertEqual(result.returncode, code, (arguments, result.stderr))
            self.assertEqual(result.stderr.count(b"\n"), 1, result.stderr)
        self.assertFalse(os.path.exists(self.path("out.json"))
                         or os.path.exists(self.path("a.png")))

    def test_presets(self):
        names = [preset["name"] for preset in json.loads(self.succeed("presets", "--json"))]
        self.assertEqual(names, ["ct-bone", "ct-soft-tissue", "ct-angiography", "mr-t1-brain",
                                 "simulation-diverging", "simulation-isosurfaces", "x-ray"])
        listed = self.succeed("presets")
        for name in names:
            scale = (lambda x: 500 * x - 1000) if name.startswith("ct-") else float
            self.write("ramp.npy", npy([scale(x) for _ in range(64) for x in range(8)],
                                       (8, 8, 8)))
            self.assertIn(name, listed)
            report = self.report("render", "ramp.npy", "--preset", name, "-o", "a.png",
                                 "--size", "16", "--save-scene", "scene.json")
            self.assertEqual(report["transfer_function_from"], "--preset " + name)
            points = report["transfer_function"]["points"]
            self.assertGreater(max(p["extinction"] for p in points), 0)
            values = [p["value"] for p in points]
            self.assertEqual(values, sorted(values))
            if name.startswith("simulation") or name == "x-ray":
                self.assertEqual([values[0], values[-1]], [0, 7])
            # The scene that is saved has the numbers.
            saved = json.loads(self.read("scene.json"))["layers"][0]["transfer_function"]
            self.assertEqual(saved["points"], points)
            ranged = json.loads(self.succeed("render", "ramp.npy", "--preset", name,
                                             "--range", "2,5", "--print-tf"))
            # With its light, where it is made for it.
            is_lit = name.startswith(("ct-", "mr-"))
            self.assertEqual("shading" in ranged, is_lit)
            points = ranged["transfer_function" if is_lit else "points"]
            points = points["points"] if is_lit else points
            self.assertEqual([points[0]["value"], points[-1]["value"]], [2, 5])
            unlit = json.loads(self.succeed("render", "ramp.npy", "--preset", name, "--shading",
                                            "off", "--print-tf"))
            self.assertIn("points", unlit)

    def test_preset_in_a_scene(self):
        self.write("scene.json", json.dumps({"volumes": [
            {"field": {"builtin": "ramp", "points": 8},
             "transfer_function": {"preset": "x-ray", "range": [0, 2]}}]}))
        printed = json.loads(self.succeed("render", "scene.json", "--print-tf"))
        self.assertEqual([p["value"] for p in printed["points"]], [0, 2])
        # The mean chord of a cube of edge 2 is 4/3: an optical depth of 1.5 over it.
        self.assertAlmostEqual(printed["points"][1]["extinction"], 1.1,
                               delta=1e-12)  # of two digits


if __name__ == "__main__":
    unittest.main()
