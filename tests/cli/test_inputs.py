# SPDX-License-Identifier: Apache-2.0
"""Bad input: one line on stderr, a non-zero exit code, and no file."""

import gzip
import json
import os
import random
import struct
import unittest

from program import HAZE, ProgramTest, exr, npy, png, ramp


def nifti(values, n):
    """A .nii file of n³ values in binary32, x fastest, at a spacing of 1."""
    header = bytearray(352)
    struct.pack_into("<i", header, 0, 348)
    struct.pack_into("<8h", header, 40, 3, n, n, n, 1, 1, 1, 1)
    struct.pack_into("<2h", header, 70, 16, 32)
    struct.pack_into("<8f", header, 76, 1, 1, 1, 1, 1, 1, 1, 1)
    struct.pack_into("<2f", header, 108, 352, 1)
    struct.pack_into("<2h", header, 252, 1, 0)
    header[344:348] = b"n+1\0"
    return bytes(header) + struct.pack(f"<{n ** 3}f", *values)


def noise(n):
    """n³ values that compress badly, so that half of a compressed file ends amid them."""
    generator = random.Random(7)
    return [generator.random() for _ in range(n ** 3)]


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

    def test_headers_with_a_byte_order_mark(self):
        self.write("values.raw", bytes(range(8)))
        for name, header in (
                ("a.dat", "ObjectFileName: values.raw\nResolution: 2 2 2\nFormat: UCHAR\n"),
                ("a.mhd", "ObjectType = Image\nNDims = 3\nDimSize = 2 2 2\n"
                          "ElementType = MET_UCHAR\nElementDataFile = values.raw\n")):
            self.write(name, header.encode("utf-8-sig"))
            result = self.run_program("info", name)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertNotIn(b"more than is taken into account", result.stderr)

    def test_missing_file(self):
        self.refuse("nothing.npy", "nothing.npy", also_info=True)
        self.refuse("nothing.json", "nothing.json")
        self.refuse("nothing.nii.gz", "nothing.nii.gz", also_info=True)
        self.refuse("nothing.json", "good.npy", "--tf", "nothing.json")
        self.refuse("nothing.json", "good.npy", "--camera", "nothing.json")

    def test_module_that_does_not_load(self):
        self.succeed("convert", "builtin:shells:4", "-o", "cells.vtu", "-q")
        os.mkdir(self.path("modules"))
        self.write("modules/pellucid_vtk.so", "no library")
        result = self.run_program("info", "cells.vtu",
                                  env={**os.environ, "PELLUCID_MODULES": self.path("modules")})
        self.assertEqual(result.returncode, 1)
        self.assertRegex(result.stderr.decode(),
                         r"\A[^\n]*cells\.vtu: the module pellucid_vtk\.so, which reads [^\n]*, "
                         r"does not load: [^\n]*; install VTK \(Debian: libvtk9-dev\)\n\Z")

    def test_not_a_file(self):
        os.mkdir(self.path("folder.npy"))
        self.refuse("folder.npy", "folder.npy", also_info=True)
        self.write("a.jpeg", "what is this")
        self.refuse("a.jpeg", "a.jpeg", also_info=True)
        self.refuse("no input; give INPUT, --channel or --labels", "", code=2)
        self.fail_with("is empty", "info", "")

    def test_pipes_and_devices(self):
        """Refused at once, wherever a file is read: opening a pipe waits for who writes to it."""
        os.mkfifo(self.path("pipe"))
        for name in ("a.npy", "a.npz", "a.vti", "a.vtu", "a.json", "a.vdb", "a.h5", "a"):
            os.symlink("pipe", self.path(name))
            self.refuse("not a regular file", name, also_info=name != "a.json")
            os.remove(self.path(name))
        self.refuse("not a regular file", "/dev/zero", also_info=True)
        self.refuse("not a regular file", "good.npy", "--tf", "pipe")
        self.refuse("not a regular file", "good.npy", "--camera", "pipe")
        self.refuse_scene("not a regular file",
                          {"pellucid": 1, "volumes": [{"field": {"file": "pipe"},
                                                       "transfer_function": HAZE}]})
        self.fail_with("not a regular file", "histogram", "pipe", "--json")
        self.fail_with("not a regular file", "suggest", "pipe", "-o", "scene.json")
        self.fail_with("not a regular file", "convert", "pipe", "-o", "b.nrrd")
        self.fail_with("not a regular file", "transfer-function", "pipe", "b.json")
        self.fail_with("not a regular file", "compare", "pipe", "pipe")
        # What is written to the program's standard input is a pipe, too.
        result = self.run_program("info", "/dev/stdin", input=self.read("good.npy"))
        self.assertNotEqual(result.returncode, 0)
        self.assertIn(b"not a regular file", result.stderr)

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
        self.write("cut.nrrd",
                   b"NRRD0004\ntype: float\ndimension: 3\nsizes: 4 4 4\nendian: little\n"
                               b"encoding: raw\n\n1234")
        self.refuse("cut.nrrd", "cut.nrrd", also_info=True)

    def test_truncated_compressed_file(self):
        content = gzip.compress(nifti(noise(16), 16))
        self.write("cut.nii.gz", content)
        self.assertEqual(self.report("info", "cut.nii.gz")["dimensions"], [16, 16, 16])
        self.succeed("render", "cut.nii.gz", "-o", "whole.png", "--size", "4")
        for size in (len(content) // 2, len(content) * 9 // 10):
            self.write("cut.nii.gz", content[:size])
            self.refuse("cut.nii.gz", "cut.nii.gz", also_info=True)

    def test_wrong_sizes(self):
        self.write("a.raw", bytes(64))
        raw = ("a.raw", "--type", "u8")
        self.refuse("64 bytes", *raw, "--dimensions", "4,4,5", also_info=True)
        self.refuse("64 bytes", *raw, "--dimensions", "4,4,3", also_info=True)
        self.refuse("a.raw", *raw, "--dimensions", "4,4,4", "--skip-bytes", "1", also_info=True)
        self.refuse("a.raw", *raw, "--dimensions", "2000000000,2000000000,2000000000",
                    also_info=True)
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
        self.refuse_scene("layers", {})
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


class NaN(ProgramTest):
    """Not bad input: vacuum, counted and told of."""

    def test_is_noted(self):
        values = noise(4)
        values[21] = values[42] = float("nan")
        self.write("a.npy", npy(values, (4, 4, 4)))
        self.write("a.raw", struct.pack("<64d", *values))
        self.write("a.nii.gz", gzip.compress(nifti(values, 4)))
        self.write("tf.json", json.dumps(HAZE))
        for arguments in (("a.npy",), ("a.nii.gz",),
                          ("a.raw", "--type", "f64", "--dimensions", "4,4,4")):
            with self.subTest(arguments=arguments):
                result = self.run_program("render", *arguments, "--tf", "tf.json", "-o", "o.png",
                                          "--size", "8")
                self.assertIn("pellucid: 2 values are NaN: rendered as vacuum",
                              result.stderr.decode().splitlines())
                self.assertEqual(result.returncode, 0)
                self.assertEqual(png(self.read("o.png"))[0], 8)
                self.assertEqual(self.report("info", *arguments)["nan"], 2)


class Overwriting(ProgramTest):
    """No output replaces what the same run reads, nor another output of it."""

    def setUp(self):
        super().setUp()
        self.write("good.npy", npy(ramp(4), (4, 4, 4)))
        self.write("tf.json", json.dumps(HAZE))
        self.write("scene.json", json.dumps({"volumes": [{"field": {"file": "good.npy"}}]}))
        os.mkdir(self.path("folder"))
        os.symlink("folder", self.path("also"))
        os.symlink("good.npy", self.path("link.png"))

    def refuse(self, pattern, *arguments):
        self.fail_with(pattern, *arguments, code=2)

    def test_render_keeps_its_inputs(self):
        def refuse(argument, *arguments):
            self.refuse(f"would overwrite the input {argument}", "render", *arguments)
        refuse("--tf tf.json", "good.npy", "--tf", "tf.json", "--save-tf", "tf.json")
        refuse("--tf tf.json", "good.npy", "--tf", "tf.json", "--save-tf", self.path("tf.json"))
        refuse("--tf ", "good.npy", "--tf", "folder/../tf.json", "--save-scene", "./tf.json")
        refuse("--camera c.json", "good.npy", "--camera", "c.json", "--save-tf", "c.json")
        refuse("INPUT scene.json", "scene.json", "--save-scene", "scene.json")
        refuse("INPUT scene.json", "scene.json", "--save-tf", "also/../scene.json")
        refuse("INPUT good.npy", "good.npy", "--save-tf", "good.npy")
        refuse("INPUT good.npy", "good.npy", "-o", "link.png")
        refuse("volume good.npy", "scene.json", "-o", "fine.png", "--save-tf", "good.npy")
        refuse("volume ", "folder/../scene.json", "-o", "link.png")

    def test_render_keeps_its_outputs(self):
        os.symlink("new.png", self.path("dangling.png"))
        for first, second in (("x.png", "x.png"), ("x.png", "./x.png"),
                              ("x.png", self.path("x.png")),
                              ("folder/x.png", "also/x.png"), ("new.png", "dangling.png"),
                              ("dangling.png", "new.png")):
            for option in ("-o", "--depth", "--save-tf", "--save-scene"):
                with self.subTest(first=first, second=second, option=option):
                    self.refuse("twice", "render", "good.npy", "-o", first, option, second)
        self.refuse("twice", "render", "good.npy", "--save-tf", "x.json",
                    "--save-scene", "./x.json")

    def test_evaluate_keeps_its_table(self):
        self.write("t.csv", "id,x\n1,2\n")
        for path in ("t.csv", "./t.csv", self.path("t.csv")):
            self.refuse("would overwrite the input TABLE t.csv", "evaluate", "special_functions",
                        "t.csv", "-o", path)

    def test_compare_keeps_its_images(self):
        self.write("a.exr", exr([[(0.0, 0.0, 0.0, 0.0)]]))
        self.write("b.exr", exr([[(0.0, 0.0, 0.0, 1.0)]]))
        for path in ("a.exr", "./b.exr", self.path("a.exr"), "also/../b.exr"):
            self.refuse("would overwrite the input [AB] ", "compare", "a.exr", "b.exr",
                        "--difference", path)

    def test_other_names_are_free(self):
        self.succeed("render", "good.npy", "-o", "folder/x.png", "-o", "x.png", "--size", "4",
                     "--tf", "tf.json", "--save-tf", "folder/tf.json")
        # A hard link is another name: the input keeps its own.
        os.link(self.path("good.npy"), self.path("hard.png"))
        before = self.read("good.npy")
        self.succeed("render", "good.npy", "-o", "hard.png", "--size", "4")
        self.assertEqual(self.read("good.npy"), before)
        self.assertEqual(png(self.read("hard.png"))[0], 4)


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
