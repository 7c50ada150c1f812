# SPDX-License-Identifier: Apache-2.0
"""Bad input: one line on stderr, a non-zero exit code, and no file."""

import json
import os
import struct
import unittest

from program import HAZE, ProgramTest, npy, ramp


class BadInput(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("good.npy", npy(ramp(4), (4, 4, 4)))
        self.write("tf.json", json.dumps(HAZE))

    def refuse(self, pattern, *arguments, code=1, also_info=False):
        message = self.fail_with(pattern, "render", *arguments, "-o", "o.png", "-o", "o.exr",
                                 "--size", "8", code=code)
        if also_info:
            self.fail_with(pattern, "info", *arguments, code=code)
        return message

    def refuse_scene(self, pattern, scene):
        self.write("scene.json", scene if isinstance(scene, str) else json.dumps(scene))
        self.refuse(pattern, "scene.json")

    def test_missing_file(self):
        self.refuse("nothing.npy", "nothing.npy", also_info=True)
        self.refuse("nothing.json", "nothing.json")
        self.refuse("nothing.nii.gz", "nothing.nii.gz", also_info=True)
        self.refuse("nothing.json", "good.npy", "--tf", "nothing.json")
        self.refuse("nothing.json", "good.npy", "--camera", "nothing.json")

    def test_not_a_file(self):
        os.mkdir(self.path("folder.npy"))
        self.refuse("folder.npy", "folder.npy", also_info=True)
        self.write("a.jpeg", "what is this")
        self.refuse("a.jpeg", "a.jpeg", also_info=True)
        self.refuse("error", "", also_info=True)

    def test_truncated_file(self):
        content = self.read("good.npy")
        for size in (0, 5, 40, 128, len(content) - 1):
            self.write("cut.npy", content[:size])
            self.refuse("cut.npy", "cut.npy", also_info=True)
        self.write("cut.nii.gz", b"\x1f\x8b\x08\x00garbage")
        self.refuse("cut.nii.gz", "cut.nii.gz", also_info=True)
        self.write("cut.mha", b"ObjectType = Image\nNDims = 3\nDimSize = 4 4 4\n"
                              b"ElementType = MET_FLOAT\nElementDataFile = LOCAL\n1234")
        self.refuse("cut.mha", "cut.mha", also_info=True)
        self.write("cut.nrrd", b"NRRD0004\ntype: float\ndimension: 3\nsizes: 4 4 4\nendian: little\n"
                               b"encoding: raw\n\n1234")
        self.refuse("cut.nrrd", "cut.nrrd", also_info=True)

    def test_wrong_sizes(self):
        self.write("a.raw", bytes(64))
        raw = ("a.raw", "--type", "u8")
        self.refuse("64 bytes", *raw, "--dimensions", "4,4,5", also_info=True)
        self.refuse("64 bytes", *raw, "--dimensions", "4,4,3", also_info=True)
        self.refuse("a.raw", *raw, "--dimensions", "4,4,4", "--skip-bytes", "1", also_info=True)
        self.refuse("a.raw", *raw, "--dimensions", "2000000000,2000000000,2000000000", also_info=True)
        self.refuse("a.raw", *raw, "--dimensions", "64,1,1", also_info=True)
        self.refuse("a.raw", *raw, also_info=True)
        self.refuse("--dimensions", *raw, "--dimensions", "4,4", code=2, also_info=True)
        self.refuse("--dimensions", *raw, "--dimensions", "4,4,0", code=2, also_info=True)
        self.refuse("--type", "a.raw", "--type", "u7", "--dimensions", "4,4,4", code=2,
                    also_info=True)

    def test_infinite_values(self):
        self.write("a.npy", npy([0.0] * 7 + [float("inf")], (2, 2, 2)))
        self.refuse("infinite", "a.npy", also_info=True)
        self.write("a.raw", struct.pack("<8d", *([0.0] * 7), float("-inf")))
        self.refuse("infinite", "a.raw", "--type", "f64", "--dimensions", "2,2,2", also_info=True)

    def test_spacing(self):
        for spacing in ("0,1,1", "1,-1,1"):
            self.refuse("spacing", "good.npy", "--spacing", spacing, also_info=True)
        self.refuse("--spacing", "good.npy", "--spacing", "nan,1,1", code=2, also_info=True)
        self.refuse("--origin", "good.npy", "--origin", "inf,1,1", code=2, also_info=True)

    def test_transfer_functions(self):
        for text, pattern in (
                ("", "tf.json"),
                ("{", "tf.json"),
                ("[]", "tf.json"),
                ('{"points": []}', "points"),
                ('{"points": [{"value": 0, "extinction": -1, "color": [0, 0, 0]}]}', "extinction"),
                ('{"points": [{"value": 0, "extinction": NaN, "color": [0, 0, 0]}]}', "tf.json"),
                ('{"points": [{"value": 0, "extinction": 1, "color": [0, 0]}]}', "color"),
                ('{"points": [{"value": 0, "extinction": 1}]}', "color"),
                ('{"points": [{"value": 1, "extinction": 1, "color": [0, 0, 0]},'
                 ' {"value": 0, "extinction": 1, "color": [0, 0, 0]}]}', "points"),
                ('{"points": [{"value": 0, "extinction": 1, "colour": [0, 0, 0]}]}', "colour"),
                ('{"points": [{"value": 0, "extinction": 1, "color": [0, 0, 0]}], "x": 1}', "/x")):
            with self.subTest(text=text):
                self.write("tf.json", text)
                self.refuse(pattern, "good.npy", "--tf", "tf.json")

    def test_cameras(self):
        for text, pattern in (
                ("{}", "position"),
                ('{"position": [0, 0, 1], "focal_point": [0, 0, 1]}', "camera"),
                ('{"position": [0, 1, 0], "focal_point": [0, 0, 0], "up": [0, 1, 0]}', "up"),
                ('{"position": [0, 0, 1], "focal_point": [0, 0, 0], "vertical_angle": 180}',
                 "vertical_angle"),
                ('{"position": [0, 0, 1], "focal_point": [0, 0, 0], "zoom": 2}', "zoom")):
            with self.subTest(text=text):
                self.write("camera.json", text)
                self.refuse(pattern, "good.npy", "--camera", "camera.json")

    def test_scenes(self):
        volumes = [{"field": {"file": "good.npy"}, "transfer_function": HAZE}]
        self.refuse_scene("scene.json", "")
        self.refuse_scene("scene.json", "{\n\n")
        self.refuse_scene("scene.json", "\x00\x01\xff")
        self.refuse_scene("volumes", {})
        self.refuse_scene("/light", {"volumes": volumes, "light": 1})
        self.refuse_scene("/image/width", {"volumes": volumes, "image": {"width": 0}})
        self.refuse_scene("/integration/method", {"volumes": volumes,
                                                  "integration": {"method": "magic"}})
        self.refuse_scene("missing.npy", {"volumes": [{"field": {"file": "missing.npy"}}]})
        self.refuse_scene("nowhere", {"volumes": [{"field": {"builtin": "nowhere"}}]})

    def test_builtin_fields(self):
        for name in ("builtin:", "builtin:nothing", "builtin:shells:1", "builtin:shells:x",
                     "builtin:shells:99999", "builtin:shells:64:64"):
            self.refuse("error", name, also_info=True)

    def test_options_that_do_not_apply(self):
        self.refuse("--spacing", "builtin:shells:8", "--spacing", "1,1,1", code=2, also_info=True)
        self.write("scene.json", json.dumps({"volumes": [{"field": {"file": "good.npy"}}]}))
        self.refuse("--centering", "scene.json", "--centering", "cell", code=2)

    def test_messages_stay_one_line(self):
        self.refuse("two lines", "two\nlines.npy")
        self.refuse("bell", "\x07bell.npy")
        self.refuse("error", os.fsdecode(b"\xff\xfe.npy"))
        self.write("tf.json", '{"a\\nb": 1}')
        self.refuse("error", "good.npy", "--tf", "tf.json")


class Unwritable(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("good.npy", npy(ramp(4), (4, 4, 4)))

    def test_missing_folder(self):
        for option, name in (("-o", "a.png"), ("-o", "a.exr"), ("--depth", "a.png"),
                             ("--save-tf", "a.json"), ("--save-scene", "a.json")):
            self.fail_with("missing", "render", "good.npy", "-o", "fine.png", option,
                           os.path.join("missing", name))

    def test_a_folder(self):
        os.mkdir(self.path("folder.png"))
        self.fail_with("folder.png", "render", "good.npy", "-o", "folder.png")

    def test_a_device(self):
        os.symlink("/dev/null", self.path("null.png"))
        self.fail_with("null", "render", "good.npy", "-o", "null.png")

    @unittest.skipIf(os.geteuid() == 0, "root may write everywhere")
    def test_no_permission(self):
        os.mkdir(self.path("locked"))
        os.chmod(self.path("locked"), 0o500)
        self.fail_with("locked", "render", "good.npy", "-o", "locked/a.png")

    def test_a_name_that_is_too_long(self):
        self.fail_with("error", "render", "good.npy", "-o", "x" * 300 + ".png", "--size", "4")

    def test_it_is_found_out_before_the_work(self):
        # The volume is not even looked for.
        self.fail_with("missing", "render", "nothing.npy", "-o", "missing/a.png")

    def test_a_disk_that_is_full(self):
        # Sizes beyond the limit fail in the middle of writing.
        import resource
        import subprocess
        from program import PROGRAM

        def limit():
            import signal
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000))
        for name in ("a.png", "a.exr"):
            result = subprocess.run([PROGRAM, "render", "good.npy", "-o", name, "--size", "64",
                                     "--quiet"], cwd=self.folder, capture_output=True,
                                    preexec_fn=limit, check=False)
            self.assertEqual(result.returncode, 1)
            self.assertRegex(result.stderr.decode(), rf"\Apellucid: error: [^\n]*{name}[^\n]+\n\Z")
            self.assertEqual(self.files(), ["good.npy"])


if __name__ == "__main__":
    unittest.main()
