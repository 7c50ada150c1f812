# SPDX-License-Identifier: Apache-2.0
"""Several variables: --channel, --gaussian, and scenes that have them."""

import json
import struct
import unittest

from program import ProgramTest, npy, ramp


def turned(n):
    """n³ values from 0 to 1 along z."""
    return [k / (n - 1) for k in range(n) for _ in range(n) for _ in range(n)]


GAUSSIANS = {"gaussians": [{"channels": ["value", "gradient_magnitude"], "center": [0.5, 0.25],
                            "width": [0.2, 0.1], "extinction": 3, "color": [1, 0.5, 0.25]}]}
TEXT = "value=0.5~0.2, gradient_magnitude=0.25~0.1; extinction 3; color 1,0.5,0.25"


class Channels(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("a.npy", npy(ramp(5), (5, 5, 5)))
        self.write("b.npy", npy(turned(5), (5, 5, 5)))
        self.write("small.npy", npy(ramp(4), (4, 4, 4)))
        self.write("tf.json", json.dumps(GAUSSIANS))

    def saved(self, *arguments):
        """The complete scene that these arguments make; nothing is rendered."""
        self.succeed("render", *arguments, "--save-scene", "saved.json")
        return json.loads(self.read("saved.json"))["layers"][0]

    def refuse(self, pattern, *arguments, code=1):
        self.fail_with(pattern, "render", *arguments, "-o", "o.png", "-o", "o.exr", "--size", "8",
                       code=code)

    def test_gaussians_of_one_volume(self):
        volume = self.saved("a.npy", "--gaussian", TEXT)
        self.assertEqual(volume["field"], {"file": "a.npy"})
        self.assertEqual(volume["transfer_function"], GAUSSIANS)
        self.assertEqual(self.saved("a.npy", "--tf", "tf.json"), volume)
        self.succeed("render", "saved.json", "--save-scene", "again.json")
        self.assertEqual(self.read("again.json"), self.read("saved.json"))
        self.assertEqual(json.loads(self.succeed("render", "a.npy", "--gaussian", TEXT,
                                                 "--print-tf")), GAUSSIANS)

    def test_channels_alone(self):
        volume = self.saved("--channel", "x=a.npy", "--channel", "z=b.npy",
                            "--channel", "edge=gradient_magnitude:x",
                            "--channel", "bend=second_derivative:z",
                            "--channel", "soft=smoothed:z:0.5", "--gaussian",
                            "x=0.5~0.1, soft = 0.5 a.u. ~ 0.1 a.u.; extinction 1; color #ff0000",
                            "--gaussian", "edge=1~1;extinction 2")
        self.assertEqual(volume["channels"], [
            {"name": "x", "file": "a.npy"}, {"name": "z", "file": "b.npy"},
            {"name": "edge", "gradient_magnitude": "x"}, {"name": "bend", "second_derivative": "z"},
            {"name": "soft", "smoothed": "z", "sigma": 0.5}])
        self.assertEqual([g["channels"] for g in volume["transfer_function"]["gaussians"]],
                         [["x", "soft"], ["edge"]])
        self.assertEqual([g["color"] for g in volume["transfer_function"]["gaussians"]],
                         [[1, 0, 0], [1, 1, 1]])

    def test_channels_beside_a_volume(self):
        text = "value=0~1, z=0~1, gradient_magnitude=0~1; extinction 1"
        volume = self.saved("a.npy", "--channel", "z=b.npy", "--gaussian", text)
        self.assertEqual(volume["channels"], [
            {"name": "value", "file": "a.npy"},
            {"name": "gradient_magnitude", "gradient_magnitude": "value"},
            {"name": "z", "file": "b.npy"}])

    def test_channels_beside_a_scene(self):
        self.write("scene.json", json.dumps({"volumes": [{
            "channels": [{"name": "x", "file": "a.npy"}],
            "transfer_function": {"gaussians": [{"center": [0.5], "width": [1], "extinction": 1,
                                                 "color": [1, 1, 1]}]}}]}))
        self.saved("scene.json")
        volume = self.saved("scene.json", "--channel", "z=b.npy", "--gaussian",
                            "0~1, 0~1; extinction 1")
        self.assertEqual([c["name"] for c in volume["channels"]], ["x", "z"])
        self.refuse("Gaussian 0: center has 1 numbers.*2 channels", "scene.json", "--channel",
                    "z=b.npy")

    def test_options_of_volume_files_are_for_all(self):
        self.write("a.raw", bytes(range(8)))
        self.write("b.raw", bytes(range(8)))
        volume = self.saved("--channel", "a=a.raw", "--channel", "b=b.raw", "--dimensions", "2,2,2",
                            "--type", "u8", "--spacing", "1,2,3", "--gaussian",
                            "1~1, 1~1; extinction 1")
        for channel in volume["channels"]:
            self.assertEqual((channel["type"], channel["spacing"]), ("u8", [1, 2, 3]))

    def test_components_of_a_file(self):
        both = [value for pair in zip(ramp(2), turned(2)) for value in pair]
        self.write("c.raw", struct.pack("<16f", *both))
        options = ("--dimensions", "2,2,2", "--type", "f32", "--components", "2")
        volume = self.saved("--channel", "x=c.raw[0]", "--channel", "z=c.raw[1]", *options,
                            "--gaussian", "1~1, 1~1; extinction 1")
        self.assertEqual([c["component"] for c in volume["channels"]], [0, 1])
        self.refuse("c.raw", "--channel", "x=c.raw[2]", *options, "--gaussian", "1~1; extinction 1")
        # Brackets go before the option.
        volume = self.saved("--channel", "x=c.raw[0]", "--channel", "z=c.raw", *options,
                            "--component", "1", "--gaussian", "1~1, 1~1; extinction 1")
        self.assertEqual([c["component"] for c in volume["channels"]], [0, 1])

    def test_wrong_arguments(self):
        def refuse(pattern, *arguments):
            self.refuse(pattern, *arguments, code=2)
        refuse("no input; give INPUT, --channel or --labels")
        refuse("--channel.*expected NAME=SOURCE", "a.npy", "--channel", "b.npy")
        refuse('--channel.*"value" stands twice', "a.npy", "--channel", "value=b.npy")
        refuse("--channel.*not before it", "--channel", "e=gradient_magnitude:x",
               "--channel", "x=a.npy")
        refuse("--channel.*from 1 to 8", *(f"--channel=c{i}=a.npy" for i in range(9)))
        refuse("--type applies to volume files, not to built-in fields", "--channel",
               "a=builtin:ramp:4", "--channel", "e=gradient_magnitude:a", "--type", "u8",
               "--spacing", "1,2,3", "--gaussian", "1~1, 1~1; extinction 1")
        refuse("--gaussian.*has no width", "a.npy", "--gaussian", "value=3; extinction 1")
        refuse("--gaussian.*no extinction", "a.npy", "--gaussian", "value=3~1")
        refuse("--gaussian.*--tf|--tf.*--gaussian", "a.npy", "--gaussian", TEXT, "--tf", "tf.json")

    def test_what_does_not_fit(self):
        self.refuse('Gaussian 0 looks at a channel "valeu".*did you mean "value"', "a.npy",
                    "--gaussian", "valeu=1~1; extinction 1")
        self.refuse('"gradient_magntude", which is not there .did you mean "gradient_magnitude".*'
                    'there are: value, gradient_magnitude, second_derivative', "a.npy",
                    "--gaussian", "value=1~1, gradient_magntude=1~1; extinction 1")
        self.refuse('channel "b" .*not on one grid: 4 x 4 x 4 and 5 x 5 x 5',
                    "--channel", "a=a.npy",
                    "--channel", "b=small.npy", "--gaussian", "1~1, 1~1; extinction 1")
        self.refuse("channels need a transfer function.*pellucid suggest", "--channel", "a=a.npy")
        self.refuse("points in one variable", "--channel", "a=a.npy", "--tf", self.write(
            "points.json", '{"points": [{"value": 0, "extinction": 1, "color": [1, 1, 1]}]}'))
        self.refuse("missing.npy", "--channel", "a=missing.npy", "--gaussian", "1~1; extinction 1")

    def test_methods_of_linear_steps(self):
        arguments = ("a.npy", "--gaussian", TEXT, "--size", "8", "-q")
        self.succeed("render", *arguments, "-o", "exact.exr", "--tolerance", "1e-6")
        for method, largest in (("kniss", 2e-3), ("gaussian", 1e-3)):
            self.succeed("render", *arguments, "-o", "steps.exr", "--method", method,
                         "--step", "0.1")
            self.succeed("compare", "exact.exr", "steps.exr", "--largest", str(largest))
            self.fail_with("for Gaussians of channels", "render", "a.npy", "-o", "o.exr", "--size",
                           "8", "--method", method)
        self.fail_with("preintegrated", "render", *arguments, "-o", "o.exr", "--method",
                       "preintegrated")

    def test_no_output_replaces_a_channel(self):
        self.fail_with("would overwrite the input channel z b.npy", "render", "a.npy", "--channel",
                       "z=b.npy", "--gaussian", "1~1, 1~1; extinction 1", "--save-tf", "b.npy",
                       code=2)


if __name__ == "__main__":
    unittest.main()
