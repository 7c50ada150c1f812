# SPDX-License-Identifier: Apache-2.0
"""Projections of a layer, as pictures and as numbers: --projection and --values."""

import json
import math
import struct
import unittest

from program import HAZE, ProgramTest, exr_channels, npy, ramp

VIEW = ["--view", "left", "--size", "6x4"]


def values_of(data):
    """Shape and numbers of a .npy file of float32."""
    assert data[:8] == b"\x93NUMPY\x01\x00"
    length = struct.unpack("<H", data[8:10])[0]
    assert (10 + length) % 64 == 0
    header = data[10:10 + length].decode()
    assert header.endswith("\n")
    fields = eval(header)  # as NumPy does, of a file of our own
    assert fields["descr"] == "<f4" and fields["fortran_order"] is False
    count = fields["shape"][0] * fields["shape"][1]
    return fields["shape"], struct.unpack(f"<{count}f", data[10 + length:])


class Projections(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("a.npy", npy(ramp(5), (5, 5, 5)))

    def test_values_as_numbers(self):
        # Along x, from 0 to 1 on a length of 4.
        for kind, inside in (("maximum", 1), ("minimum", 0), ("mean", 0.5), ("sum", 2)):
            self.write("camera.json", json.dumps({
                "projection": "orthographic", "position": [-9, 1.9, 2.1],
                "focal_point": [0, 1.9, 2.1], "up": [0, 0, 1], "parallel_scale": 3.3}))
            self.succeed("render", "a.npy", "--projection", kind, "--camera", "camera.json",
                         "--size", "6x4", "--values", "v.npy", "-o", "o.exr", "-q")
            shape, values = values_of(self.read("v.npy"))
            self.assertEqual(shape, (4, 6))
            self.assertEqual(len(values), 24)
            data = [v for v in values if not math.isnan(v) and (kind != "sum" or v != 0)]
            self.assertGreater(len(data), 3)
            self.assertLess(len(data), 24)
            for value in data:
                self.assertAlmostEqual(value, inside, places=6)
            self.assertEqual(exr_channels(self.read("o.exr"))["value"], 2)

    def test_values_as_exr(self):
        self.succeed("render", "a.npy", "--projection", "mean", *VIEW, "--values", "v.exr")
        self.assertEqual(exr_channels(self.read("v.exr")), {"Y": 2})
        self.assertEqual(self.files(), ["a.npy", "v.exr"])

    def test_the_reference_has_the_same_values(self):
        for kind in ("maximum", "minimum", "mean", "sum"):
            arguments = ["render", "a.npy", "--projection", kind, "--size", "9", "-q"]
            self.succeed(*arguments, "--values", "v.npy")
            self.succeed(*arguments, "--values", "r.npy", "--reference")
            for a, b in zip(values_of(self.read("v.npy"))[1], values_of(self.read("r.npy"))[1]):
                if not math.isnan(b):
                    self.assertAlmostEqual(a, b, places=5)
                else:
                    self.assertTrue(math.isnan(a))

    def test_a_saved_scene_has_the_projection(self):
        self.succeed("render", "a.npy", "--projection", "maximum", "--size", "8", "-o", "a.exr",
                     "--save-scene", "s.json")
        layer = json.loads(self.read("s.json"))["layers"][0]
        self.assertEqual(layer["projection"], "maximum")
        points = layer["transfer_function"]["points"]
        self.assertEqual([(p["value"], p["extinction"]) for p in points], [(0, 1), (1, 1)])
        self.succeed("render", "s.json", "-o", "b.exr")
        report = json.loads(self.succeed("compare", "a.exr", "b.exr", "--json"))
        self.assertEqual(report["largest"], 0, report)

    def test_the_report_tells(self):
        report = self.report("render", "a.npy", "--projection", "sum", "--size", "8", "-o", "a.exr")
        self.assertEqual(report["layers"][0]["projection"], "sum")
        self.assertEqual(report["pixels_proved"], 64)
        self.assertLess(report["largest_error"], 1e-6)
        self.assertIsNone(
            self.report("render", "a.npy", "--size", "8", "-o", "a.exr")["layers"][0]["projection"])

    def test_over_another_layer(self):
        self.write("tf.json", json.dumps(HAZE))
        self.succeed("render", "a.npy", "--projection", "minimum", "--tf", "tf.json", "--layer",
                     "builtin:sphere:6", "--size", "8", "-o", "a.png", "--values", "v.npy")
        self.assertEqual(values_of(self.read("v.npy"))[0], (8, 8))

    def test_wrong_arguments(self):
        def refuse(pattern, *arguments, code=2):
            self.fail_with(pattern, "render", *arguments, "--size", "8", code=code)

        self.write("scene.json", json.dumps({"pellucid": 2, "layers": [
            {"field": {"builtin": "ramp", "points": 4}},
            {"field": {"builtin": "ramp", "points": 4}}]}))
        refuse("--projection", "a.npy", "--projection", "average", "-o", "o.png")
        refuse(r"--values v.png: expected a name that ends in .npy or .exr", "a.npy",
               "--projection", "maximum", "--values", "v.png")
        refuse("--projection: the scene has 2 layers", "scene.json", "--projection", "maximum",
               "-o", "o.png")
        refuse("--projection: is for INPUT", "--layer", "a.npy", "--projection", "maximum", "-o",
               "o.png")
        refuse("written twice", "a.npy", "--projection", "maximum", "--values", "v.exr", "-o",
               "v.exr")
        refuse("would overwrite the input", "a.npy", "--projection", "maximum", "--values", "a.npy")
        refuse("0 visible layers are projected", "a.npy", "--values", "v.npy", code=1)
        refuse("samples is 2", "a.npy", "--projection", "mean", "--values", "v.npy", "--samples",
               "2", code=1)
        refuse("is of one variable", "--channel", "t=a.npy", "--gaussian",
               "t=0.5~0.1; extinction 1; color #ffffff", "--projection", "sum", "-o", "o.exr",
               code=1)
        refuse("no_folder", "a.npy", "--projection", "maximum", "--values", "no_folder/v.npy",
               code=1)


if __name__ == "__main__":
    unittest.main()
