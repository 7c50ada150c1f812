#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The program starts without a driver of NVIDIA, and says what is missing for --device cuda.

  check_program.py PROGRAM BUILT

BUILT is 1 where the program was built with kernels for cards, else 0.
"""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

PROGRAM, BUILT = sys.argv[1], sys.argv[2] == "1"


def render(folder, *arguments):
    command = [PROGRAM, "render", "builtin:marschner_lobb:16", "--size", "8x8", "-o", "out.exr"]
    return subprocess.run([*command, *arguments], cwd=folder, capture_output=True, text=True,
                          check=False)


class Program(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.image = pathlib.Path(self.folder.name) / "out.exr"

    def tearDown(self):
        self.folder.cleanup()

    def render(self, *arguments):
        return render(self.folder.name, *arguments)

    def test_is_linked_to_no_driver(self):
        needed = subprocess.run(["readelf", "-d", PROGRAM], capture_output=True, text=True,
                                check=True).stdout
        self.assertIn("NEEDED", needed)
        self.assertNotIn("libcuda", needed)

    def test_has_kernels_where_it_was_built_with_them(self):
        sections = subprocess.run(["readelf", "-S", "-W", PROGRAM], capture_output=True, text=True,
                                  check=True).stdout
        self.assertEqual(".nv_fatbin" in sections, BUILT)

    def test_renders_on_a_card_or_says_what_is_missing(self):
        done = self.render("--device", "cuda")
        if done.returncode == 0:
            self.assertTrue(BUILT)
            self.assertIn("rendered by ", done.stderr)
            self.assertTrue(self.image.exists())
            return
        self.assertEqual(done.returncode, 1)
        self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
        self.assertFalse(self.image.exists())
        why = ("there is no ",) if BUILT else ("this program was built without it",)
        self.assertTrue(any("error: device cuda: " + text in done.stderr for text in why),
                        done.stderr)

    def test_renders_on_the_cpu(self):
        done = self.render("--device", "cpu", "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(json.loads(done.stdout)["device"], "rendered by the CPU")
        self.assertTrue(self.image.exists())

    def test_emulates_a_card_and_says_so(self):
        done = self.render("--device", "emulated", "--look", "haze", "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(json.loads(done.stdout)["device"],
                         "rendered by the functions of a card, on the CPU")
        told = self.render("--device", "emulated", "--look", "haze").stderr
        self.assertIn("functions of a card", told)

    def test_leaves_to_the_cpu_what_devices_cannot_do(self):
        done = self.render("--device", "emulated", "--projection", "maximum")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("rendered by the CPU: devices cannot do projections yet", done.stderr)

    def test_knows_no_other_device(self):
        done = self.render("--device", "gpu")
        self.assertEqual(done.returncode, 2)
        self.assertFalse(self.image.exists())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
