# SPDX-License-Identifier: Apache-2.0
"""The program that scripts/demo builds first: its pictures, and its errors for what it lacks."""

import array
import os
import shutil
import struct
import subprocess
import tempfile
import unittest

WHOLE = os.environ["PELLUCID_PROGRAM"]
FIRST = os.environ["PELLUCID_FIRST_PROGRAM"]
EXAMPLES = os.path.join(os.environ["PELLUCID_SOURCE_DIR"], "examples")
LEFT_OUT = ("is not in this program, which was built for a first picture; 'scripts/demo' or "
            "'cmake --preset release && cmake --build --preset release' builds all of it\n")


class FirstPicture(unittest.TestCase):
    """Each test has a folder of its own, which is the working folder of the programs."""

    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="pellucid_first_")
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def write(self, name, content):
        with open(os.path.join(self.folder, name), "wb") as file:
            file.write(content)

    def run_program(self, program, *arguments):
        return subprocess.run([program, *arguments], cwd=self.folder, stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, timeout=3600, check=False)

    def picture(self, program, *arguments):
        result = self.run_program(program, "render", *arguments, "-o", "picture.png", "--quiet")
        self.assertEqual(result.returncode, 0, result.stderr.decode(errors="replace"))
        with open(os.path.join(self.folder, "picture.png"), "rb") as file:
            return file.read()

    def assert_same_picture(self, *arguments):
        with self.subTest(arguments=arguments):
            arguments += ("--size", "64x64")
            self.assertEqual(self.picture(FIRST, *arguments), self.picture(WHOLE, *arguments))

    def assert_left_out(self, what, *arguments):
        with self.subTest(arguments=arguments):
            result = self.run_program(FIRST, *arguments)
            self.assertEqual(result.returncode, 1)
            self.assertEqual(result.stderr.decode(), f"pellucid: error: {what} {LEFT_OUT}")

    def test_pictures_of_the_demo(self):
        for name in ("marschner_lobb", "hydrogen", "shells"):
            self.assert_same_picture(os.path.join(EXAMPLES, name + ".json"))

    def test_pictures_of_files(self):
        side = 24
        values = array.array("h", (i * 37 % 1000 for i in range(side ** 3)))
        header = f"{{'descr': '<i2', 'fortran_order': False, 'shape': ({side}, {side}, {side})}}"
        header = (header.ljust(117) + "\n").encode()
        self.write("values.npy", b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header +
                   values.tobytes())
        nifti = bytearray(352)
        struct.pack_into("<i", nifti, 0, 348)
        struct.pack_into("<8h", nifti, 40, 3, side, side, side, 1, 1, 1, 1)
        struct.pack_into("<hh", nifti, 70, 4, 16)  # int16
        struct.pack_into("<8f", nifti, 76, 1, 1, 1, 1, 1, 1, 1, 1)
        struct.pack_into("<fff", nifti, 108, 352, 1, 0)
        nifti[344:348] = b"n+1\0"
        self.write("values.nii", bytes(nifti) + values.tobytes())
        self.write("values.raw", values.tobytes())
        points = b'{"pellucid": 1, "transfer_function": {"type": "piecewise_linear", "points": [' \
                 b'{"value": 0, "extinction": 0.01, "color": [1, 0, 0]}, ' \
                 b'{"value": 999, "extinction": 0.2, "color": [0, 0, 1]}]}}'
        self.write("tf.json", points)
        shape = ("--dimensions", f"{side},{side},{side}", "--type", "i16")
        self.assert_same_picture("values.npy", "--tf", "tf.json")
        self.assert_same_picture("values.nii", "--tf", "tf.json")
        self.assert_same_picture("values.raw", "--tf", "tf.json", *shape)

    def test_light_and_surfaces_take_the_general_path(self):
        for arguments in (("--shading", "on"), ("--iso", "0.5")):
            with self.subTest(arguments=arguments):
                picture = self.picture(FIRST, "builtin:shells:20", *arguments, "--size", "32x32")
                self.assertGreater(len(picture), 80)

    def test_commands_left_out(self):
        result = self.run_program(WHOLE, "--help").stdout.decode()
        listed = result.split("Subcommands:\n")[1].split("\n\n")[0]
        commands = [line.split()[0] for line in listed.splitlines()
                    if line.startswith("  ") and not line.startswith("   ")]
        self.assertIn("view", commands)
        for command in commands:
            if command != "render":
                self.assert_left_out(f"the command {command}", command, "file", "--any-option")

    def test_formats_left_out(self):
        self.write("a.nrrd", b"NRRD0004\n")
        self.write("a.vtu", b"<VTKFile>")
        for name in ("a.nrrd", "a.vtu", "."):
            self.assert_left_out(
                f"{name}: what reads it (read are .nii .nii.gz .hdr .hdr.gz .img .img.gz .npy .raw "
                ".raw.gz)", "render", name, "-o", "picture.png")

    def test_options_left_out(self):
        scene = ("render", "builtin:shells:20", "--size", "8x8", "-o", "picture.png")
        self.assert_left_out("--reference: the reference renderer", *scene, "--reference")
        self.assert_left_out("--ranks: what runs on ranks", *scene, "--ranks")
        self.assert_left_out("what projects layers", *scene, "--projection", "maximum")
        self.assert_left_out("what samples rays", *scene, "--method", "midpoint")
        self.assert_left_out("what renders on devices", *scene, "--device", "emulated")


if __name__ == "__main__":
    unittest.main()
