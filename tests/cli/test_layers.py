# SPDX-License-Identifier: Apache-2.0
"""Scenes of several layers: --layer, --labels, --clip, and files that have them."""

import json
import unittest

from program import HAZE, ProgramTest, npy, pixel, png, ramp

# Labels 0, 2 and 5 in slabs along x.
SLABS = [(0, 2, 2, 5, 5)[i] for _ in range(25) for i in range(5)]
SNAP = '# ITK-SNAP\n0 0 0 0 0 0 0 "Clear Label"\n2 255 0 0 1 1 1 "left part"\n' \
       '5 0 255 0 0.5 1 1 "right part"\n'
SLICER = "# Color table file\n0 air 0 0 0 0\n2 left_part 255 0 0 255\n5 right_part 0 255 0 128\n"


class Layers(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("a.npy", npy(ramp(5), (5, 5, 5)))
        self.write("labels.npy", npy(SLABS, (5, 5, 5)))
        self.write("half.npy", npy([0.5] * 125, (5, 5, 5)))
        self.write("tf.json", json.dumps(HAZE))

    def saved(self, *arguments):
        """The complete scene that these arguments make; nothing is rendered."""
        self.succeed("render", *arguments, "--save-scene", "saved.json")
        return json.loads(self.read("saved.json"))

    def refuse(self, pattern, *arguments, code=1):
        self.fail_with(pattern, "render", *arguments, "-o", "o.png", "-o", "o.exr", "--size", "8",
                       code=code)

    def refuse_scene(self, pattern, scene):
        self.write("scene.json", json.dumps(scene))
        self.refuse(pattern, "scene.json")

    def test_layers_and_clips_of_the_command_line(self):
        scene = self.saved("a.npy", "--tf", "tf.json", "--layer", "builtin:sphere:6", "--labels",
                           "labels.npy", "--clip", "plane:1,1,1,0,0,1", "--clip",
                           "-cylinder:0,0,0,4,4,4,1", "--clip", "box:0,0,0,3,3,4")
        self.assertEqual(scene["pellucid"], 2)
        field, sphere, labels = scene["layers"]
        self.assertEqual(field["transfer_function"]["points"], HAZE["points"])
        self.assertEqual(sphere["field"], {"builtin": "sphere", "points": 6})
        self.assertGreater(len(sphere["transfer_function"]["points"]), 1)
        self.assertEqual([style["label"] for style in labels["labels"]["colors"]], [2, 5])
        self.assertEqual(labels["name"], "labels.npy")
        self.assertEqual(scene["clip"], [
            {"plane": {"point": [1, 1, 1], "normal": [0, 0, 1]}},
            {"cylinder": {"start": [0, 0, 0], "end": [4, 4, 4], "radius": 1}, "keep": "outside"},
            {"box": {"lower": [0, 0, 0], "upper": [3, 3, 4]}}])

    def test_names_and_colors_of_labels(self):
        self.write("organs.txt", b'0 0 0 0 0 0 0 "Clear Label"\n2 255 0 0 1 1 1 "liver"\n'
                                 b'5 0 0 255 1 1 1 "spleen"\n')
        scene = self.saved("a.npy", "--labels", "labels.npy", "--labels", "labels.npy",
                           "--label-table", "organs.txt")
        named, plain = [layer["labels"]["colors"] for layer in scene["layers"][1:]]
        styles = {style["label"]: style for style in named}
        self.assertEqual((styles[2]["name"], styles[2]["color"]), ("liver", [1, 0, 0]))
        self.assertEqual((styles[5]["name"], styles[5]["color"]), ("spleen", [0, 0, 1]))
        self.assertNotIn("liver", [style.get("name") for style in plain])
        self.refuse("--label-table: is of a segmentation; give one more --labels", "a.npy",
                    "--labels", "labels.npy", "--label-table", "organs.txt", "--label-table",
                    "organs.txt", code=2)
        self.refuse("none.txt", "a.npy", "--labels", "labels.npy", "--label-table", "none.txt")

    def test_a_saved_scene_gives_the_same_picture(self):
        self.succeed("render", "a.npy", "--tf", "tf.json", "--labels", "labels.npy", "--clip",
                     "sphere:2,2,2,1.7", "--size", "12", "-o", "first.exr", "--save-scene",
                     "s.json")
        self.succeed("render", "s.json", "-o", "second.exr")
        report = json.loads(self.succeed("compare", "first.exr", "second.exr", "--json"))
        self.assertEqual(report["largest"], 0, report)

    def test_the_report_lists_the_layers(self):
        report = self.report("render", "a.npy", "--labels", "labels.npy", "-o", "o.exr", "--size",
                             "12", "--depth", "d.png")
        self.assertEqual([layer["kind"] for layer in report["layers"]], ["field", "labels"])
        self.assertEqual(report["layers"][1]["dimensions"], [5, 5, 5])
        self.assertEqual(report["pixels_over"], 0)
        self.assertLessEqual(report["largest_error"], report["tolerance"])
        self.assertGreater(report["largest_channel"], 0)

    def test_labels_are_seen_inside_of_a_volume(self):
        n = 24
        at = [(x, y, z) for z in range(n) for y in range(n) for x in range(n)]
        radius = [((x - 11.5) ** 2 + (y - 11.5) ** 2 + (z - 11.5) ** 2) ** 0.5 for x, y, z in at]
        self.write("body.npy", npy([100 if r < 11 else 0 for r in radius], (n, n, n)))
        self.write("core.npy", npy([1 if r < 4 else 0 for r in radius], (n, n, n), "<u1"))
        picture = ["-o", "o.png", "--size", "41", "--view", "front", "--background", "black"]
        result = self.run_program("render", "body.npy", "--labels", "core.npy", *picture)
        self.assertIn(b"look haze, for labels inside of it: grey, a tenth as dense", result.stderr)
        red, green, blue = pixel(png(self.read("o.png")), 20, 20)[:3]
        body = pixel(png(self.read("o.png")), 8, 20)[:3]
        self.assertGreater(red, 2 * blue)  # the first label is orange
        self.assertGreater(min(body), 10)  # what is around it is seen too, in grey
        self.assertLessEqual(max(body) - min(body), 1)
        # Opaque, it hides them.
        self.succeed("render", "body.npy", "--labels", "core.npy", "--look", "haze", "--opacity",
                     "1000", "--colormap", "gray", *picture)
        shown = pixel(png(self.read("o.png")), 20, 20)[:3]
        self.assertLessEqual(max(shown) - min(shown), 2)

    def test_the_look_around_labels_is_changed_by_options(self):
        def points(*arguments):
            layers = self.saved("a.npy", *arguments)["layers"]
            return layers[0]["transfer_function"]["points"]

        haze = points("--look", "haze", "--labels", "labels.npy")
        for options, factor in ([], 0.1), (["--opacity", "3"], 0.3):
            around = points("--labels", "labels.npy", *options)
            self.assertAlmostEqual(max(p["extinction"] for p in around),
                                   factor * max(p["extinction"] for p in haze), places=9)
            self.assertTrue(all(len(set(p["color"])) == 1 for p in around))
        colored = points("--labels", "labels.npy", "--colormap", "viridis")
        self.assertFalse(all(len(set(p["color"])) == 1 for p in colored))
        self.assertEqual(points("--labels", "labels.npy", "--tf", "tf.json"), points("--tf",
                                                                                    "tf.json"))

    def test_pictures_are_within_the_tolerance(self):
        run = ("render", "a.npy", "--tf", "tf.json", "--labels", "labels.npy", "--clip",
               "-plane:2,2,2,1,2,3", "--size", "16")
        self.succeed(*run, "-o", "truth.exr", "--reference")
        for grade in ("estimated", "proved"):
            self.succeed(*run, "-o", "o.exr", "--tolerance", "1e-4", "--grade", grade)
            report = json.loads(self.succeed("compare", "o.exr", "truth.exr", "--json"))
            self.assertLessEqual(report["largest"], 1e-4)

    def test_labels_alone_with_tables_of_other_programs(self):
        self.assertEqual(len(self.saved("--labels", "labels.npy")["layers"]), 1)
        for name, text in (("t.txt", SNAP), ("t.ctbl", SLICER)):
            self.write(name, text)
            self.write("scene.json", json.dumps({"layers": [
                {"labels": {"file": "labels.npy", "table": name, "extinction": 2}}]}))
            looks = self.saved("scene.json")["layers"][0]["labels"]["colors"]
            self.assertEqual([look["label"] for look in looks], [0, 2, 5])
            self.assertEqual(looks[1], {"label": 2, "name": "left part", "color": [1, 0, 0],
                                        "extinction": 2})
            self.assertAlmostEqual(looks[2]["extinction"], 1, delta=0.01)
            self.assertEqual(looks[0]["extinction"], 0)

    def test_labels_alone_have_no_function(self):
        alone = ("--labels", "labels.npy")
        for options in (("--tf", "none.json"), ("--preset", "ct-bone"), ("--gaussian", "v=1~1"),
                        ("--projection", "maximum"), ("--colormap", "jet"), ("--iso", "1"),
                        ("--look", "ct")):
            self.refuse(options[0] + ".*: is for INPUT", *alone, *options,
                        code=2)
        self.refuse("--spacing applies to volume files, not to files of --layer and --labels",
                    *alone, "--spacing", "1,1,2", code=2)
        self.refuse("--unit-distance does not apply to files of --layer and --labels", *alone,
                    "--unit-distance", "2", code=2)
        self.write("scene.json", json.dumps({"layers": [{"labels": {"file": "labels.npy"}}]}))
        for options in (("--tf", "none.json"), ("--preset", "ct-bone"), ("--gaussian", "v=1~1")):
            self.refuse(f"{options[0]}: labels have colors of their own", "scene.json", *options,
                        code=2)
        for options in (alone, (*alone, "--look", "labels"), ("scene.json",)):
            result = self.run_program("render", *options, "--size", "4", "-o", "a.exr")
            self.assertEqual(result.returncode, 0)
            self.assertNotIn(b"no transfer function", result.stderr)

    def test_tables_in_other_encodings(self):
        def name_of(data):
            self.write("t.txt", data)
            scene = self.saved("--labels", "labels.npy", "--label-table", "t.txt")
            return scene["layers"][0]["labels"]["colors"][0]["name"]

        line = '2 255 0 0 1 1 1 "fu\xdf"\n'
        for encoding in ("utf-8", "utf-8-sig", "latin-1"):
            self.assertEqual(name_of(line.encode(encoding)), "fu\xdf")
        # Bytes that look like UTF-8 but are half of a pair.
        self.assertEqual(name_of(b"2 \xed\xa0\x80 1 1 1 1\n"), "\xed\xa0\x80")
        for encoding in ("utf-16", "utf-16-be"):
            self.write("t.txt", ("\ufeff" if encoding == "utf-16-be" else "").encode(encoding)
                       + line.encode(encoding))
            self.refuse(r"t\.txt: is text in UTF-16; save it as UTF-8", "--labels", "labels.npy",
                        "--label-table", "t.txt")

    def test_tables_that_are_none(self):
        def scene(text):
            self.write("t.txt", text)
            return {"layers": [{"labels": {"file": "labels.npy", "table": "t.txt"}}]}
        self.refuse_scene(r"t\.txt: line 2: is no label; lines are", scene("# c\n1 2 3\n"))
        self.refuse_scene(r"line 1: is no label", scene('1 300 0 0 1 1 1 "a"\n'))
        self.refuse_scene(r"line 2: label 2 is there twice", scene("2 a 1 1 1 1\n2 b 1 1 1 1\n"))
        self.refuse_scene(r"has no label", scene("# nothing\n"))
        self.refuse_scene("none.txt", {"layers": [{"labels": {"file": "labels.npy",
                                                              "table": "none.txt"}}]})

    def test_what_cannot_be(self):
        self.refuse(r"half\.npy: holds the value 0\.5, but labels are whole numbers", "--labels",
                    "half.npy")
        self.refuse("no/such", "a.npy", "--layer", "no/such.npy")
        self.refuse("--clip 'cube:1,2,3': expected plane:", "a.npy", "--clip", "cube:1,2,3", code=2)
        self.refuse("--clip 'sphere:1,2,3': expected", "a.npy", "--clip", "sphere:1,2,3", code=2)
        self.refuse("radius is -1", "a.npy", "--clip", "sphere:1,2,3,-1", code=2)
        self.refuse("--print-tf: labels have colors", "--labels", "labels.npy", "--print-tf",
                    code=2)
        self.refuse("homogeneous is for the cells of a mesh", "a.npy", "--layer", "a.npy",
                    "--method", "homogeneous")
        two = {"layers": [{"field": {"file": "a.npy"}}, {"field": {"file": "a.npy"}}]}
        self.write("two.json", json.dumps(two))
        self.refuse("--tf: the scene has 2 layers", "two.json", "--tf", "tf.json", code=2)
        two["layers"][1]["transform"] = [[1, 0, 0, 0], [1, 0, 0, 0], [0, 0, 1, 0]]
        self.refuse_scene("layer 2: transform is singular", two)
        self.write("small.npy", npy([1] * 64, (4, 4, 4)))
        self.refuse_scene("the mask is not on the grid of the data", {"layers": [{
            "field": {"file": "a.npy"}, "mask": {"file": "small.npy", "functions": [
                {"label": 1, "transfer_function": HAZE}]}}]})

    def test_masks_choose_functions(self):
        clear = {"points": [{"value": 0, "extinction": 0, "color": [0, 0, 0]}]}
        everywhere = [{"label": label, "transfer_function": clear} for label in (0, 2, 5)]
        scene = {"layers": [{"field": {"file": "a.npy"}, "transfer_function": HAZE,
                             "mask": {"file": "labels.npy", "functions": everywhere}}],
                 "image": {"width": 8, "height": 8}}
        self.write("scene.json", json.dumps(scene))
        self.assertEqual(self.report("render", "scene.json", "-o", "o.exr")["largest_channel"], 0)
        scene["layers"][0]["mask"]["functions"].pop()
        self.write("scene.json", json.dumps(scene))
        self.assertGreater(self.report("render", "scene.json", "-o", "o.exr")["largest_channel"], 0)

    def test_a_backdrop_ends_rays(self):
        size = ("--size", "12x10")
        self.succeed("render", "builtin:sphere:8", *size, "-o", "wall.exr")
        plain = self.report("render", "a.npy", "--tf", "tf.json", *size, "-o", "plain.exr")
        # As large as the backdrop, whose depth is where the sphere is half seen.
        report = self.report("render", "builtin:sphere:8", "--tf", "tf.json", "--backdrop",
                             "wall.exr", "-o", "both.exr", "--save-scene", "s.json")
        self.assertEqual(report["size"], [12, 10])
        self.assertLessEqual(report["largest_error"], report["tolerance"])
        self.assertGreater(plain["largest_channel"], 0)
        self.assertEqual(json.loads(self.read("s.json"))["image"]["backdrop"], "wall.exr")
        self.succeed("render", "s.json", "-o", "again.exr")
        again = json.loads(self.succeed("compare", "both.exr", "again.exr", "--json"))
        self.assertEqual(again["largest"], 0, again)
        self.succeed("render", "s.json", "--reference", "-o", "truth.exr")
        truth = json.loads(self.succeed("compare", "both.exr", "truth.exr", "--json"))
        self.assertLessEqual(truth["largest"], report["tolerance"], truth)

    def test_a_backdrop_that_does_not_fit_is_refused(self):
        self.succeed("render", "a.npy", "--size", "12", "-o", "wall.exr")
        self.refuse("backdrop: has 12 x 12 pixels, but the image has 8 x 8", "a.npy", "--backdrop",
                    "wall.exr")
        self.refuse("none.exr: ", "a.npy", "--backdrop", "none.exr")
        self.refuse("tf.json: ", "a.npy", "--backdrop", "tf.json")
        self.fail_with("would overwrite the input", "render", "a.npy", "--backdrop", "wall.exr",
                       "-o", "wall.exr", code=2)

    def test_hidden_layers_are_not_seen(self):
        scene = {"layers": [{"visible": False, "field": {"file": "a.npy"}}],
                 "image": {"width": 8, "height": 8}}
        self.write("scene.json", json.dumps(scene))
        self.assertEqual(self.report("render", "scene.json", "-o", "o.exr")["largest_channel"], 0)


if __name__ == "__main__":
    unittest.main()
