# SPDX-License-Identifier: Apache-2.0
"""The viewer in a real browser: what a user does with the mouse, and what comes of it.

With PELLUCID_END=page the other end is not the program, but the worker of an exported page.
"""

import json
import os
import subprocess
import sys
import tempfile
import unittest

from page_driver import Page, why_not
from viewer_process import PROGRAM, Viewer

SOURCE_DIR = os.environ.get("PELLUCID_SOURCE_DIR", os.path.join(os.path.dirname(__file__), "../.."))
sys.path.insert(0, os.path.join(SOURCE_DIR, "tests", "cli"))
from program import png  # noqa: E402

# Whether the page has its renderer in itself, which has other lanes: pictures are not the program's
# to the bit, but within the tolerances of both, in sRGB where it is steepest.
IN_PAGE = os.environ.get("PELLUCID_END") == "page"
PAGE_DIFFERS = 13  # 12.92 · 255 · 2 / 512

GAUSSIANS = {"layers": [{"field": {"builtin": "sphere", "points": 40}, "transfer_function": {
    "gaussians": [{"channels": ["value", "gradient_magnitude"], "center": [0.4, 0.9],
                   "width": [0.1, 0.3], "extinction": 4, "color": [0.9, 0.6, 0.3]}]}}]}


class ExportedPage:
    """A page on disk, in the place of a program that serves it."""

    def __init__(self, *arguments, folder):
        subprocess.run([PROGRAM, "export", *arguments, "-o", "page.html", "-q"], cwd=folder,
                       check=True, timeout=900)
        self.address = "file://" + os.path.join(folder, "page.html")

    def stop(self):
        """There is nothing to stop."""


class BrowserTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="pellucid_view_", ignore_cleanup_errors=True)
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def start(self, *arguments):
        self.viewer = (ExportedPage if IN_PAGE else Viewer)(*arguments, folder=self.folder)
        self.addCleanup(self.viewer.stop)
        return self.viewer

    def open(self, *arguments, **options):
        return self.show(self.start(*arguments), **options)

    def show(self, viewer, **options):
        page = Page(viewer, self.folder, **options)
        self.addCleanup(page.browser.quit)
        return page

    def scene(self, page):
        return json.loads(page.saved("Scene, JSON", "scene.json"))

    def check_same(self, program, page):
        """Pictures, as png() gives them, are the same to the bit, or of a page within bounds."""
        if not IN_PAGE:
            self.assertEqual(program, page)
            return
        self.assertEqual(program[:3], page[:3])
        self.assertLessEqual(max(abs(a - b) for ours, theirs in zip(program[3], page[3])
                                 for a, b in zip(ours, theirs)), PAGE_DIFFERS)

    def check_saved_scene_is_the_frame(self, page):
        """The command line makes the frame of the saved scene."""
        scene = self.scene(page)
        subprocess.run([PROGRAM, "render", "scene.json", "-o", "again.png", "-q"],
                       cwd=self.folder, check=True, timeout=900)
        with open(os.path.join(self.folder, "again.png"), "rb") as file:
            self.check_same(png(file.read()), page.picture())
        return scene


class Curves(BrowserTest):
    def test_a_session(self):
        page = self.open("builtin:shells:40", window=(960, 620))
        self.assertIn("every pixel within", page.text("#state"))
        scene = self.check_saved_scene_is_the_frame(page)

        # Turn: the camera moves around the focal point.
        x, y = page.center("#picture")
        page.wait_exact(page.drag((x, y), (x + 150, y + 60)))
        turned = self.check_saved_scene_is_the_frame(page)
        self.assertNotEqual(turned["camera"]["position"], scene["camera"]["position"])
        self.assertEqual(turned["camera"]["focal_point"], scene["camera"]["focal_point"])

        # Edit a point.
        page.show(".plot")
        point = page.center('[data-point="1"]')
        before = turned["layers"][0]["transfer_function"]["points"]
        page.wait_exact(page.drag(point, (point[0] + 12, point[1] - 30)))
        edited = self.check_saved_scene_is_the_frame(page)
        points = edited["layers"][0]["transfer_function"]["points"]
        self.assertEqual(len(points), len(before))
        self.assertGreater(points[1]["value"], before[1]["value"])
        self.assertGreater(points[1]["extinction"], before[1]["extinction"])
        self.assertEqual(points[2:], before[2:])

        # Add one, and remove it with the right button.
        page.show(".plot")
        left, top, width, height = page.box(".plot svg")
        page.wait_exact(page.click(left + 0.9 * width, top + 0.6 * height))
        added = self.scene(page)["layers"][0]["transfer_function"]["points"]
        self.assertEqual(len(added), len(points) + 1)
        page.show(".plot")
        new = page.run("return document.querySelector('.plot .point.selected').dataset.point")
        page.wait_exact(page.click(*page.center(f'[data-point="{new}"]'), button="right"))
        self.assertEqual(self.scene(page)["layers"][0]["transfer_function"]["points"], points)

        # Undo the three edits, one after the other.
        for _ in range(3):
            page.wait_exact(page.press("#undo"))
        self.assertEqual(self.scene(page)["layers"][0]["transfer_function"]["points"], before)
        self.assertTrue(page.run("return document.getElementById('undo').disabled"))

        # Clip by a box, and drag a face of it.
        page.open_panel("clip-panel")
        page.wait_exact(page.press_button("Add a box"))
        handle = page.center('[data-handle="z1"]')
        page.wait_exact(page.drag(handle, (handle[0], handle[1] + 70)))
        clipped = self.check_saved_scene_is_the_frame(page)
        box = clipped["clip"][0]["box"]
        self.assertLess(box["upper"][2], 0.9)
        self.assertEqual(box["lower"], [-1, -1, -1])

        # An isosurface is dragged along the histogram.
        page.open_panel("surfaces-panel")
        page.wait_exact(page.press_button("Add an isosurface"))
        page.show(".plot")
        hit = page.center("[data-surface]")
        page.wait_exact(page.drag(hit, (hit[0] + 40, hit[1])))
        with_surface = self.check_saved_scene_is_the_frame(page)
        self.assertGreater(with_surface["layers"][0]["isosurfaces"][0]["value"], 0.5)

        # The picture that is saved is the one that the command line writes.
        picture = page.saved("Picture, PNG", "picture.png")
        subprocess.run([PROGRAM, "render", "scene.json", "-o", "again.png", "-q"], cwd=self.folder,
                       check=True, timeout=900)
        with open(os.path.join(self.folder, "again.png"), "rb") as file:
            self.check_same(png(file.read()), png(picture))
        self.assertEqual(page.complaints(), [])

    def test_keys_and_sides(self):
        page = self.open("builtin:sphere:24", window=(900, 600))
        first = self.scene(page)["camera"]
        page.run("document.getElementById('picture').focus()")
        from selenium.webdriver.common.keys import Keys
        canvas = page.browser.find_element("id", "picture")

        def type_keys(*keys):
            before = page.frame()
            canvas.send_keys(*keys)
            page.wait_exact(before)
            return self.scene(page)["camera"]

        self.assertNotEqual(type_keys(Keys.ARROW_LEFT)["position"], first["position"])
        self.assertEqual(type_keys("r"), first)
        self.assertNotEqual(type_keys("+")["position"], first["position"])
        self.assertEqual(type_keys("o")["projection"], "orthographic")
        type_keys("o")
        self.assertEqual(type_keys("1")["up"], [0, 0, 1])

    def test_the_probe_says_what_is_under_the_mouse(self):
        page = self.open("builtin:sphere:40")
        page.mouse("mouseMoved", *page.center("#picture"), button="none", count=0)
        page.wait_for(lambda: "optical depth" in page.text("#probe"), "the probe")
        self.assertRegex(page.text("#probe"), r"value 0\.\d+")
        self.assertEqual(page.run("return document.querySelectorAll('.plot .seen').length"), 1)

    def test_the_error_map_and_the_tolerance(self):
        page = self.open("builtin:marschner_lobb:40", window=(800, 500))
        page.wait_exact(page.press("#error-map"))
        self.assertFalse(page.run("return document.getElementById('errors').hidden"))
        before = page.frame()
        page.run("const slider = document.getElementById('tolerance'); slider.value = 30;"
                 "slider.dispatchEvent(new Event('input'))")
        page.wait_exact(before)
        self.assertIn("0.0001", page.text("#state"))

    def test_names_contrast_and_sizes(self):
        page = self.open("builtin:sphere:16", window=(1280, 900))
        for panel in ("surfaces-panel", "clip-panel", "light-panel", "save-panel"):
            page.open_panel(panel)
        page.wait_exact(page.press_button("Add a box"))
        for dark in ("light", "dark"):
            page.browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [
                {"name": "prefers-color-scheme", "value": dark}]})
            self.assertEqual(page.run(ACCESS), [], dark)


    def test_a_phone(self):
        page = self.open("builtin:sphere:16", window=(390, 844))
        for panel in ("surfaces-panel", "clip-panel", "light-panel", "save-panel"):
            page.open_panel(panel)
        page.wait_exact(page.press_button("Add a slice across y"))
        page.wait_exact(page.press_button("Gaussians of value and gradient"))
        # Nothing sticks out at the side, and the picture has a third of the window at least.
        self.assertLessEqual(page.run("return document.documentElement.scrollWidth"), 390)
        self.assertEqual(page.run("""
            return [...document.querySelectorAll('button, input, select')].filter((one) =>
              one.checkVisibility() && one.getBoundingClientRect().right > 390)
              .map((one) => one.outerHTML.slice(0, 80));"""), [])
        self.assertGreater(page.box("#picture")[3], 280)

    def test_panels(self):
        page = self.open("builtin:hydrogen:24", window=(1000, 800))
        # Lights share the brightness of those that were there.
        page.open_panel("light-panel")
        lights = self.scene(page)["lights"]
        brightness = sum(max(light["color"]) for light in lights)
        for count in (len(lights) + 1, len(lights) + 2):
            page.wait_exact(page.press_button("Add a light"))
            lights = self.scene(page)["lights"]
            self.assertEqual(len(lights), count)
            self.assertAlmostEqual(sum(max(light["color"]) for light in lights), brightness)
        page.wait_exact(page.press("[aria-label='Remove light 1']"))
        lights = self.scene(page)["lights"]
        self.assertAlmostEqual(sum(max(light["color"]) for light in lights), brightness)
        # A slice is grey in a window of its values; all of them have one window.
        page.open_panel("surfaces-panel")
        page.wait_exact(page.press_button("Add a slice across y"))
        page.wait_exact(page.press_button("Add a slice across x"))
        before = page.frame()
        page.run("const input = "
                 "document.querySelector('[aria-label=\"Window of Slice across x\"]');"
                 "input.value = 0.1; input.dispatchEvent(new Event('change'))")
        page.wait_exact(before)
        for one in self.scene(page)["layers"][0]["slices"]:
            points = one["colors"]["points"]
            self.assertAlmostEqual(points[-1]["value"] - points[0]["value"], 0.1)
            self.assertEqual((points[0]["color"], points[-1]["color"]), ([0, 0, 0], [1, 1, 1]))
        # Presets are shown as pictures, and used by a click.
        page.run("document.querySelector('details.inner').open = true")
        page.show("details.inner")  # pictures are made when they are seen
        page.wait_for(lambda: page.run("return document.querySelectorAll('.presets .made').length")
                      >= 3, "pictures of presets")
        before = self.scene(page)["layers"][0]["transfer_function"]
        page.wait_exact(page.press("[data-preset=mr-t1-brain]"))
        self.assertNotEqual(self.scene(page)["layers"][0]["transfer_function"], before)
        # Axes and scale bar in a picture, if asked for.
        plain = png(page.saved("Picture, PNG", "picture.png"))
        page.run("document.querySelector('#save-panel input[type=checkbox]').click()")
        marked = png(page.saved("Picture, PNG", "picture.png"))
        if not IN_PAGE:  # which draws no color bars
            page.run("document.querySelectorAll('#save-panel input[type=checkbox]').forEach("
                     "(box) => box.click())")
            with_bar = png(page.saved("Picture, PNG", "picture.png"))
            self.assertEqual(with_bar[:2], plain[:2])
            self.assertNotEqual(with_bar, plain)
            self.assertNotEqual(with_bar, marked)
        self.assertEqual(marked[:2], plain[:2])
        height, width = plain[1], plain[0]
        half = width // 2 * marked[2]
        self.assertNotEqual(marked[3][height - 60][:half // 2], plain[3][height - 60][:half // 2])
        self.assertEqual(page.complaints(), [])

    def test_the_span_of_a_histogram(self):
        page = self.open("builtin:hydrogen:24", window=(1000, 800))

        def span():
            return [float(page.run("return document.querySelector(arguments[0]).value",
                                   f"[aria-label='{end} value of value in the plot']"))
                    for end in ("Least", "Largest")]
        page.wait_for(lambda: page.text(".plot text"), "the middle of the values")
        middle = span()
        page.press_button("All")
        page.wait_for(lambda: span()[1] > 1.1 * middle[1], "all values")
        page.press_button("Middle")
        page.wait_for(lambda: span() == middle, "the middle of the values")
        page.press("[aria-label='Zoom into the plot']")
        page.wait_for(lambda: span()[1] < middle[1], "the zoom")
        for name in ("log counts", "log values"):
            page.run("[...document.querySelectorAll('#function-panel label')].find((one) => "
                     "one.textContent === arguments[0]).click()", name)
        self.assertEqual(page.complaints(), [])


# What of the page lacks a name, is smaller than 12 px, or has less contrast than 4.5; or a control
# whose border has less contrast than 3.
ACCESS = """
const problems = [];
const luminance = (text) => {
  const [r, g, b] = text.match(/[\\d.]+/g).slice(0, 3).map((c) => {
    const s = c / 255;
    return s <= 0.04045 ? s / 12.92 : ((s + 0.055) / 1.055) ** 2.4;
  });
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
};
const behind = (element) => {
  for (let e = element; e; e = e.parentElement) {
    const color = getComputedStyle(e).backgroundColor;
    if (!/, 0\\)$|transparent/.test(color)) return color;
  }
  return 'rgb(255, 255, 255)';
};
for (const element of document.querySelectorAll('body *')) {
  if (!element.checkVisibility?.()) continue;
  const style = getComputedStyle(element);
  const own = [...element.childNodes].some((n) => n.nodeType === 3 && n.textContent.trim());
  if (own && parseFloat(style.fontSize) < 12) problems.push(`small: ${element.textContent}`);
  if (own && !element.closest('svg') && !element.disabled && element.tagName !== 'OPTION') {
    const [a, b] = [luminance(style.color), luminance(behind(element))].sort((x, y) => y - x);
    const contrast = (a + 0.05) / (b + 0.05);
    if (contrast < 4.5) problems.push(`contrast ${contrast.toFixed(2)}: ${element.textContent}`);
  }
  if (element.matches('button, select, input[type="number"], input[type="text"]') &&
      !element.disabled && !element.closest('.files')) {
    const [a, b] = [luminance(style.borderTopColor), luminance(behind(element.parentElement))]
      .sort((x, y) => y - x);
    const contrast = (a + 0.05) / (b + 0.05);
    if (contrast < 3) problems.push(`border ${contrast.toFixed(2)}: ${element.outerHTML}`);
  }
  if (element.matches('button, input, select, [tabindex], [role="button"]')) {
    const name = element.getAttribute('aria-label') || element.textContent.trim() ||
      [...(element.labels ?? [])].map((label) => label.textContent.trim()).join('');
    if (!name) problems.push(`no name: ${element.outerHTML.slice(0, 80)}`);
  }
}
return problems;
"""


@unittest.skipIf(IN_PAGE, "a page has no folders")
class Opening(BrowserTest):
    def start(self):
        self.viewer = Viewer(folder=self.folder)
        self.addCleanup(self.viewer.stop)
        page = Page(self.viewer, self.folder, waits=False, window=(1000, 700))
        self.addCleanup(page.browser.quit)
        page.wait_for(lambda: "Drop a file" in page.text("#open-panel"), "the page that asks")
        return page

    def test_a_file_of_this_machine(self):
        os.mkdir(os.path.join(self.folder, "data"))
        subprocess.run([PROGRAM, "convert", "builtin:shells:24", "-o", "data/shells.vti"],
                       cwd=self.folder, check=True, timeout=60)
        page = self.start()
        self.assertEqual(page.state(), "waiting")
        page.wait_for(lambda: "data/" in page.text(".files"), "the folder")
        page.press_button("data/")
        page.wait_for(lambda: "shells.vti" in page.text(".files"), "the folder")
        page.press_button("shells.vti")
        page.wait_exact(-1)
        self.assertEqual(page.text("#subject"), "shells.vti")
        self.assertTrue(page.run("return document.getElementById('open-panel').hidden"))
        self.assertEqual(self.scene(page)["layers"][0]["field"]["file"],
                         os.path.join(os.path.realpath(self.folder), "data/shells.vti"))
        # Another one takes its place.
        page.press("#open")
        page.press_button("sphere")
        page.wait_for(lambda: page.text("#subject") == "sphere", "the sphere")
        page.wait_exact(-1)
        self.assertEqual(self.scene(page)["layers"][0]["field"]["builtin"], "sphere")
        page.press("#open")
        page.run("const input = document.querySelector('#open-panel input[type=text]');"
                 "input.value = 'none.npy'; input.nextSibling.click()")
        page.wait_for(lambda: "none.npy" in page.text("#message"), "the message")
        self.assertEqual(page.complaints(), [])

    def test_a_file_that_is_dropped(self):
        page = self.start()
        page.run("""
            const header = "{'descr': '|u1', 'fortran_order': False, 'shape': (4, 4, 4), }";
            const start = '\\x93NUMPY\\x01\\x00v\\x00' + header.padEnd(117) + '\\n';
            const bytes = Uint8Array.from([...start].map((c) => c.charCodeAt(0)));
            const data = new Uint8Array(64).map((_, i) => 4 * i);
            const transfer = new DataTransfer();
            transfer.items.add(new File([bytes, data], 'a b.npy'));
            document.getElementById('stage').dispatchEvent(
              new DragEvent('drop', {bubbles: true, cancelable: true, dataTransfer: transfer}));
        """)
        page.wait_exact(-1)
        self.assertEqual(page.text("#subject"), "a b.npy")
        self.assertEqual(self.scene(page)["layers"][0]["field"]["file"], "a b.npy")
        self.assertEqual(page.complaints(), [])


@unittest.skipIf(IN_PAGE, "a page has no program that could end")
class State(BrowserTest):
    def test_exact_is_said_of_the_scene_as_it_is_alone(self):
        page = self.open("builtin:sphere:24", window=(700, 500))
        # Within the very call that changes something, before anything was sent.
        states = page.run("""
            const states = [document.body.dataset.state];
            const slider = document.getElementById('tolerance');
            slider.value = 25;
            slider.dispatchEvent(new Event('input'));
            states.push(document.body.dataset.state);
            document.getElementById('error-map').click();
            states.push(document.body.dataset.state);
            return states;""")
        self.assertEqual(states, ["exact", "waiting", "waiting"])
        page.wait_exact(page.frame() - 1)
        # What another page changes counts too: the picture is old from the moment that it is told.
        before = page.frame()
        with self.viewer.open_socket() as other:
            page.wait_exact(before)  # for the other page a picture is made
            before = page.frame()
            page.run("window.states = []; new MutationObserver(() => states.push("
                     "[document.body.dataset.state, document.body.dataset.frame])).observe("
                     "document.body, {attributes: true})")
            other.send(type="zoom", factor=1.5)
            page.wait_exact(before)
        states = page.run("return window.states")
        self.assertIn(["waiting", str(before)], states)

    def test_a_program_that_ends(self):
        page = self.open("builtin:sphere:24", window=(900, 600))
        page.open_panel("light-panel")
        first = self.scene(page)
        x, y = page.center("#picture")
        page.wait_exact(page.drag((x, y), (x + 80, y)))
        port = self.viewer.port
        self.viewer.stop()
        page.wait_for(lambda: page.state() == "lost", "the end")
        self.assertIn(f"pellucid view scene.json --port {port}", page.text("#lost"))
        # Edits go on, and are in the scene that is saved.
        page.press_button("Add a light")
        kept = json.loads(page.saved("Save scene.json", "scene.json"))
        self.assertNotEqual(kept["camera"]["position"], first["camera"]["position"])
        self.assertEqual(len(kept["lights"]), len(first["lights"]) + 1)
        again = subprocess.run([PROGRAM, "render", "scene.json", "-o", "again.png"],
                               cwd=self.folder, capture_output=True, timeout=300)
        self.assertEqual(again.returncode, 0, again.stderr)

    def test_edits_are_sent_when_the_program_answers_again(self):
        page = self.open("builtin:sphere:24", window=(900, 600))
        lights = len(self.scene(page)["lights"])
        # As a line that breaks: the program goes on.
        page.run("window.viewer.connection.socket.close()")
        page.wait_for(lambda: page.state() == "lost", "the end")
        page.open_panel("light-panel")
        page.press_button("Add a light")
        page.wait_for(lambda: page.state() == "exact", "the program")
        self.assertTrue(page.run("return document.getElementById('lost').hidden"))
        page.wait_exact(-1)
        self.assertEqual(len(self.scene(page)["lights"]), lights + 1)


class Gaussians(BrowserTest):
    def test_a_gaussian_is_moved_stretched_turned_and_made(self):
        with open(os.path.join(self.folder, "start.json"), "w", encoding="utf-8") as file:
            json.dump(GAUSSIANS, file)
        page = self.open("start.json", window=(1100, 800))
        before = self.check_saved_scene_is_the_frame(page)["layers"][0]["transfer_function"]
        first = before["gaussians"][0]

        page.wait_for(lambda: page.run("return Boolean(document.querySelector('[data-gaussian]'))"),
                      "the Gaussian")
        page.show(".plot")
        body = page.center('[data-gaussian="0"]')
        page.wait_exact(page.drag(body, (body[0] + 25, body[1] - 20)))
        moved = self.check_saved_scene_is_the_frame(page)["layers"][0]["transfer_function"]
        self.assertGreater(moved["gaussians"][0]["center"][0], first["center"][0])
        self.assertGreater(moved["gaussians"][0]["center"][1], first["center"][1])
        self.assertEqual(moved["gaussians"][0]["matrix"], first["matrix"])

        def drag_grip(name, dx, dy):
            page.show(".plot")
            grip = page.center(f'[data-grip="{name}"]')
            page.wait_exact(page.drag(grip, (grip[0] + dx, grip[1] + dy)))
            return self.check_saved_scene_is_the_frame(page)["layers"][0]["transfer_function"]

        stretched = drag_grip("short", 15, -10)
        self.assertNotEqual(stretched["gaussians"][0]["matrix"], first["matrix"])
        turned = drag_grip("turn", 20, 15)
        self.assertNotEqual(turned["gaussians"][0]["matrix"][0][1], 0)

        page.show(".plot")
        left, top, width, height = page.box(".plot svg")
        page.wait_exact(page.click(left + 0.85 * width, top + 0.2 * height, count=2))
        made = self.check_saved_scene_is_the_frame(page)["layers"][0]["transfer_function"]
        self.assertEqual(len(made["gaussians"]), 2)
        page.wait_exact(page.press("#undo"))
        undone = self.scene(page)["layers"][0]["transfer_function"]
        self.assertEqual(undone, turned)
        self.assertEqual(page.complaints(), [])


if __name__ == "__main__":
    reason = why_not()
    if reason:
        print(f"skipped: {reason} (scripts/install-packages browser)")
        sys.exit(77)
    if IN_PAGE and not os.path.exists(os.environ["PELLUCID_PAGE"]):
        print("skipped: there is no page; scripts/build-web builds it")
        sys.exit(77)
    unittest.main(verbosity=2)
