# SPDX-License-Identifier: Apache-2.0
"""Gaussians that `pellucid view` fits while pages look at the scene."""

import json
import signal
import threading
import unittest

from viewer_process import Viewer

FIELD = "builtin:sphere:24"
CHANNELS = ("--channel", "a=builtin:marschner_lobb:40", "--channel", "b=builtin:sphere:40")


class Fits(unittest.TestCase):
    def is_of(self, function):
        def is_wanted(message):
            return (message["type"] == "scene" and
                    message["scene"]["layers"][0]["transfer_function"] == function)
        return is_wanted

    def fitted(self, page):
        """The messages up to the end of a fit."""
        messages = []
        page.receive_until(lambda m: messages.append(m) or
                           m["type"] == "progress" and m["fraction"] == 1)
        return messages

    def test_the_first_function_becomes_the_suggested_one(self):
        with Viewer(*CHANNELS) as viewer, viewer.open_socket() as page:
            page.send(type="suggest", layer=0, kind="gaussians")
            self.fitted(page)
            page.send(type="save", what="scene")
            saved = json.loads(page.receive_type("file")["bytes"])
            wanted = saved["layers"][0]["transfer_function"]
            self.assertGreater(len(wanted["gaussians"]), 3)  # more than the quick ones
        with Viewer(*CHANNELS) as viewer, viewer.open_socket() as page:
            message = page.receive_until(self.is_of(wanted))
            self.assertFalse(message["can_undo"])
            page.exact_frame()

    def test_progress_is_told(self):
        with Viewer(FIELD) as viewer, viewer.open_socket() as page, viewer.open_socket() as other:
            page.exact_frame()
            # A page that answers no ping for half a minute is closed.
            by_other = []
            reader = threading.Thread(target=lambda: by_other.extend(self.fitted(other)))
            reader.start()
            page.send(type="suggest", layer=0, kind="gaussians")
            messages = self.fitted(page)
            reader.join()
            told = [m["fraction"] for m in messages if m["type"] == "progress"]
            self.assertEqual(told[0], 0)
            self.assertGreater(len(told), 2)
            self.assertIn("gaussians", [m for m in messages if m["type"] == "scene"][-1][
                "scene"]["layers"][0]["transfer_function"])
            self.assertGreater(len(by_other), 2)

    def test_an_edit_meanwhile_is_kept(self):
        with Viewer(FIELD) as viewer, viewer.open_socket() as page:
            page.receive_type("scene")
            for gesture in range(1, 9):
                page.send(type="suggest", layer=0, kind="gaussians")
                page.send(type="edit", layer=0, key="transfer_function", gesture=gesture, value={
                    "points": [{"value": 0, "extinction": gesture, "color": "#ff0000"}]})
                self.fitted(page)
            page.send(type="save", what="scene")
            saved = json.loads(page.receive_type("file")["bytes"])
            points = saved["layers"][0]["transfer_function"]["points"]
            self.assertEqual((points[0]["extinction"], points[0]["color"]), (8, [1, 0, 0]))

    def test_a_fit_can_be_cancelled(self):
        with Viewer("builtin:marschner_lobb:96") as viewer, viewer.open_socket() as page:
            page.receive_type("scene")
            for _ in range(5):
                page.send(type="suggest", layer=0, kind="gaussians")
                page.send(type="cancel")
                self.fitted(page)
            page.send(type="cancel")  # nothing goes on
            page.send(type="suggest", layer=0, kind="gaussians")
            scene = [m for m in self.fitted(page) if m["type"] == "scene"][-1]
            self.assertIn("gaussians", scene["scene"]["layers"][0]["transfer_function"])

    def test_a_fit_waits_for_no_frame(self):
        with Viewer("builtin:marschner_lobb:96") as viewer, viewer.open_socket() as page:
            page.send(type="size", width=1200, height=1200)
            page.send(type="tolerance", value=1e-5)
            page.receive_until(lambda m: m["type"] == "frame" and m["width"] == 1200)
            page.send(type="suggest", layer=0, kind="gaussians")
            states = []
            page.receive_until(lambda m: m["type"] == "progress" or
                               m["type"] == "frame" and states.append(m["state"]))
            self.assertNotIn("exact", states)

    def test_it_ends_while_gaussians_are_fitted(self):
        viewer = Viewer("builtin:marschner_lobb:128")
        with viewer.open_socket() as page:
            page.receive_type("scene")
            page.send(type="suggest", layer=0, kind="gaussians")
            status, errors = viewer.stop(signal.SIGINT)
        self.assertEqual(status, 0, errors)


if __name__ == "__main__":
    unittest.main()
