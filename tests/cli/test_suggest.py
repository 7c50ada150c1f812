# SPDX-License-Identifier: Apache-2.0
import json
import os
import unittest

from program import ProgramTest, npy, pixel, png


def ball(n, inside=100.0, outside=0.0):
    """A ball with an edge that is three values wide."""
    values, middle = [], (n - 1) / 2
    for k in range(n):
        for j in range(n):
            for i in range(n):
                r = ((i - middle) ** 2 + (j - middle) ** 2 + (k - middle) ** 2) ** 0.5
                share = min(max((n / 3 + 1.5 - r) / 3, 0), 1)
                values.append(outside + (inside - outside) * share)
    return values


class Suggest(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("ball.npy", npy(ball(24), (24, 24, 24)))

    def test_scene_of_one_file_renders(self):
        note = self.run_program("suggest", "ball.npy", "-o", "scene.json")
        self.assertEqual(note.returncode, 0, note.stderr)
        self.assertEqual(note.stdout, b"")
        self.assertIn(b"'pellucid render scene.json -o picture.png' shows them", note.stderr)
        scene = json.loads(self.read("scene.json"))
        gaussians = scene["layers"][0]["transfer_function"]["gaussians"]
        self.assertEqual([g["channels"] for g in gaussians],
                         [["value", "gradient_magnitude"]] * len(gaussians))
        # The boundary and the inside. The gradient of the edge is 100 over three values.
        centers = sorted(g["center"] for g in gaussians)
        self.assertEqual(len(centers), 2)
        self.assertAlmostEqual(centers[0][0], 50, delta=5)
        self.assertAlmostEqual(centers[0][1], 100 / 3, delta=5)
        self.assertAlmostEqual(centers[1][0], 100, delta=2)
        self.assertEqual(centers[1][1], 0)
        self.succeed("render", "scene.json", "-o", "a.png", "--size", "64", "--background", "black",
                     "--view", "front")
        picture = png(self.read("a.png"))
        self.assertLess(max(pixel(picture, 2, 2)), 8)
        self.assertGreater(max(pixel(picture, 32, 32)), 60)

    def test_transfer_function_alone(self):
        self.succeed("suggest", "ball.npy", "-o", "scene.json", "--save-tf", "tf.json", "-q")
        self.succeed("render", "ball.npy", "--tf", "tf.json", "-o", "a.png", "--size", "32")
        self.succeed("render", "scene.json", "-o", "b.png", "--size", "32")
        self.assertEqual(png(self.read("a.png"))[3], png(self.read("b.png"))[3])

    def test_stdout_where_nothing_is_written(self):
        printed = self.succeed("suggest", "ball.npy")
        self.succeed("suggest", "ball.npy", "-o", "scene.json", "-q")
        self.assertEqual(printed.encode(), self.read("scene.json"))

    def test_several_files(self):
        self.write("other.npy", npy(ball(24, 20, 60), (24, 24, 24)))
        self.succeed("suggest", "ball.npy", "other.npy", "-o", "scene.json", "--primitives", "2")
        scene = json.loads(self.read("scene.json"))
        self.assertIn('"ball"', json.dumps(scene["layers"]))
        self.assertIn('"other"', json.dumps(scene["layers"]))
        gaussians = scene["layers"][0]["transfer_function"]["gaussians"]
        self.assertEqual(len(gaussians), 2)
        self.assertEqual(gaussians[0]["channels"], ["ball", "other"])
        self.succeed("render", "scene.json", "-o", "a.png", "--size", "32")

    def test_files_are_named_as_seen_from_the_scene(self):
        os.mkdir(self.path("scenes"))
        self.succeed("suggest", "ball.npy", "-o", "scenes/scene.json")
        self.assertIn(b'"../ball.npy"', self.read("scenes/scene.json"))
        self.succeed("render", "scenes/scene.json", "-o", "a.png", "--size", "16")

    def test_keeps_what_is_said_of_the_file(self):
        self.write("a.raw", b"".join(bytes([int(v)]) for v in ball(24)))
        self.succeed("suggest", "a.raw", "--dimensions", "24,24,24", "--type", "u8", "--spacing",
                     "1,1,2", "-o", "scene.json")
        self.succeed("render", "scene.json", "-o", "a.png", "--size", "16")

    def test_only_what_is_looked_at_is_in_the_scene(self):
        self.succeed("suggest", "--channel", "a=ball.npy", "--channel", "soft=smoothed:a:1",
                     "--channel", "edge=gradient_magnitude:soft", "--channel", "b=ball.npy",
                     "--axes", "soft,edge", "-o", "scene.json")
        text = self.read("scene.json").decode()
        for name in ('"a"', '"soft"', '"edge"'):
            self.assertIn(name, text)
        self.assertNotIn('"b"', text)
        self.succeed("render", "scene.json", "-o", "a.png", "--size", "16")

    def test_is_the_same_for_any_number_of_threads(self):
        self.assertEqual(self.succeed("suggest", "ball.npy", "--threads", "1"),
                         self.succeed("suggest", "ball.npy", "--threads", "3"))

    def test_data_of_every_kind(self):
        for name in ("constant", "hydrogen", "marschner_lobb", "shells", "ramp"):
            self.succeed("suggest", f"builtin:{name}:24", "-o", "scene.json")
            self.succeed("render", "scene.json", "-o", "a.png", "--size", "16")

    def test_failures(self):
        self.write("nan.npy", npy([float("nan")] * 8, (2, 2, 2)))
        self.fail_with("no data point has a number in every channel", "suggest", "nan.npy", "-o",
                       "scene.json")
        self.fail_with(r"-o a\.png: expected a name that ends in \.json", "suggest", "ball.npy",
                       "-o", "a.png", code=2)
        self.fail_with("--primitives", "suggest", "ball.npy", "--primitives", "9", code=2)
        self.fail_with("give FILE or --channel", "suggest", code=2)
        self.fail_with("--save-tf", "suggest", "ball.npy", "-o", "a.json", "--save-tf", "a.json",
                       code=2)
        self.fail_with("4 channels are too many, at most 3 can be used", "suggest",
                       *["ball.npy"] * 4,
                       code=2)
        self.fail_with("no/scene.json", "suggest", "ball.npy", "-o", "no/scene.json")


if __name__ == "__main__":
    unittest.main()
