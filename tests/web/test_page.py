# SPDX-License-Identifier: Apache-2.0
"""Pages that are one file, opened from disk in a real browser."""

import json
import os
import re
import subprocess
import sys
import tempfile
import unittest

SOURCE_DIR = os.environ.get("PELLUCID_SOURCE_DIR", os.path.join(os.path.dirname(__file__), "../.."))
for folder in ("view", "cli"):
    sys.path.insert(0, os.path.join(SOURCE_DIR, "tests", folder))
from page_driver import Page, why_not  # noqa: E402
from program import png  # noqa: E402
from viewer_process import PROGRAM  # noqa: E402

# An empty page of the build, where there is one.
EMPTY = os.environ.get("PELLUCID_PAGE", "")


class File:
    """A page on disk, in the place of a program's."""

    def __init__(self, path):
        self.address = "file://" + os.path.abspath(path)


class PageTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="pellucid_web_", ignore_cleanup_errors=True)
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def path(self, name):
        return os.path.join(self.folder, name)

    def run_program(self, *arguments):
        return subprocess.run([PROGRAM, *arguments], cwd=self.folder, check=True, timeout=900,
                              capture_output=True, text=True)

    def export(self, *arguments):
        self.run_program("export", *arguments, "-o", "page.html", "-q")
        return self.path("page.html")

    def open(self, path, **options):
        return self.open_page(File(path), **options)

    def open_page(self, viewer, **options):
        page = Page(viewer, self.folder, **options)
        self.addCleanup(page.browser.quit)
        return page

    def scene(self, page):
        return json.loads(page.saved("Scene, JSON", "scene.json"))

    def save_data(self, page, name):
        """Saves a file that is embedded, beside the page."""
        page.saved(page.run("return [...document.querySelectorAll('button')].map((one) => "
                            "one.textContent).find((text) => text.startsWith(arguments[0]))",
                            f"Data, {name}"), name)

    def check_frame(self, page, most):
        """The program's picture of the saved scene is within the two tolerances."""
        scene = self.scene(page)
        self.run_program("render", "scene.json", "-o", "again.png", "-q")
        width, height, _, rows = page.picture()
        with open(self.path("again.png"), "rb") as file:
            again = png(file.read())
        self.assertEqual((width, height), again[:2])
        worst = max(abs(a - b) for ours, theirs in zip(rows, again[3])
                    for a, b in zip(ours, theirs))
        self.assertLessEqual(worst, most)
        return scene, rows


class Exported(PageTest):
    def test_a_built_in_field(self):
        page = self.open(self.export("builtin:shells:40"), window=(700, 500))
        self.assertIn("every pixel within", page.text("#state"))
        scene, rows = self.check_frame(page, 2)
        self.assertGreater(len(set(rows[len(rows) // 2])), 20)
        page.show("#picture")
        x, y = page.center("#picture")
        page.wait_exact(page.drag((x, y), (x + 90, y + 40)))
        turned, _ = self.check_frame(page, 2)
        self.assertNotEqual(turned["camera"]["position"], scene["camera"]["position"])
        self.assertEqual(page.complaints(), [])

    def test_data_of_files(self):
        """A turned grid with two channels and labels over it comes back as it was."""
        import numpy
        z, y, x = numpy.mgrid[-1:1:20j, -1:1:24j, -1:1:28j]
        ball = numpy.exp(-2 * (x * x + y * y + z * z)).astype(numpy.float32)
        affine = numpy.array([[0.9, -0.3, 0, 4], [0.3, 0.8, 0.2, -7], [0, 0.1, 1.1, 2],
                              [0, 0, 0, 1]])
        numpy.savez(self.path("ball.npz"), values=ball, affine=affine)
        numpy.savez(self.path("ramp.npz"), values=(x * 100).astype(numpy.int16), affine=affine)
        numpy.savez(self.path("marks.npz"), values=(ball > 0.7).astype(numpy.uint8), affine=affine)
        page = self.open(self.export(
            "--channel", "ball=ball.npz", "--channel", "ramp=ramp.npz", "--gaussian",
            "ball=0.5~0.2, ramp=20~60; extinction 0.4; color #e0a060", "--labels", "marks.npz"),
            window=(600, 420))
        for name in ("ball.npz", "ramp.npz", "marks.npz"):
            os.rename(self.path(name), self.path("given_" + name))
            self.save_data(page, name)
            given, got = (numpy.load(self.path(one)) for one in ("given_" + name, name))
            self.assertEqual(got["values"].dtype, given["values"].dtype)
            numpy.testing.assert_array_equal(got["values"], given["values"])
            numpy.testing.assert_allclose(got["affine"], affine, rtol=1e-14)
        self.check_frame(page, 2)
        self.assertEqual(page.complaints(), [])

    def test_rectilinear_and_cell_centred(self):
        import numpy
        values = numpy.arange(3 * 4 * 5, dtype=numpy.float64).reshape(3, 4, 5)
        numpy.savez(self.path("axes.npz"), values=values, x=[0, 1, 3, 4, 9.0], y=[0, 2, 3, 4.5],
                    z=[-1, 0, 2.0], space=numpy.frombuffer(b"LPS", numpy.uint8))
        numpy.save(self.path("cells.npy"), values)
        for arguments in (["axes.npz", "--array", "values"],
                          ["cells.npy", "--centering", "cell", "--spacing", "1,2,3"]):
            with self.subTest(arguments[0]):
                page = self.open(self.export(*arguments), window=(500, 400))
                os.rename(self.path(arguments[0]), self.path("given_" + arguments[0]))
                name = arguments[0].split(".")[0] + ".npz"
                self.save_data(page, name)
                _, rows = self.check_frame(page, 2)
                page.browser.quit()

    def test_a_part(self):
        import numpy
        values = numpy.arange(6 * 7 * 8, dtype=numpy.uint16).reshape(6, 7, 8)
        numpy.save(self.path("whole.npy"), values)
        page = self.open(self.export("whole.npy", "--spacing", "1,2,3", "--crop", "2:7,1:6,0:4"),
                         window=(500, 400))
        self.save_data(page, "whole.npz")
        got = numpy.load(self.path("whole.npz"))
        numpy.testing.assert_array_equal(got["values"].T, values[0:4, 1:6, 2:7])
        numpy.testing.assert_array_equal(got["affine"][:3, 3], [-2, -2, 0])

    def test_data_that_are_reduced(self):
        """They lie where they were, and the page is exact for them and says what they are."""
        import numpy
        rng = numpy.random.default_rng(3)
        z, y, x = numpy.mgrid[-1:1:61j, -1:1:64j, -1:1:60j]
        ball = numpy.exp(-2 * (x * x + y * y + z * z)) + rng.normal(0, 0.02, x.shape)
        numpy.save(self.path("ball.npy"), ball.astype(numpy.float32))
        numpy.save(self.path("small.npy"), ball[::8, ::8, ::8].astype(numpy.float32))
        fits = self.run_program("export", "small.npy", "-o", "fits.html", "--max-size", "20M",
                                "--reduce")
        self.assertNotIn("reduced", fits.stderr)
        # Half the resolution has some 150 kB, all of it has 1 MB.
        most = os.path.getsize(self.path("fits.html")) + 200_000
        for arguments, size in ((["ball.npy"], "31 x 33 x 31 of 60 x 64 x 61"),
                                (["ball.npy", "--centering", "cell"],
                                 "30 x 32 x 31 of 60 x 64 x 61")):
            with self.subTest(size):
                told = self.run_program("export", *arguments, "--max-size", str(most),
                                        "--reduce", "-o", "page.html").stderr
                note = f"data reduced: layer 1: {size} values; the picture is exact for these"
                self.assertIn(f"page.html: {note}\n", told)
                self.assertLessEqual(os.path.getsize(self.path("page.html")), most)
                page = self.open(self.path("page.html"), window=(500, 400))
                self.assertIn(note[1:], page.text("#data-note"))
                self.save_data(page, "ball.npz")
                numpy.testing.assert_allclose(
                    numpy.load(self.path("ball.npz"))["values"].mean(), ball.mean(), rtol=0.05)
                self.check_frame(page, 2)
                box = page.run("return viewer.box")
                page.browser.quit()
                whole = self.open(self.export(*arguments), window=(500, 400))
                self.assertEqual(whole.run("return document.getElementById('data-note').hidden"),
                                 True)
                for end, values in whole.run("return viewer.box").items():
                    numpy.testing.assert_allclose(values, box[end], atol=1e-9)
                whole.browser.quit()

    def test_a_message_that_is_refused(self):
        """It ends no frame, and the picture is told to be exact behind it."""
        page = self.open(self.export("builtin:hydrogen:64", "--shading", "on"), window=(700, 500))
        before = page.frame()
        page.run("""
            viewer.connection.send({type: 'turn', x: 0.1, y: 0});
            setTimeout(() => viewer.connection.send({type: 'turn', x: 'bad', y: 0}), 300);""")
        page.wait_for(lambda: "x" in page.text("#message"), "the refusal")
        page.wait_exact(before)

    def test_a_renderer_that_ends(self):
        page = self.open(self.export("builtin:sphere:16"), window=(700, 500))
        page.run("viewer.connection.socket.end('There is not enough memory for this in a page.')")
        page.wait_for(lambda: "not enough memory" in page.text("#lost"), "why it ended")
        self.assertIn("Save scene.json", page.text("#lost"))
        self.assertEqual(page.state(), "lost")
        page.press_button("Start again")
        page.wait_for(lambda: page.state() == "exact", "an exact frame")
        self.assertTrue(page.run("return document.getElementById('lost').hidden"))

    def test_nothing_is_asked_for(self):
        path = self.export("builtin:sphere:16")
        page = self.open(path, window=(500, 400))
        asked = page.run("return performance.getEntriesByType('resource').map(({name}) => name)")
        self.assertEqual([name for name in asked if not name.startswith(("blob:", "data:"))], [])
        refused = page.run("""
            return Promise.race([fetch('https://example.org/').then(() => 'sent', () => 'refused'),
                                 new Promise((done) => setTimeout(done, 5000, 'waited'))])""")
        self.assertEqual(refused, "refused")

    def test_a_page_that_is_cut_off(self):
        with open(self.export("builtin:sphere:16"), encoding="utf-8") as file:
            text = file.read()
        module = text.index('id="module"')
        for end in (module + 1000, text.index('data-embedded="scene.json"') + 60):
            with self.subTest(end):
                with open(self.path("cut.html"), "w", encoding="utf-8") as file:
                    file.write(text[:end])
                page = self.open(self.path("cut.html"), window=(500, 400), waits=False)
                page.wait_for(lambda: "cut off" in page.text("#lost"), "a word on the cut")
                page.browser.quit()
        damaged = re.sub(r'(data-embedded="scene.json" data-size="\d+">)....', r"\1", text)
        with open(self.path("damaged.html"), "w", encoding="utf-8") as file:
            file.write(damaged)
        page = self.open(self.path("damaged.html"), window=(500, 400), waits=False)
        page.wait_for(lambda: "damaged" in page.text("#lost"), "a word on the damage")

    def test_refusals(self):
        for arguments, words in (
                (["builtin:sphere:16", "-o", "page.png"], "ends in .html"),
                (["builtin:sphere:16", "-o", "page.html", "--max-size", "10k"], "--max-size 10k"),
                (["builtin:sphere:16", "-o", "page.html", "--max-size", "much"], "as 20M or 500k"),
                (["builtin:sphere:16", "-o", "page.html", "--max-size", "10k", "--reduce"],
                 "reduced as far as they can be"),
                (["builtin:sphere:16", "-o", "page.html", "--reduce"], "give --max-size"),
                (["-o", "page.html"], "no input"),
                (["missing.nii", "-o", "page.html"], "missing.nii"),
                (["builtin:sphere:16", "--crop", "1:2,0:9,0:9", "-o", "page.html"], "two values"),
                (["builtin:sphere:16", "--crop", "1:5,0:9,0:9", "-o", "page.html"], "built-in")):
            with self.subTest(words):
                result = subprocess.run([PROGRAM, "export", *arguments], cwd=self.folder,
                                        capture_output=True, text=True, timeout=300)
                self.assertNotEqual(result.returncode, 0)
                self.assertIn(words, result.stderr)
                self.assertEqual(len(result.stderr.strip().splitlines()), 1, result.stderr)
                self.assertEqual(os.listdir(self.folder), [])


class Empty(PageTest):
    def test_files_that_are_chosen(self):
        import numpy
        z, y, x = numpy.mgrid[-1:1:20j, -1:1:24j, -1:1:28j]
        numpy.save(self.path("ball.npy"), numpy.exp(-2 * (x * x + y * y + z * z)))
        page = self.open(EMPTY, window=(600, 420), waits=False)
        page.wait_for(lambda: page.run("return !document.getElementById('open-panel').hidden"),
                      "the panel")
        self.assertNotIn("folders of the machine", page.text("#open-panel"))
        page.browser.find_element("css selector", "#open-panel input[type=file]").send_keys(
            self.path("ball.npy"))
        page.wait_exact(-1)
        self.assertIn("every pixel within", page.text("#state"))
        self.assertIn("ball.npy", page.text("#subject"))
        # Another one that is none is told of, and the picture stays.
        with open(self.path("bad.npy"), "w", encoding="ascii") as file:
            file.write("no array")
        page.press("#open")
        page.browser.find_element("css selector", "#open-panel input[type=file]").send_keys(
            self.path("bad.npy"))
        page.wait_for(lambda: "bad.npy" in page.text("#message"), "a word on the file")
        self.assertIn("ball.npy", page.text("#subject"))


if __name__ == "__main__":
    reason = why_not() or (None if os.path.exists(EMPTY) else
                           "there is no page; scripts/build-web builds it")
    if reason:
        print("skipped:", reason)
        sys.exit(77)
    unittest.main()
