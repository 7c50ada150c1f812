# SPDX-License-Identifier: Apache-2.0
"""Light, isosurfaces and slices: --shading, --light, --iso, --slice, and files of functions."""

import json
import unittest

from program import HAZE, ProgramTest, npy, ramp

LEGACY = ("1\n1\n0.9\n0.1\n0.2\n10\n6 0 0 0.5 0.25 1 0.5\n4 0 0.25 2 1\n"
          "8 0 0 0 0 1 1 0.5 0.25\n")


class Light(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("a.npy", npy(ramp(5), (5, 5, 5)))
        self.write("haze.json", json.dumps(HAZE))

    def scene(self, *arguments):
        """The scene that the program writes without rendering, and its first layer."""
        self.succeed("render", *arguments, "--save-scene", "saved.json")
        scene = json.loads(self.read("saved.json"))
        return scene, scene["layers"][0]

    def test_surfaces_alone(self):
        scene, layer = self.scene("a.npy", "--iso", "0.25", "--iso", "0.5:#ff0000:0.5")
        self.assertNotIn("lights", scene)
        self.assertEqual([s["value"] for s in layer["isosurfaces"]], [0.25, 0.5])
        self.assertEqual(layer["isosurfaces"][0]["color"], [1, 1, 1])
        self.assertEqual(layer["isosurfaces"][1]["color"], [1, 0, 0])
        self.assertEqual(layer["isosurfaces"][1]["opacity"], 0.5)
        self.assertEqual(layer["shading"]["power"], 20)
        self.assertEqual({p["extinction"] for p in layer["transfer_function"]["points"]}, {0})
        # What was saved is read again, to the same scene.
        self.write("s.json", json.dumps(scene))
        again, _ = self.scene("s.json")
        self.assertEqual(again, scene)

    def test_slices_alone_are_grey(self):
        _, layer = self.scene("a.npy", "--slice", "x=-0.5", "--slice", "1,2,3,0,0,2:0.5")
        self.assertEqual(layer["slices"],
                         [{"point": [-0.5, 0, 0], "normal": [1, 0, 0], "opacity": 1},
                          {"point": [1, 2, 3], "normal": [0, 0, 2], "opacity": 0.5}])
        self.assertNotIn("shading", layer)
        self.assertEqual(layer["transfer_function"]["points"],
                         [{"value": 0, "extinction": 0, "color": [0, 0, 0]},
                          {"value": 1, "extinction": 0, "color": [1, 1, 1]}])

    def test_a_saved_scene_has_the_colors(self):
        self.write("preset.json", json.dumps({"layers": [
            {"field": {"file": "a.npy"},
             "isosurfaces": [{"value": 0.5, "colors": {"preset": "x-ray", "range": [0, 2]}}],
             "slices": [{"point": [0, 0, 0], "normal": [0, 0, 1]}]}]}))
        scene, layer = self.scene("preset.json")
        points = layer["isosurfaces"][0]["colors"]["points"]
        self.assertEqual([p["value"] for p in points], [0, 2])
        self.assertNotIn("colors", layer["slices"][0])
        self.write("s.json", json.dumps(scene))
        self.assertEqual(self.scene("s.json")[0], scene)
        # Of several variables a slice is grey.
        _, layer = self.scene("--channel", "a=a.npy", "--channel", "b=a.npy", "--slice", "z=0")
        self.assertEqual([p["color"] for p in layer["slices"][0]["colors"]["points"]],
                         [[0, 0, 0], [1, 1, 1]])
        self.assertNotIn("transfer_function", layer)

    def test_surfaces_in_a_medium(self):
        for function in (["--tf", "haze.json"], ["--preset", "x-ray"]):
            _, layer = self.scene("a.npy", "--iso", "-0.25", *function)
            self.assertGreater(layer["transfer_function"]["points"][-1]["extinction"], 0)
            self.assertEqual(len(layer["isosurfaces"]), 1)

    def test_shading(self):
        self.assertNotIn("shading", self.scene("a.npy", "--shading", "off")[1])
        self.assertEqual(self.scene("a.npy", "--shading", "on")[1]["shading"],
                         {"ambient": 0.2, "diffuse": 0.7, "specular": 0.2, "power": 20,
                          "gradient": "smooth"})
        self.assertNotIn("shading", self.scene("a.npy", "--iso", "1", "--shading", "off")[1])
        self.write("lit.json", json.dumps({"layers": [
            {"field": {"file": "a.npy"}, "shading": {"power": 5, "gradient": "field"}}]}))
        shading = self.scene("lit.json", "--shading", "0.1,0.5,0.3")[1]["shading"]
        self.assertEqual([shading[k] for k in ("ambient", "diffuse", "specular", "power",
                                               "gradient")], [0.1, 0.5, 0.3, 5, "field"])
        self.assertEqual(self.scene("lit.json", "--shading", "on")[1]["shading"]["power"], 5)
        self.assertNotIn("shading", self.scene("lit.json", "--shading", "off")[1])

    def test_lights(self):
        scene, _ = self.scene("a.npy", "--light", "head:0,0.5,1", "--light",
                              "directional:0,1,-1", "--light", "point:1,2,3:white")
        self.assertEqual(scene["lights"], [
            {"type": "head", "color": [0, 0.5, 1]},
            {"type": "directional", "direction": [0, 1, -1], "color": [1, 1, 1]},
            {"type": "point", "position": [1, 2, 3], "color": [1, 1, 1]}])
        # They replace those of the scene.
        self.write("s.json", json.dumps(scene))
        again, _ = self.scene("s.json", "--light", "head:black")
        self.assertEqual(again["lights"], [{"type": "head", "color": [0, 0, 0]}])

    def test_the_report_tells(self):
        report = self.report("render", "a.npy", "--iso", "0.5", "--slice", "z=0", "--light",
                             "head:0,1,0", "--size", "4", "-o", "a.png")
        self.assertEqual(report["transfer_function_from"], "none")
        self.assertEqual(report["lights"], [{"type": "head", "color": [0, 1, 0]}])
        layer = report["layers"][0]
        self.assertEqual(layer["shading"]["diffuse"], 0.7)
        self.assertIsNone(layer["gradient_opacity"])
        self.assertEqual(layer["isosurfaces"][0]["value"], 0.5)
        self.assertEqual(layer["slices"][0]["normal"], [0, 0, 1])
        result = self.run_program("render", "a.npy", "--slice", "z=0", "--size", "4", "-o", "b.png")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn(b"only isosurfaces and slices are shown", result.stderr)
        plain = self.report("render", "a.npy", "--shading", "off", "--size", "4", "-o", "c.png")
        self.assertIsNone(plain["layers"][0]["shading"])
        self.assertEqual(plain["layers"][0]["isosurfaces"], [])

    def test_a_file_alone_with_surfaces_is_lit(self):
        lit, layer = self.scene("a.npy")
        self.assertEqual(layer["shading"]["diffuse"], 0.8)
        _, unlit = self.scene("a.npy", "--shading", "off")
        self.assertEqual(unlit["transfer_function"], layer["transfer_function"])
        self.assertNotIn("shading", unlit)
        result = self.run_program("render", "a.npy", "--size", "4", "-o", "s.png")
        self.assertIn(b"pellucid: look scan, for data with surfaces", result.stderr)
        # What was saved gives the same picture.
        self.write("saved.json", json.dumps(lit))
        self.succeed("render", "a.npy", "--size", "4", "-o", "1.exr")
        self.succeed("render", "saved.json", "--size", "4", "-o", "2.exr")
        self.succeed("compare", "1.exr", "2.exr", "--largest", "0")
        for other in (["builtin:ramp:16", "--look", "haze"], ["a.npy", "--projection", "maximum"],
                      ["a.npy", "--preset", "x-ray"]):
            self.assertNotIn("shading", self.scene(*other)[1], other)
        # Other methods are compared with the same look.
        self.assertEqual(self.scene("a.npy", "--method", "midpoint")[1], layer)

    def test_functions_bring_light(self):
        self.write("look.vp", LEGACY)
        _, layer = self.scene("a.npy", "--tf", "look.vp")
        self.assertEqual(layer["shading"]["diffuse"], 0.9)
        self.assertEqual(layer["gradient_opacity"],
                         {"points": [{"gradient": 0, "factor": 0.25}, {"gradient": 2, "factor": 1}],
                          "unit": "voxel"})
        _, layer = self.scene("a.npy", "--tf", "look.vp", "--shading", "off")
        self.assertNotIn("shading", layer)
        self.assertIn("gradient_opacity", layer)
        # The scene's own come first.
        self.write("lit.json", json.dumps({"layers": [
            {"field": {"file": "a.npy"}, "shading": {"diffuse": 0.5}}]}))
        _, layer = self.scene("lit.json", "--tf", "look.vp")
        self.assertEqual(layer["shading"]["diffuse"], 0.5)
        self.assertIn("gradient_opacity", layer)
        # A projection has no light.
        result = self.run_program("render", "a.npy", "--tf", "look.vp", "--projection", "maximum",
                                  "--save-scene", "p.json")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn(b"look.vp: shading and gradient opacity are left out", result.stderr)
        self.assertNotIn("shading", json.loads(self.read("p.json"))["layers"][0])

    def test_functions_keep_light(self):
        self.write("look.vp", LEGACY)
        self.succeed("render", "a.npy", "--tf", "look.vp", "--save-tf", "look.json")
        look = json.loads(self.read("look.json"))
        self.assertEqual(sorted(look), ["gradient_opacity", "shading", "transfer_function"])
        _, theirs = self.scene("a.npy", "--tf", "look.vp")
        _, ours = self.scene("a.npy", "--tf", "look.json")
        self.assertEqual(ours, theirs)
        # To Slicer and back.
        self.succeed("transfer-function", "look.json", "b.vp.json", "--format", "slicer", "-q")
        self.succeed("transfer-function", "b.vp.json", "back.json", "-q")
        back = json.loads(self.read("back.json"))
        self.assertEqual(back["shading"], look["shading"])
        self.assertEqual(back["gradient_opacity"], look["gradient_opacity"])
        result = self.run_program("transfer-function", "look.json", "b.csv", "--format", "table")
        self.assertIn(b"the shading is left out", result.stderr)
        self.assertIn(b"the gradient opacity is left out", result.stderr)

    def test_says_which_surfaces_show_nothing(self):
        result = self.run_program("render", "a.npy", "--iso", "5", "--iso", "0.5", "--slice",
                                  "z=99", "-o", "a.png", "--size", "16")
        self.assertEqual(result.returncode, 0, result.stderr)
        notes = result.stderr.decode()
        text = "isosurface 5 shows nothing: the data have values from 0 to 1"
        self.assertEqual(notes.count(text), 1, notes)
        self.assertEqual(notes.count("slice 1 misses the data, which have x from 0 to 4"), 1, notes)
        result = self.run_program("render", "a.npy", "--iso", "0.5", "--iso", "0", "--slice", "z=0",
                                  "-o", "a.png", "--size", "16")
        self.assertNotRegex(result.stderr.decode(), "shows? nothing|misses")

    def test_wrong_arguments(self):
        self.write("two.json", json.dumps({"layers": [{"field": {"file": "a.npy"}}] * 2}))
        self.write("labels.json", json.dumps({"layers": [{"labels": {"file": "a.npy"}}]}))
        for expected, arguments in [
                ("--iso 'bone': expected VALUE", ["a.npy", "--iso", "bone"]),
                ("--iso '1:white:2': expected VALUE", ["a.npy", "--iso", "1:white:2"]),
                ("--iso '1.0:black': there is an isosurface of 1 already",
                 ["a.npy", "--iso", "1", "--iso", "1.0:black"]),
                ("--slice 'w=1': expected x=VALUE", ["a.npy", "--slice", "w=1"]),
                ("--light 'spot': expected head", ["a.npy", "--light", "spot"]),
                ("direction is", ["a.npy", "--light", "directional:0,0,0"]),
                ("--shading 'bright': expected on, off", ["a.npy", "--shading", "bright"]),
                ("--iso: a projected layer has no light", ["a.npy", "--iso", "1", "--projection",
                                                          "sum"]),
                ("--iso: is for INPUT", ["--layer", "a.npy", "--iso", "1"]),
                ("--slice: the scene has 2 layers", ["two.json", "--slice", "x=1"]),
                ("--shading: labels have no light", ["labels.json", "--shading", "on"])]:
            self.fail_with(expected, "render", *arguments, "-o", "a.png", code=2)


if __name__ == "__main__":
    unittest.main()
