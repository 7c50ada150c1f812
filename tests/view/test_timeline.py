# SPDX-License-Identifier: Apache-2.0
"""Time of the data, keyframes, and films that are saved, in a real browser."""

import io
import json
import os
import shutil
import signal
import struct
import subprocess
import sys
import time
import unittest
import zipfile

from page_driver import why_not
from test_browser import ACCESS, IN_PAGE, BrowserTest
from program import png
from viewer_process import PROGRAM

TIMES = [0, 0.5, 2]


def write_steps(path, points=9):
    """A .vti whose values are from 0 to 1, from 1 to 2 and from 2 to 3 at the three times."""
    arrays = ""
    for i in range(len(TIMES)):
        values = " ".join(f"{i + (k * 37 % 97) / 97:.4f}" for k in range(points ** 3))
        arrays += (f'<DataArray type="Float32" Name="a" format="ascii" TimeStep="{i}">{values}'
                   "</DataArray>")
    extent = " ".join([f"0 {points - 1}"] * 3)
    with open(path, "w", encoding="ascii") as file:
        file.write(f'<VTKFile type="ImageData"><ImageData WholeExtent="{extent}" Origin="0 0 0" '
                   f'Spacing="1 1 1" TimeValues="{" ".join(map(str, TIMES))}"><Piece Extent='
                   f'"{extent}"><PointData Scalars="a">{arrays}</PointData></Piece></ImageData>'
                   "</VTKFile>")


class TimelineTest(BrowserTest):
    def path(self, name):
        return os.path.join(self.folder, name)

    def program(self, *arguments):
        subprocess.run([PROGRAM, *arguments, "-q"], cwd=self.folder, check=True, timeout=900)

    def program_picture(self, name):
        with open(self.path(name), "rb") as file:
            return png(file.read())

    def move(self, page, slider, value):
        """Moves a slider as a hand does, and waits for the exact picture."""
        before = page.frame()
        page.run("const input = document.getElementById(arguments[0]); input.value = arguments[1];"
                 "input.dispatchEvent(new Event('input'));"
                 "input.dispatchEvent(new Event('change'))", slider, value)
        page.wait_exact(before)

    def number(self, page, name, value):
        page.run("const input = document.querySelector(`[aria-label='${arguments[0]}']`);"
                 "input.value = arguments[1]; input.dispatchEvent(new Event('change'))",
                 name, value)

    def timeline(self, page):
        return page.run("return viewer.timeline")

    def wait_keyframes(self, page, moments):
        page.wait_for(lambda: [round(one["at"], 6) for one in self.timeline(page)["keyframes"]]
                      == moments, f"keyframes at {moments}")

    def key(self, page, key, code, text=None):
        for kind in ("keyDown", "keyUp"):
            page.browser.execute_cdp_cmd("Input.dispatchKeyEvent", {
                "type": kind, "key": key, "windowsVirtualKeyCode": code,
                **({"text": text} if text and kind == "keyDown" else {})})

    def make_keyframes(self, page, with_time):
        """Two keyframes of a film of 8 frames: at 0 s, and at 0.75 s."""
        page.press("#film")
        page.wait_exact(-1)
        self.number(page, "Length of the film in seconds", 1)
        page.wait_for(lambda: self.timeline(page)["seconds"] == 1, "the length")
        self.number(page, "Frames of the film in a second", 8)
        page.wait_for(lambda: self.timeline(page)["frames"] == 8, "the frames")
        if with_time:
            self.move(page, "time", 1)
        page.press_button("Add keyframe")
        self.wait_keyframes(page, [0])
        self.move(page, "moment", 6)
        if with_time:
            self.move(page, "time", 2)
        x, y = page.center("#picture")
        page.wait_exact(page.drag((x, y), (x + 90, y + 30)))
        page.press_button("Add keyframe")
        self.wait_keyframes(page, [0, 0.75])


class Keyframes(TimelineTest):
    def test_a_film(self):
        page = self.open("builtin:shells:24", window=(900, 640))
        self.assertTrue(page.run("return document.getElementById('timeline').hidden"))
        self.make_keyframes(page, False)
        self.move(page, "moment", 3)
        scene = self.check_saved_scene_is_the_frame(page)
        self.assertEqual([key["at"] for key in scene["animation"]["cameras"]], [0, 0.75])
        self.program("animate", "scene.json", "-o", "f/%d.png")
        self.assertEqual(len(os.listdir(self.path("f"))), 8)
        self.check_same(self.program_picture("f/3.png"), page.picture())
        self.assertNotEqual(self.program_picture("f/0.png"), self.program_picture("f/3.png"))

        # The mouse moves a mark, and keys do; a click goes to it; undo takes it back.
        left, top, width, height = page.box("[data-keyframe='1']")
        track = page.box("#moment")[2]
        x, y = left + width / 2, top + height / 2
        page.wait_exact(page.drag((x, y), (x - 2 * (track - 16) / 7, y)))
        self.wait_keyframes(page, [0, 0.5])
        self.assertEqual(self.timeline(page)["keyframe"], 1)
        page.run("document.querySelector('[data-keyframe=\"1\"]').focus()")
        self.key(page, "ArrowRight", 39)
        self.wait_keyframes(page, [0, 0.625])
        page.wait_for(lambda: page.run("return document.activeElement.dataset.keyframe") == "1",
                      "the focus to stay")
        page.press("#undo")
        self.wait_keyframes(page, [0, 0.5])
        before = page.frame()
        page.click(*page.center("[data-keyframe='0']"))
        page.wait_exact(before)
        self.assertEqual(self.timeline(page)["frame"], 0)
        page.run("document.querySelector('[data-keyframe=\"1\"]').focus()")
        self.key(page, "Delete", 46)
        self.wait_keyframes(page, [0])
        page.press("#undo")
        self.wait_keyframes(page, [0, 0.5])

        # A turntable takes their place; a keyframe keeps its turn.
        page.wait_exact(page.press_button("Turntable"))
        page.press_button("Add keyframe")
        self.wait_keyframes(page, [0, 0.25, 0.5, 0.75, 1])
        page.press("#undo")
        page.wait_for(lambda: self.timeline(page)["turns"] == 1, "the turntable")
        self.move(page, "moment", 2)
        self.assertIn("goes around once", page.text("#timeline .hint"))
        scene = self.scene(page)
        self.assertNotIn("cameras", scene["animation"])
        self.program("animate", "scene.json", "-o", "g/%d.png")
        self.check_same(self.program_picture("g/2.png"), page.picture())
        page.press_button("Remove film")
        page.wait_for(lambda: not self.timeline(page)["has_film"], "no film")
        self.assertNotIn("animation", self.scene(page))
        self.assertEqual(page.complaints(), [])

    def test_keys_at_a_mark(self):
        page = self.open("builtin:shells:16", window=(900, 640))
        self.make_keyframes(page, False)

        def focused():
            return page.run("return document.activeElement.dataset.keyframe")

        # A move onto the neighbour is refused, and all stays: the focus, the moment, and the marks.
        self.move(page, "moment", 2)
        page.press_button("Add keyframe")
        self.wait_keyframes(page, [0, 0.25, 0.75])
        page.run("document.querySelector('[data-keyframe=\"0\"]').focus();"
                 "window.errors = 0; viewer.connection.on('error', () => ++window.errors)")
        self.key(page, "ArrowRight", 39)
        self.wait_keyframes(page, [0.125, 0.25, 0.75])
        page.wait_for(lambda: self.timeline(page)["frame"] == 1, "the moment")
        self.key(page, "ArrowRight", 39)
        page.wait_for(lambda: page.run("return window.errors") == 1, "the refusal")
        time.sleep(0.5)
        self.assertEqual(focused(), "0")
        self.assertEqual(self.timeline(page)["frame"], 1)
        self.key(page, "ArrowLeft", 37)
        self.wait_keyframes(page, [0, 0.25, 0.75])
        self.assertEqual(focused(), "0")

        # Quick presses all move the same one, also past another.
        page.run("const mark = document.querySelector('[data-keyframe=\"1\"]'); mark.focus();"
                 "for (let i = 0; i < 5; ++i) document.activeElement.dispatchEvent("
                 "new KeyboardEvent('keydown', {key: 'ArrowRight', bubbles: true}))")
        self.wait_keyframes(page, [0, 0.75, 0.875])
        page.wait_for(lambda: focused() == "2", "the focus to follow")
        page.wait_for(lambda: self.timeline(page)["frame"] == 7, "the moment to follow")
        self.assertEqual(page.complaints(), [])

    def test_choosing_by_a_mark(self):
        page = self.open("builtin:shells:16", window=(900, 640))
        self.make_keyframes(page, False)

        def chosen():
            return page.run("return [...document.querySelectorAll('.mark[aria-pressed=true]')]"
                            ".map((one) => one.dataset.keyframe).join()")

        # One at the very end, where no frame is, and one at the last frame stand at one place.
        scene = self.scene(page)
        scene["animation"]["cameras"][0]["at"] = 0.875
        scene["animation"]["cameras"][1]["at"] = 1
        scene["animation"]["cameras"].insert(0, {**scene["animation"]["cameras"][0], "at": 0})
        with open(self.path("end.json"), "w", encoding="ascii") as file:
            json.dump(scene, file)
        page.browser.quit()
        page = self.open("end.json", window=(900, 640))
        self.wait_keyframes(page, [0, 0.875, 1])
        page.click(*page.center("[data-keyframe='2']"))
        page.wait_for(lambda: chosen() == "2", "the one that was clicked")
        self.assertIn("Keyframe 3 of 3, at 1 s", page.text("#timeline"))
        # The other one stands above or below it.
        page.click(*page.center("[data-keyframe='1']"))
        page.wait_for(lambda: chosen() == "1", "the other one")
        page.click(*page.center("[data-keyframe='2']"))
        page.wait_for(lambda: chosen() == "2", "the first one again")
        page.run("document.querySelector('[data-keyframe=\"1\"]').focus()")
        self.key(page, "Enter", 13)
        page.wait_for(lambda: chosen() == "1", "the other one")
        page.run("document.querySelector('[data-keyframe=\"2\"]').focus()")
        self.key(page, "Enter", 13)
        page.wait_for(lambda: chosen() == "2", "the first one again")
        page.press_button("Delete keyframe")
        self.wait_keyframes(page, [0, 0.875])
        page.press("#undo")
        self.wait_keyframes(page, [0, 0.875, 1])

        # A number that cannot be gives way to the one before, with a sentence.
        for wrong in ("", "-5"):
            self.number(page, "Length of the film in seconds", wrong)
            self.assertIn("give a number from 0.001 to 86400", page.text("#timeline .hint"))
            self.assertEqual(page.run("return document.querySelector("
                                      "'[aria-label=\"Length of the film in seconds\"]').value"),
                             "1")
        self.assertEqual(page.complaints(), [])

    def test_marks_beside_each_other(self):
        page = self.open("builtin:shells:16", window=(390, 844))
        page.wait_exact(page.press("#film"))
        page.press_button("Add keyframe")
        self.wait_keyframes(page, [0])
        self.assertIn("the film does not go around any more", page.text("#timeline .hint"))
        moments = [0]
        for frame in (1, 2, 3, 60):
            self.move(page, "moment", frame)
            page.press_button("Add keyframe")
            moments.append(round(frame / 24, 6))
            self.wait_keyframes(page, moments)
        self.assertNotIn("any more", page.text("#timeline .hint"))

        def boxes():
            return page.run("return [...document.querySelectorAll('.mark')].map((one) =>"
                            "{const {left, top} = one.getBoundingClientRect();"
                            "return [left, top]; })")
        marks = boxes()
        self.assertEqual(len({round(top) for _, top in marks}), 3)
        self.assertEqual(round(marks[0][1]), round(marks[4][1]))
        for i, (left, top) in enumerate(marks[:3]):
            for other_left, other_top in marks[:i]:
                self.assertTrue(abs(left - other_left) >= 23 or abs(top - other_top) >= 23)
        # Four in 6 pixels: the last one lies over another, and each is reached by clicks.
        reached = set()
        for i in range(4):
            for _ in range(2):
                page.click(*page.center(f"[data-keyframe='{i}']"))
                time.sleep(0.3)
                reached.add(page.run("return viewer.line.marks.chosen()"))
        self.assertEqual(reached, {0, 1, 2, 3})
        self.assertLessEqual(page.run("return document.documentElement.scrollWidth"), 390)
        self.assertEqual(page.complaints(), [])

    def test_playing(self):
        page = self.open("builtin:shells:16", window=(900, 600))
        self.make_keyframes(page, False)
        page.run("window.seen = new Set(); viewer.connection.on('scene',"
                 "({timeline}) => window.seen.add(timeline.frame));"
                 "document.getElementById('moment').focus()")
        self.key(page, " ", 32, " ")
        page.wait_for(lambda: page.run("return window.seen.size") >= 3, "three frames")
        self.assertTrue(page.run("return viewer.line.frames.isPlaying"))
        before = page.frame()
        self.key(page, " ", 32, " ")
        page.wait_for(lambda: not page.run("return viewer.line.frames.isPlaying"), "a pause")
        page.wait_exact(before - 1)
        self.check_saved_scene_is_the_frame(page)
        self.assertEqual(page.complaints(), [])

    def test_phone_and_screen_readers(self):
        page = self.open("builtin:shells:16", window=(390, 844))
        page.wait_exact(page.press("#film"))
        page.press_button("Add keyframe")
        self.wait_keyframes(page, [0])
        page.press_button("Save the film…")
        for dark in ("light", "dark"):
            page.browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [
                {"name": "prefers-color-scheme", "value": dark}]})
            self.assertEqual(page.run(ACCESS), [], dark)
        self.assertLessEqual(page.run("return document.documentElement.scrollWidth"), 390)
        self.assertEqual(page.run("""
            return [...document.querySelectorAll('button, input, select')].filter((one) =>
              one.checkVisibility() && one.getBoundingClientRect().right > 390)
              .map((one) => one.outerHTML.slice(0, 80));"""), [])
        self.assertGreater(page.box("#picture")[3], 250)
        if IN_PAGE:
            self.assertIn("pellucid animate scene.json", page.text("#film-saver"))
            self.assertEqual(page.run("return document.querySelectorAll('#film-saver select')"
                                      ".length"), 0)


@unittest.skipIf(IN_PAGE, "a page has the data of one time, and no program that saves films")
class Films(TimelineTest):
    def setUp(self):
        super().setUp()
        write_steps(self.path("s.vti"))

    def files(self):
        return {name for name in os.listdir(self.folder) if name.startswith("film.")}

    def save_film(self, page, width, height, film_format):
        if page.run("return document.getElementById('film-saver').hidden"):
            page.press_button("Save the film…")
        self.number(page, "Width of the film in pixels", width)
        self.number(page, "Height of the film in pixels", height)
        self.number(page, "Tolerance of the film", 0.01)
        self.number(page, "Format of the film", film_format)
        page.press("[aria-label='Begin to save the film']")

    def test_steps_of_time(self):
        page = self.open("s.vti", window=(900, 560))
        self.assertFalse(page.run("return document.getElementById('timeline').hidden"))
        self.assertIn("step 1 of 3", page.text("#timeline"))
        self.assertNotIn("left out", page.text("#timeline"))
        first = page.picture()
        self.move(page, "time", 2)
        self.assertIn("2 · step 3 of 3", page.text("#timeline"))
        scene = self.check_saved_scene_is_the_frame(page)
        self.assertEqual(scene["time"], 2)
        self.assertNotEqual(first, page.picture())
        # The program's picture of this step alone.
        del scene["time"]
        scene["layers"][0]["field"]["time"] = 2
        with open(self.path("scene.json"), "w", encoding="ascii") as file:
            json.dump(scene, file)
        self.program("render", "scene.json", "-o", "step.png")
        self.assertEqual(self.program_picture("step.png"), page.picture())
        # Slices show it too, and the keyboard moves it.
        page.wait_exact(page.press("#four"))

        def least():
            return page.run("const {slice, isAsked, isStale} = viewer.views.slices[0];"
                            "return slice && !isAsked && !isStale ? "
                            "Math.min(...slice.numbers.filter((one) => !isNaN(one))) : -1")
        page.wait_for(lambda: 2 <= least() < 3, "slices of the third step")
        page.run("document.getElementById('time').focus()")
        before = page.frame()
        self.key(page, "ArrowLeft", 37)
        page.wait_exact(before)
        self.assertEqual(self.timeline(page)["time"], 0.5)
        page.wait_for(lambda: 1 <= least() < 2, "slices of the second step")
        self.assertEqual(page.complaints(), [])

    def test_units_and_times_that_no_scene_names(self):
        with open(self.path("s.vti"), encoding="ascii") as file:
            text = file.read()
        with open(self.path("far.vti"), "w", encoding="ascii") as file:
            file.write(text.replace('TimeValues="0 0.5 2"', 'TimeValues="0 0.5 1e300"'))
        page = self.open("far.vti", window=(900, 560))
        self.assertIn("step 1 of 2 (1 left out)", page.text("#timeline"))
        self.move(page, "time", 1)
        self.assertEqual(self.timeline(page)["time"], 0.5)
        self.assertEqual(page.complaints(), [])
        page.browser.quit()
        self.viewer.stop()
        import numpy
        header = bytearray(352)
        struct.pack_into("<i", header, 0, 348)
        struct.pack_into("<8h", header, 40, 4, 8, 8, 8, 3, 1, 1, 1)
        struct.pack_into("<2h", header, 70, 16, 32)
        struct.pack_into("<8f", header, 76, 1, 1, 1, 1, 2, 0, 0, 0)
        struct.pack_into("<f", header, 108, 352)
        header[123] = 2 | 8  # mm and s
        header[344:348] = b"n+1\0"
        with open(self.path("s.nii"), "wb") as file:
            file.write(header + numpy.linspace(0, 1, 3 * 512, dtype=numpy.float32).tobytes())
        page = self.open("s.nii", window=(900, 560))
        self.move(page, "time", 1)
        self.assertIn("2 s · step 2 of 3", page.text("#timeline"))

    def test_the_first_keyframe_keeps_the_steps(self):
        page = self.open("s.vti", window=(860, 600))
        page.wait_exact(page.press("#film"))
        page.press_button("Add keyframe")
        self.wait_keyframes(page, [0])
        self.assertIn("still shows each step of time", page.text("#timeline .hint"))
        self.move(page, "moment", 119)
        self.assertEqual(self.timeline(page)["time"], 2)

    def test_keyframes_move_the_time(self):
        page = self.open("s.vti", window=(860, 600))
        self.make_keyframes(page, True)
        self.move(page, "moment", 3)
        self.assertEqual(self.timeline(page)["time"], 1.25)
        scene = self.check_saved_scene_is_the_frame(page)
        self.assertEqual(scene["animation"]["tracks"], [
            {"target": "/time", "easing": "linear",
             "keys": [{"at": 0, "value": 0.5}, {"at": 0.75, "value": 2}]}])
        self.program("animate", "scene.json", "-o", "f/%d.png")
        self.assertEqual(self.program_picture("f/3.png"), page.picture())
        self.assertNotEqual(self.program_picture("f/6.png"), page.picture())

        # The saved pictures are those of the program, to the bit.
        self.save_film(page, 48, 36, "zip")
        page.wait_for(lambda: self.files() == {"film.zip"}, "film.zip")
        time.sleep(0.3)
        self.program("animate", "scene.json", "-o", "small/%04d.png", "--size", "48x36",
                     "--tolerance", "0.01")
        with open(self.path("film.zip"), "rb") as file, \
                zipfile.ZipFile(io.BytesIO(file.read())) as archive:
            self.assertEqual(archive.namelist(), sorted(os.listdir(self.path("small"))))
            self.assertEqual(len(archive.namelist()), 8)
            for name in archive.namelist():
                self.assertEqual(png(archive.read(name)), self.program_picture(f"small/{name}"))
        page.wait_for(lambda: "saved" in page.text("#film-saver"), "the end")

        # Another program opens it again, at the step that was shown.
        self.viewer.stop()
        page.browser.quit()
        again = self.open("scene.json", window=(860, 600))
        self.wait_keyframes(again, [0, 0.75])
        self.assertEqual(again.run("return document.querySelectorAll('.mark').length"), 2)
        self.assertEqual(self.timeline(again)["time"], 0.5)
        self.move(again, "moment", 6)
        self.assertEqual(self.timeline(again)["time"], 2)

    @unittest.skipIf(shutil.which("ffmpeg") is None, "ffmpeg is not installed")
    def test_a_video_and_one_that_is_cancelled(self):
        page = self.open("s.vti", window=(860, 600))
        page.wait_exact(page.press("#film"))
        page.press_button("Save the film…")
        self.save_film(page, 32, 24, "webm")  # without keyframes: a frame of each step
        page.wait_for(lambda: self.files() == {"film.webm"}, "film.webm")
        page.wait_for(lambda: "saved" in page.text("#film-saver"), "the end")
        time.sleep(0.3)
        with open(self.path("film.webm"), "rb") as file:
            self.assertEqual(file.read(4), b"\x1a\x45\xdf\xa3")
        frames = subprocess.run(
            ["ffprobe", "-v", "error", "-count_frames", "-show_entries",
             "stream=nb_read_frames,width,height", "-of", "csv=p=0", "film.webm"],
            cwd=self.folder, check=True, capture_output=True, text=True, timeout=100).stdout
        self.assertEqual(frames.strip(), "32,24,3")
        os.remove(self.path("film.webm"))

        self.save_film(page, 3000, 3000, "mp4")
        page.wait_for(lambda: "Frame 1 of 3" in page.text("#film-saver"), "the progress")
        page.press_button("Cancel the film")
        page.wait_for(lambda: "cancelled; no file is left" in page.text("#film-saver"), "the end")
        self.assertEqual(self.files(), set())
        self.assertEqual(page.text("#message"), "the film was cancelled; no file is left of it")

    def fake_ffmpeg(self, check, encode):
        """A program of this name that does what it is told, in front of PATH."""
        os.mkdir(self.path("bin"))
        with open(self.path("bin/ffmpeg"), "w", encoding="ascii") as file:
            # The number is there at once or not at all: the program may be killed at any line.
            file.write(f'#!/bin/sh\ncase "$*" in *lavfi*) {check} ;; esac\n'
                       f'echo $$ > {self.path("number")}\n'
                       f'mv {self.path("number")} {self.path("pid")}\n{encode}\n')
        os.chmod(self.path("bin/ffmpeg"), 0o755)
        return {**os.environ, "PATH": self.path("bin") + ":" + os.environ["PATH"]}

    def start_with(self, environment, *arguments):
        before = dict(os.environ)
        try:
            os.environ.update(environment)
            return self.start(*arguments)
        finally:
            os.environ.clear()
            os.environ.update(before)

    def wait_for_encoder(self):
        deadline = time.monotonic() + 60
        while not os.path.exists(self.path("pid")):
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.05)

    def encoder_runs(self):
        with open(self.path("pid"), encoding="ascii") as file:
            return os.path.exists("/proc/" + file.read().strip())

    def wait_for_end_of_encoder(self):
        """A process that was killed is there until the system has taken its memory."""
        deadline = time.monotonic() + 5
        while self.encoder_runs() and time.monotonic() < deadline:
            time.sleep(0.01)
        self.assertFalse(self.encoder_runs())

    def begin(self, viewer, film_format, edge):
        socket = viewer.open_socket()
        self.addCleanup(socket.connection.close)
        socket.send(type="size", width=40, height=30)
        socket.receive_type("scene")
        socket.send(type="save_film", width=edge, height=edge, tolerance=0.01, format=film_format)
        return socket

    def test_an_encoder_is_ended(self):
        viewer = self.start_with(self.fake_ffmpeg("exit 0", "exec sleep 100"), "s.vti")
        socket = self.begin(viewer, "webm", 16)

        def encodes(message):
            return message["type"] == "film_progress" and message["frame"] > message["frames"]
        socket.receive_until(encodes)
        self.wait_for_encoder()
        began = time.monotonic()
        socket.send(type="cancel_film")
        self.assertIn("cancelled", socket.receive_type("film_ended")["failure"])
        self.wait_for_end_of_encoder()
        os.remove(self.path("pid"))
        socket.send(type="save_film", width=16, height=16, tolerance=0.01, format="webm")
        socket.receive_until(encodes)
        self.wait_for_encoder()
        # Another file does not wait for it, nor does Ctrl-C.
        socket.send(type="open", input="builtin:shells:8")
        socket.receive_type("opened")
        socket.receive_type("scene")
        socket.send(type="save_film", width=16, height=16, tolerance=0.05, format="webm")
        socket.receive_type("film_progress")
        viewer.stop()
        self.assertLess(time.monotonic() - began, 60)
        self.wait_for_end_of_encoder()

    def test_ctrl_c_while_the_program_encodes(self):
        environment = self.fake_ffmpeg(
            "exit 0", "for last; do :; done\n"
            f'echo part > "${{last#file:}}"; touch {self.path("encodes")}; exec sleep 100')
        process = subprocess.Popen(
            [PROGRAM, "animate", "builtin:shells:8", "-o", "film.webm", "--size", "16",
             "--frames", "2", "-q"], cwd=self.folder, env=environment, stderr=subprocess.DEVNULL)
        try:
            deadline = time.monotonic() + 60
            while not os.path.exists(self.path("encodes")):
                self.assertLess(time.monotonic(), deadline)
                time.sleep(0.05)
            process.send_signal(signal.SIGINT)
            self.assertNotEqual(process.wait(timeout=30), 0)
        finally:
            process.kill()
        self.wait_for_end_of_encoder()
        self.assertEqual({name for name in os.listdir(self.folder) if "film" in name},
                         {"film.webm.frames"})

    def test_the_file_goes_to_a_page_that_is_there(self):
        viewer = self.start("s.vti")
        first = self.begin(viewer, "zip", 900)
        first.receive_type("film_progress")
        first.connection.close()
        with viewer.open_socket() as second:
            second.receive_type("film_progress")
            page = second.receive_type("film_ended")
            self.assertEqual(page["failure"], "")
            self.assertEqual(second.receive_type("file")["bytes"][:2], b"PK")
        # That page went without saying that it has the file.
        with viewer.open_socket() as third:
            self.assertEqual(third.receive_type("file")["name"], "film.zip")
            third.send(type="film_taken")
            third.send(type="size", width=40, height=30)
            third.exact_frame()
        with viewer.open_socket() as fourth:
            fourth.send(type="size", width=42, height=30)
            seen = []
            fourth.receive_until(lambda message: seen.append(message["type"]) or
                                 message["type"] == "frame")
            self.assertNotIn("file", seen)
        # Nobody is there when it ends.
        last = self.begin(viewer, "zip", 30)
        last.receive_type("film_progress")
        last.connection.close()
        time.sleep(3)
        with viewer.open_socket() as again:
            self.assertEqual(again.receive_type("file")["name"], "film.zip")

    def test_reloaded_and_lost(self):
        viewer = self.start("s.vti")
        page = self.show(viewer, window=(860, 600))
        page.wait_exact(page.press("#film"))
        page.press_button("Save the film…")
        self.number(page, "Width of the film in pixels", "")
        self.assertIn("give a number from 1 to 8192", page.text("#film-saver"))
        self.save_film(page, 3000, 3000, "zip")
        self.assertTrue(page.run("return [...document.querySelectorAll('button')].find((one) =>"
                                 "one.textContent === 'Cancel the film').checkVisibility()"))
        page.wait_for(lambda: "Frame 1 of 3" in page.text("#film-saver"), "the progress")
        # The panel can be closed meanwhile.
        page.press_button("Save the film…")
        time.sleep(1)
        self.assertTrue(page.run("return document.getElementById('film-saver').hidden"))

        page.browser.refresh()
        page.wait_for(lambda: "of 3" in page.text("#film-saver"), "the progress again")
        page.press_button("Cancel the film")
        page.wait_for(lambda: "cancelled; no file is left" in page.text("#film-saver"), "the end")
        page.wait_for(lambda: not page.run("return document.querySelector('[aria-label=\""
                                           "Begin to save the film\"]').disabled"), "the button")
        self.save_film(page, 3000, 3000, "zip")
        page.wait_for(lambda: "Frame 1 of 3" in page.text("#film-saver"), "the progress")
        os.kill(viewer.program(), signal.SIGKILL)
        page.wait_for(lambda: "connection was lost, and no film came" in page.text("#film-saver"),
                      "what happened")
        self.assertNotIn("is saved", page.text("#film-saver"))
        self.assertEqual(self.files(), set())

    def test_a_failure_at_once(self):
        environment = self.fake_ffmpeg("echo no such encoder >&2; exit 1", "exit 1")
        page = self.show(self.start_with(environment, "s.vti"), window=(860, 600))
        page.wait_exact(page.press("#film"))
        page.press_button("Save the film…")
        self.save_film(page, 20, 20, "webm")
        page.wait_for(lambda: "cannot encode it: no such encoder" in page.text("#film-saver"),
                      "the reason")
        self.assertIn("no such encoder", page.text("#message"))

    def test_without_ffmpeg(self):
        os.mkdir(self.path("bin"))
        os.symlink(shutil.which("timeout"), self.path("bin/timeout"))
        paths = os.environ["PATH"]
        try:
            os.environ["PATH"] = self.path("bin")
            viewer = self.start("s.vti")
        finally:
            os.environ["PATH"] = paths
        page = self.show(viewer, window=(860, 600))
        page.wait_exact(page.press("#film"))
        page.press_button("Save the film…")
        self.assertEqual(page.run("return [...document.querySelectorAll('#film-saver option')]"
                                  ".map((one) => one.value)"), ["zip"])
        self.assertIn("need the program ffmpeg", page.text("#film-saver"))


if __name__ == "__main__":
    reason = why_not()
    if reason:
        print(f"skipped: {reason} (scripts/install-packages browser)")
        sys.exit(77)
    if IN_PAGE and not os.path.exists(os.environ["PELLUCID_PAGE"]):
        print("skipped: there is no page; scripts/build-web builds it")
        sys.exit(77)
    unittest.main(verbosity=2)
