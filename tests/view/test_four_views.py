# SPDX-License-Identifier: Apache-2.0
"""Three slices and the volume in a real browser: crosshair, values, measures, keys, touch."""

import base64
import json
import os
import sys
import unittest

from page_driver import why_not
from test_browser import ACCESS, IN_PAGE, BrowserTest

try:
    import numpy as np
    from test_slices import interpolated, write_nifti
except ImportError:
    np = None

SPACING = np.array([1.5, 2, 3]) if np else None
BRIGHT = (11, 4, 9)
SLICES = "viewer.views.slices"


class FourViews(BrowserTest):
    def setUp(self):
        super().setUp()
        rng = np.random.default_rng(3)
        self.data = rng.uniform(0, 100, size=(20, 16, 14)).astype("f4")
        self.data[BRIGHT] = 1000
        self.labels = np.zeros(self.data.shape, "u1")
        self.labels[4:8, 4:8, 4:8] = 3
        # From the left, from the back, up: the world's x and y go the other way than the indices.
        self.affine = np.diag([-SPACING[0], SPACING[1], SPACING[2], 1])
        self.affine[:3, 3] = [7, -5, 2]
        write_nifti(self.folder + "/a.nii.gz", self.data, self.affine)
        write_nifti(self.folder + "/l.nii.gz", self.labels, self.affine)
        with open(self.folder + "/labels.json", "w", encoding="ascii") as file:
            json.dump({"layers": [{"field": {"file": "a.nii.gz"}}, {"labels": {
                "file": "l.nii.gz", "colors": [{"label": 3, "name": "cube", "color": [1, 0, 0],
                                                "extinction": 1}]}}]}, file)

    def world_of(self, index):
        """The world, to the left, back and up, of a voxel's middle."""
        return np.diag([-1, -1, 1.0]) @ (self.affine[:3, :3] @ np.array(index, float) +
                                         self.affine[:3, 3])

    def index_of(self, world):
        """Indices of positions, (3, n)."""
        return np.linalg.solve(self.affine[:3, :3],
                               np.diag([-1, -1, 1.0]) @ world - self.affine[:3, 3:])

    def open_views(self, *arguments, **options):
        page = self.open(*(arguments or ["a.nii.gz"]), **options)
        before = page.press("#four")
        if page.run("return document.getElementById('stage').clientWidth"):
            page.wait_exact(before)
        self.wait_slices(page)
        return page

    def wait_slices(self, page):
        page.wait_for(lambda: page.run(
            f"return {SLICES}.filter((one) => one.isShown()).every((one) => one.slice &&"
            "!one.isAsked && !one.isStale && one.slice.position === "
            "viewer.views.crosshair[one.axis])"), "the slices")

    def crosshair(self, page):
        return np.array(page.run("return viewer.views.crosshair"))

    def pixel(self, page, axis, world):
        """Where a position is on the page, by what the page asked for."""
        left, top, width, height = page.box(f"[data-axis='{axis}'] canvas")
        slice_from, slice_to = page.run(
            f"const {{from, to}} = {SLICES}[{axis}].slice; return [from, to]")
        u, v = [a for a in range(3) if a != axis]
        return (left + width * (world[u] - slice_from[0]) / (slice_to[0] - slice_from[0]),
                top + height * (world[v] - slice_from[1]) / (slice_to[1] - slice_from[1]))

    def go_to(self, page, axis, position):
        """Sets a coordinate of the crosshair in its field."""
        page.run("const input = document.querySelector(arguments[0]); input.value = arguments[1];"
                 "input.dispatchEvent(new Event('change'))",
                 f"[aria-label='{'xyz'[axis]} of the crosshair']", str(position))
        self.wait_slices(page)

    def check_within_half_a_voxel(self, page, world):
        off = np.abs(self.crosshair(page) - world)
        self.assertTrue((off <= SPACING / 2).all(), off)
        # What each slice shows, and where its lines cross.
        for axis in range(3):
            position = page.run(f"return {SLICES}[{axis}].slice.position")
            self.assertLessEqual(abs(position - world[axis]), SPACING[axis] / 2)
            at = page.run(f"return {SLICES}[{axis}].pixelOfWorld(viewer.views.crosshair)")
            left, top, _, _ = page.box(f"[data-axis='{axis}'] canvas")
            x, y = self.pixel(page, axis, world)
            scale = page.run(f"return {SLICES}[{axis}].place().scale")
            u, v = [a for a in range(3) if a != axis]
            self.assertLessEqual(abs(left + at["x"] - x) * scale, SPACING[u] / 2 + 0.01)
            self.assertLessEqual(abs(top + at["y"] - y) * scale, SPACING[v] / 2 + 0.01)

    def test_a_click_at_a_bright_voxel_moves_all_crosshairs(self):
        page = self.open_views(window=(1100, 800))
        world = self.world_of(BRIGHT)
        for axis in (2, 1, 0):
            for other in range(3):  # somewhere else first, but in the slice of the voxel
                self.go_to(page, other, world[other] if other == axis else
                           self.world_of((2, 12, 2))[other])
            page.click(*self.pixel(page, axis, world))
            self.wait_slices(page)
            self.check_within_half_a_voxel(page, world)
            wanted = "voxel {}, {}, {}".format(*BRIGHT)
            page.wait_for(lambda w=wanted: w in page.text("#readout"), "the readout")
        # The brightest pixel of each slice is under the crosshair, however the file is turned.
        for axis in range(3):
            numbers, header = self.values(page, axis)
            row, column = np.unravel_index(np.nanargmax(numbers), numbers.shape)
            u, v = [a for a in range(3) if a != axis]
            at = [header["from"][i] + (header["to"][i] - header["from"][i]) * (n + 0.5) / count
                  for i, n, count in ((0, column, header["columns"]), (1, row, header["rows"]))]
            self.assertLess(abs(at[0] - world[u]), SPACING[u] / 2)
            self.assertLess(abs(at[1] - world[v]), SPACING[v] / 2)
        self.assertEqual(page.complaints(), [])

    def values(self, page, axis):
        """The values of a slice as the page has them, row by row, and the message's header."""
        data, header = page.run(f"""
            const {{bytes, numbers, indices, ...header}} = {SLICES}[{axis}].slice;
            const raw = new Uint8Array(numbers.buffer, numbers.byteOffset, numbers.byteLength);
            let text = '';
            for (let i = 0; i < raw.length; i += 32768) {{
              text += String.fromCharCode(...raw.subarray(i, i + 32768));
            }}
            return [btoa(text), header];""")
        numbers = np.frombuffer(base64.b64decode(data), "<f4")
        return numbers.reshape(header["rows"], header["columns"]), header

    def test_slices_are_those_of_numpy(self):
        page = self.open_views(window=(900, 700))
        self.go_to(page, 0, 1.234)
        self.go_to(page, 1, -4.321)
        self.go_to(page, 2, 17.77)
        for axis in range(3):
            numbers, header = self.values(page, axis)
            columns, rows = header["columns"], header["rows"]
            u, v = [a for a in range(3) if a != axis]
            world = np.empty((3, rows, columns))
            world[axis] = header["position"]
            (u0, v0), (u1, v1) = header["from"], header["to"]
            world[u] = (u0 + (u1 - u0) * (np.arange(columns) + 0.5) / columns)[None, :]
            world[v] = (v0 + (v1 - v0) * (np.arange(rows) + 0.5) / rows)[:, None]
            # Radiological: the left of the patient at the right, front and head above.
            self.assertGreater(u1, u0)
            self.assertEqual(v1 > v0, axis == 2)
            wanted = interpolated(self.data, self.index_of(world.reshape(3, -1)))
            found = numbers.ravel()
            both = ~(np.isnan(wanted) | np.isnan(found))
            self.assertGreater(both.sum(), 5000)
            self.assertLessEqual(np.abs(wanted - found)[both].max(), 1e-6 * 1000)
            self.assertLess((np.isnan(wanted) != np.isnan(found)).sum(), columns + rows)

    def test_a_window_is_dragged(self):
        page = self.open_views(window=(1100, 800))
        world = self.world_of(BRIGHT)
        for axis in range(3):
            self.go_to(page, axis, world[axis])

        def grey():
            """Of a pixel beside the crosshair's lines, whose value is known."""
            return page.run(f"""
                const one = {SLICES}[2], {{columns}} = one.slice;
                const {{x, y}} = one.pixelOfWorld(viewer.views.crosshair);
                const i = Math.floor(x) + 3, j = Math.floor(y) + 3;
                const {{data}} = one.canvas.getContext('2d').getImageData(i, j, 1, 1);
                return [...data.slice(0, 3), one.slice.numbers[j * columns + i],
                  ...viewer.views.windowOf()];""")
        before = grey()
        x, y = page.center("[data-axis='2'] canvas")
        page.drag((x, y), (x + 60, y + 20), button="right")
        after = grey()
        self.assertEqual(before[3], after[3])
        self.assertGreater(after[5] - after[4], before[5] - before[4])
        self.assertGreater(after[5] + after[4], before[5] + before[4])
        for r, g, b, value, lower, upper in (before, after):
            self.assertEqual((r, g), (b, b))
            self.assertLessEqual(abs(r - min(255, max(0, 255 * (value - lower) / (upper - lower)))),
                                 1)
        # The field says the same, and sets it.
        page.run("const input = document.querySelector('[aria-label=\"Window of the slices\"]');"
                 "input.value = 10; input.dispatchEvent(new Event('change'))")
        lower, upper = page.run("return viewer.views.windowOf()")
        self.assertAlmostEqual(upper - lower, 10)

    def test_wheel_zoom_and_slider(self):
        page = self.open_views(window=(1100, 800))
        x, y = page.center("[data-axis='2'] canvas")
        start = self.crosshair(page)

        def wheel(delta, modifiers=0):
            page.browser.execute_cdp_cmd("Input.dispatchMouseEvent", {
                "type": "mouseWheel", "x": x, "y": y, "deltaX": 0, "deltaY": delta,
                "modifiers": modifiers})
        wheel(-120)
        page.wait_for(lambda: abs(self.crosshair(page)[2] - start[2] - SPACING[2]) < 1e-9,
                      "a slice up")
        wheel(120)
        page.wait_for(lambda: abs(self.crosshair(page)[2] - start[2]) < 1e-9, "the slice below")
        scale = page.run(f"return {SLICES}[2].place().scale")
        wheel(-300, 2)
        page.wait_for(lambda: page.run(f"return {SLICES}[2].place().scale") < scale, "a zoom")
        self.assertEqual(self.crosshair(page)[2], start[2])
        page.run(f"const {{slider}} = {SLICES}[0]; slider.value = {start[0] + 2.2 * SPACING[0]};"
                 "slider.dispatchEvent(new Event('input'))")
        self.assertAlmostEqual(self.crosshair(page)[0], start[0] + 2 * SPACING[0])
        self.wait_slices(page)

    def test_a_click_in_the_volume(self):
        page = self.open_views("builtin:sphere:40", window=(1100, 800))
        x, y = page.center("#picture")
        start = self.crosshair(page)
        page.click(x + 20, y - 10)
        page.wait_for(lambda: (self.crosshair(page) != start).all(), "the crosshair")
        at = self.crosshair(page)
        # It is seen where the click was.
        seen = page.run("""const matrix = viewer.picture.frame.overlay.matrix;
            const p = [...viewer.views.crosshair, 1];
            const [a, b, w] = matrix.map((row) => row.reduce((sum, m, i) => sum + m * p[i], 0));
            return [a / w, b / w];""")
        left, top, width, height = page.box("#picture")
        self.assertAlmostEqual(left + seen[0] * width, x + 20, delta=1)
        self.assertAlmostEqual(top + seen[1] * height, y - 10, delta=1)
        marker = page.run("const {cx, cy} = document.querySelector('#overlay .crosshair');"
                          "return [cx.baseVal.value, cy.baseVal.value]")
        self.assertAlmostEqual(marker[0], seen[0] * width, delta=0.1)
        # A drag turns, and leaves the crosshair; the marker moves with the picture.
        page.wait_exact(page.drag((x, y), (x + 60, y)))
        self.assertTrue((self.crosshair(page) == at).all())
        self.assertNotEqual(page.run("return document.querySelector('#overlay .crosshair')"
                                     ".cx.baseVal.value"), marker[0])

    def test_measures(self):
        page = self.open_views(window=(1100, 800))
        a, b, c = (self.world_of(index) for index in ((5, 5, 7), (13, 5, 7), (13, 11, 7)))
        self.go_to(page, 2, a[2])
        page.press("[data-tool=distance]")
        for point in (a, b):
            page.click(*self.pixel(page, 2, point))
        page.press("[data-tool=angle]")
        for point in (a, b, c):
            page.click(*self.pixel(page, 2, point))
        # Between slices: one point here, one in another slice.
        page.press("[data-tool=distance]")
        page.click(*self.pixel(page, 2, a))
        d = self.world_of((5, 5, 10))
        self.go_to(page, 0, a[0])
        page.click(*self.pixel(page, 0, d))
        measures = page.run("return viewer.views.measures.list")
        self.assertEqual([one["kind"] for one in measures], ["distance", "angle", "distance"])
        texts = page.run("return [...document.querySelectorAll('#slices-panel .measure span')]"
                         ".map((one) => one.textContent)")
        scale = page.run(f"return {SLICES}[2].place().scale")
        numbers = [float(text.split(": ")[1].split(" ")[0].rstrip("°")) for text in texts]
        self.assertAlmostEqual(numbers[0], 8 * SPACING[0], delta=2 * scale)
        self.assertAlmostEqual(numbers[1], 90, delta=6)
        self.assertAlmostEqual(numbers[2], 3 * SPACING[2], delta=2 * scale)
        self.assertTrue(texts[0].endswith(" mm") and texts[1].endswith("°"), texts)
        # They are drawn in their slice alone, and in the volume.
        drawn = 'return document.querySelectorAll("{} circle.measure").length'
        self.assertGreaterEqual(page.run(drawn.format("[data-axis='2']")), 6)
        self.assertEqual(page.run(drawn.format("#overlay")), 7)
        self.go_to(page, 2, self.world_of((0, 0, 1))[2])
        self.assertEqual(page.run(drawn.format("[data-axis='2']")), 0)
        page.press("[aria-label='Remove Angle 1']")
        self.assertEqual(len(page.run("return viewer.views.measures.list")), 2)
        self.assertEqual(page.run(drawn.format("#overlay")), 4)
        self.assertEqual(page.complaints(), [])

    def test_labels_over_slices(self):
        page = self.open_views("labels.json", window=(1100, 800))
        for axis in range(3):
            self.go_to(page, axis, self.world_of((5, 5, 5))[axis])
        # On the way there the crosshair was in the cube already.
        page.wait_for(lambda: "voxel 5, 5, 5 " in page.text("#readout"), "the voxel")
        self.assertRegex(page.text("#readout"), r"voxel 5, 5, 5 .*label 3 cube")
        for axis in range(3):
            r, g, b = page.run(f"""
                const one = {SLICES}[{axis}];
                const {{x, y}} = one.pixelOfWorld(viewer.views.crosshair);
                return [...one.canvas.getContext('2d').getImageData(x + 3, y + 3, 1, 1).data]
                  .slice(0, 3);""")
            self.assertEqual(g, b)
            self.assertGreater(r, g + 60)
        page.run("const slider = document.querySelector("
                 "'[aria-label=\"Opacity of labels in slices\"]');"
                 "slider.value = 0; slider.dispatchEvent(new Event('input'));"
                 "slider.dispatchEvent(new Event('change'))")
        r, g, b = page.run(f"return [...{SLICES}[2].canvas.getContext('2d')"
                           ".getImageData(100, 100, 1, 1).data].slice(0, 3)")
        self.assertEqual((r, g), (b, b))
        self.assertEqual(page.complaints(), [])

    def test_the_keyboard_alone(self):
        from selenium.webdriver import ActionChains
        from selenium.webdriver.common.keys import Keys
        page = self.open(*["a.nii.gz"], window=(1100, 800))

        def type_keys(*keys):
            actions = ActionChains(page.browser)
            for one in keys:
                actions.send_keys(one)
            actions.perform()
        type_keys("f")
        self.wait_slices(page)
        # Tab reaches every view and every control of the bar, in the order in which they stand.
        reached = []
        for _ in range(40):
            type_keys(Keys.TAB)
            reached.append(page.run("const e = document.activeElement; return e.dataset.view ??"
                                    "e.dataset.tool ?? e.closest('[data-axis]')?.dataset.axis +"
                                    "e.tagName ?? e.id"))
        wanted = ["all", "2", "1", "0", "volume", "crosshair", "window", "distance", "angle",
                  "2CANVAS", "2INPUT", "1CANVAS", "1INPUT", "0CANVAS", "0INPUT"]
        self.assertEqual([one for one in reached if one in wanted][:len(wanted)], wanted)
        page.run(f"{SLICES}[2].canvas.focus()")
        start = self.crosshair(page)
        type_keys(Keys.ARROW_RIGHT, Keys.ARROW_RIGHT, Keys.ARROW_DOWN, Keys.PAGE_UP)
        self.assertTrue(np.allclose(self.crosshair(page) - start, SPACING * [2, 1, 1]))
        # A distance between the crosshair's positions: 3 voxels to the right.
        type_keys("d", Keys.ENTER, *[Keys.ARROW_RIGHT] * 3, Keys.ENTER)
        texts = page.run("return [...document.querySelectorAll('#slices-panel .measure span')]"
                         ".map((one) => one.textContent)")
        self.assertEqual(texts, ["Distance 1: 4.5 mm"])
        scale = page.run(f"return {SLICES}[2].place().scale")
        type_keys("+")
        self.assertLess(page.run(f"return {SLICES}[2].place().scale"), scale)
        type_keys("0")
        self.assertEqual(page.run(f"return {SLICES}[2].place().scale"), scale)
        page.run(f"{SLICES}[1].slider.focus()")
        before = self.crosshair(page)
        type_keys(Keys.ARROW_RIGHT)
        self.assertTrue(np.allclose(self.crosshair(page) - before, [0, SPACING[1], 0]))
        page.run(f"{SLICES}[1].canvas.focus()")
        type_keys("f")
        self.assertTrue(page.run("return document.getElementById('slice-bar').hidden"))

    def test_a_phone(self):
        page = self.open_views("labels.json", window=(390, 844))
        self.assertLessEqual(page.run("return document.documentElement.scrollWidth"), 390)
        self.assertEqual(page.run("""
            return [...document.querySelectorAll('button, input, select')].filter((one) =>
              one.checkVisibility() && one.getBoundingClientRect().right > 390)
              .map((one) => one.outerHTML.slice(0, 80));"""), [])
        for view, selector in (("0", "[data-axis='0']"), ("1", "[data-axis='1']"),
                               ("volume", "#stage"), ("2", "[data-axis='2']")):
            page.press(f"[data-view='{view}']")
            page.run("scrollTo(0, 0)")
            _, top, width, height = page.box(selector)
            self.assertGreater(width, 380)
            self.assertGreater(height, 400)
            self.assertLess(top + height, 844)
            self.wait_slices(page)
        left, top, width, height = page.box("[data-axis='2'] canvas")

        def touch(kind, *points):
            page.browser.execute_cdp_cmd("Input.dispatchTouchEvent", {"type": kind, "touchPoints": [
                {"x": left + x * width, "y": top + y * height, "id": i}
                for i, (x, y) in enumerate(points)]})
        # One finger moves the crosshair.
        touch("touchStart", (0.4, 0.5))
        touch("touchMove", (0.6, 0.45))
        touch("touchEnd")
        self.wait_slices(page)
        x, y = self.pixel(page, 2, self.crosshair(page))
        self.assertAlmostEqual(x, left + 0.6 * width, delta=1.5)
        self.assertAlmostEqual(y, top + 0.45 * height, delta=1.5)
        # Two zoom.
        scale = page.run(f"return {SLICES}[2].place().scale")
        touch("touchStart", (0.45, 0.5), (0.55, 0.5))
        for i in range(1, 6):
            touch("touchMove", (0.45 - 0.04 * i, 0.5), (0.55 + 0.04 * i, 0.5))
        touch("touchEnd")
        self.assertLess(page.run(f"return {SLICES}[2].place().scale"), 0.5 * scale)
        self.assertEqual(page.complaints(), [])

    def test_names_contrast_and_sizes(self):
        page = self.open_views("labels.json", window=(1280, 900))
        page.press("[data-tool=distance]")
        for index in ((5, 5, 7), (13, 5, 7)):
            page.click(*self.pixel(page, 2, self.world_of(index)))
        for dark in ("light", "dark"):
            page.browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [
                {"name": "prefers-color-scheme", "value": dark}]})
            self.assertEqual(page.run(ACCESS), [], dark)
        # Texts and lines over slices have a dark border, on which they have enough contrast.
        self.assertEqual(page.run("""
            return [...document.querySelectorAll('.slice text')].filter((text) => {
              const {stroke, paintOrder} = getComputedStyle(text);
              return stroke !== 'rgb(0, 0, 0)' || !paintOrder.startsWith('stroke');
            }).length + [...document.querySelectorAll('.slice line.cross, .slice line.measure')]
              .filter((line) => !line.previousSibling.classList.contains('halo')).length;"""), 0)
        self.assertEqual(page.complaints(), [])

    @unittest.skipIf(IN_PAGE, "a page on disk is loaded anew with its data")
    def test_the_layout_is_kept(self):
        page = self.open_views(window=(1100, 800))
        page.press("[data-view='1']")
        page.browser.refresh()
        page.wait_for(lambda: page.run(f"return window.viewer && {SLICES}[1].slice"), "the slice")
        self.assertEqual(page.run("return document.getElementById('panes').dataset.shown"), "1")
        page.press("#four")
        page.wait_exact(-1)
        self.assertEqual(page.run("return document.getElementById('panes').dataset.shown"),
                         "volume")


if __name__ == "__main__":
    reason = why_not() or (None if np else "NumPy is not installed")
    if reason:
        print(f"skipped: {reason} (scripts/install-packages browser)")
        sys.exit(77)
    if IN_PAGE and not os.path.exists(os.environ["PELLUCID_PAGE"]):
        print("skipped: there is no page; scripts/build-web builds it")
        sys.exit(77)
    unittest.main(verbosity=2)
