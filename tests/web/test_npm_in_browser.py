# SPDX-License-Identifier: Apache-2.0
"""The package for authors of other pages, as a page of a static host imports it, in a browser."""

import functools
import http.server
import os
import sys
import tempfile
import threading
import unittest

SOURCE_DIR = os.environ.get("PELLUCID_SOURCE_DIR", os.path.join(os.path.dirname(__file__), "../.."))
sys.path.insert(0, os.path.join(SOURCE_DIR, "tests", "view"))
from page_driver import make_browser, why_not  # noqa: E402

PACKAGE = os.environ.get("PELLUCID_NPM", os.path.join(SOURCE_DIR, "build/web/npm"))
SIDE, SIZE, TOLERANCE = 24, 64, 1e-3
# Values of a ball around the middle, z slowest, as the page and numpy make them.
PAGE = """<!doctype html><meta charset="utf-8"><title>A page</title>
<script type="module">
import {load} from './pellucid/index.js';
const side = %d;
const data = Float32Array.from({length: side ** 3}, (_, i) => {
  const [x, y, z] = [i %% side, Math.floor(i / side) %% side, Math.floor(i / side ** 2)];
  return Math.fround((x - 11) ** 2 + (y - 11) ** 2 + (z - 12) ** 2);
});
const scene = {layers: [{field: {file: 'ball'}, transfer_function: {points: [
  {value: 0, extinction: 0.4, color: [1, 0.5, 0.1]}, {value: 100, extinction: 0,
    color: [1, 0.9, 0.7]}]}}],
  camera: {position: [40, -60, 50], focal_point: [11, 11, 11], up: [0, 0, 1],
    vertical_angle: 30}};
try {
  const pellucid = await load();
  const {rgba, error, pixelsOver} = pellucid.render(scene,
    {ball: {data, shape: [side, side, side]}}, {width: %d, height: %d, tolerance: %g});
  window.result = {rgba: [...rgba], error: [...error], pixelsOver, scene};
} catch (problem) {
  window.result = {problem: String(problem)};
}
</script>""" % (SIDE, SIZE, SIZE, TOLERANCE)


class Handler(http.server.SimpleHTTPRequestHandler):
    extensions_map = {".html": "text/html", ".js": "text/javascript", ".mjs": "text/javascript",
                      ".wasm": "application/wasm", "": "application/octet-stream"}

    def log_message(self, *unused):
        pass


class InBrowser(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="pellucid_npm_", ignore_cleanup_errors=True)
        self.addCleanup(folder.cleanup)
        site = os.path.join(folder.name, "site")
        os.mkdir(site)
        os.symlink(PACKAGE, os.path.join(site, "pellucid"))
        with open(os.path.join(site, "index.html"), "w", encoding="utf-8") as file:
            file.write(PAGE)
        server = http.server.ThreadingHTTPServer(
            ("127.0.0.1", 0), functools.partial(Handler, directory=site))
        threading.Thread(target=server.serve_forever, daemon=True).start()
        self.addCleanup(server.server_close)
        self.addCleanup(server.shutdown)
        self.browser = make_browser(folder.name)
        self.addCleanup(self.browser.quit)
        self.browser.set_script_timeout(120)
        self.browser.get(f"http://127.0.0.1:{server.server_address[1]}/index.html")

    def test_a_picture_is_within_both_tolerances_of_the_programs(self):
        import numpy
        import pellucid

        result = self.browser.execute_async_script("""
const [done] = arguments;
const wait = () => (window.result ? done(window.result) : setTimeout(wait, 20));
wait();""")
        self.assertNotIn("problem", result)
        self.assertEqual(result["pixelsOver"], 0)
        error = numpy.array(result["error"]).reshape(SIZE, SIZE)
        self.assertLessEqual(error.max(), TOLERANCE)
        rgba = numpy.array(result["rgba"]).reshape(SIZE, SIZE, 4)
        z, y, x = numpy.mgrid[:SIDE, :SIDE, :SIDE]
        ball = ((x - 11) ** 2 + (y - 11) ** 2 + (z - 12) ** 2).astype(numpy.float32)
        function = pellucid.TransferFunction(
            [(0, 0.4, (1, 0.5, 0.1)), (100, 0, (1, 0.9, 0.7))])
        camera = pellucid.Camera(**result["scene"]["camera"])
        ours = pellucid.render(ball, function, camera=camera, size=SIZE, tolerance=TOLERANCE / 10)
        off = numpy.abs(numpy.asarray(ours.rgba) - rgba).max(axis=2)
        self.assertGreater(rgba.max(), 0.3)
        self.assertTrue((off <= error + TOLERANCE / 10 + 1e-6).all(), off.max())


if __name__ == "__main__":
    reason = why_not()
    if not os.path.exists(os.path.join(PACKAGE, "index.js")):
        reason = "there is no package; scripts/build-web builds it"
    if reason:
        print(f"skipped: {reason}")
        sys.exit(77)
    unittest.main(verbosity=2)
