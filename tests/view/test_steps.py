# SPDX-License-Identifier: Apache-2.0
"""The function that `pellucid view` chooses from all steps in time, while the first is shown."""

import json
import os
import struct
import subprocess
import tempfile
import unittest

from viewer_process import PROGRAM, Viewer

SIDE = 8
TOPS = (1, 2, 200, 4)


class Steps(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        # The fourth axis of NIfTI is time; the values of a step go up to one of TOPS.
        head = bytearray(352)
        struct.pack_into("<i", head, 0, 348)
        struct.pack_into("<8h", head, 40, 4, SIDE, SIDE, SIDE, len(TOPS), 1, 1, 1)
        struct.pack_into("<2h", head, 70, 16, 32)
        struct.pack_into("<8f", head, 76, 1, 1, 1, 1, 1, 1, 1, 1)
        struct.pack_into("<f", head, 108, 352)
        struct.pack_into("<f", head, 112, 1)
        head[123] = 2 | 8
        head[344:348] = b"n+1\0"
        count = SIDE ** 3
        values = [top * i / (count - 1) for top in TOPS for i in range(count)]
        self.write("run.nii", bytes(head) + struct.pack(f"<{len(values)}f", *values))

    def write(self, name, data):
        with open(os.path.join(self.folder, name), "wb") as file:
            file.write(data)

    def run_program(self, *arguments):
        return subprocess.run([PROGRAM, *arguments], cwd=self.folder, check=True,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE).stdout

    def function(self, *more):
        """The function of a picture of one step, which is that of all of them."""
        text = self.run_program("render", "run.nii", "--time", "1", "--print-tf", *more)
        said = json.loads(text)
        return said.get("transfer_function", said)["points"]

    def top(self, message):
        function = message["scene"]["layers"][0].get("transfer_function")
        return function["points"][-1]["value"] if function else 0

    def wait_for_all_steps(self, page, top=100):
        return page.receive_until(lambda m: m["type"] == "scene" and self.top(m) > top)

    def points(self, page):
        page.send(type="save", what="scene")
        saved = json.loads(page.receive_type("file")["bytes"])
        return saved["layers"][0]["transfer_function"]["points"]

    def view(self, *more):
        return Viewer("run.nii", *more, folder=self.folder)

    def test_is_that_of_a_picture(self):
        with self.view("--look", "haze") as viewer, viewer.open_socket() as page:
            message = self.wait_for_all_steps(page)
            self.assertFalse(message["can_undo"])
            page.exact_frame()
            chosen = self.function("--look", "haze")
            self.assertEqual(self.points(page), chosen)
            # It stays at another time.
            page.send(type="scene_time", time=2)
            page.exact_frame()
            self.assertEqual(self.points(page), chosen)

    def test_a_suggested_curve_is_of_all_steps(self):
        with self.view("--look", "haze") as viewer, viewer.open_socket() as page:
            self.wait_for_all_steps(page)
            chosen = self.function()
            red = {"points": [{"value": 0, "extinction": 1, "color": "#ff0000"}]}
            page.send(type="edit", layer=0, key="transfer_function", gesture=1, value=red)
            page.receive_until(lambda m: m["type"] == "scene" and self.top(m) == 0)
            page.send(type="suggest", layer=0, kind="curve")
            self.wait_for_all_steps(page)
            self.assertEqual(self.points(page), chosen)
            page.send(type="undo")
            page.receive_until(lambda m: m["type"] == "scene" and self.top(m) == 0)
            page.send(type="redo")
            self.wait_for_all_steps(page)
            self.assertEqual(self.points(page), chosen)

    def test_what_was_given_stays(self):
        given = {"points": [{"value": 0, "extinction": 0, "color": [1, 1, 1]},
                            {"value": 2, "extinction": 1, "color": [1, 1, 1]}]}
        self.write("tf.json", json.dumps(given).encode())
        with self.view("--tf", "tf.json") as viewer, viewer.open_socket() as page:
            page.exact_frame()
            page.send(type="scene_time", time=2)
            page.exact_frame()
            self.assertEqual(self.points(page), given["points"])

    def test_a_step_that_cannot_be_read_is_told(self):
        header = b"{'descr': '|u1', 'fortran_order': False, 'shape': (8, 8, 8)}"
        head = b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header
        for i in range(3):
            values = bytes(k * (i + 1) % 250 for k in range(SIDE ** 3))
            self.write(f"s{i}.npy", head + (values if i < 2 else values[:-9]))
        with Viewer("s%d.npy", folder=self.folder) as viewer, viewer.open_socket() as page:
            message = page.receive_type("error")
            self.assertIn("the step at time 2 does not count", message["message"])
            self.assertIn("s2.npy", message["message"])
            page.exact_frame()


if __name__ == "__main__":
    unittest.main()
