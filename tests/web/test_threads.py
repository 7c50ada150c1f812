# SPDX-License-Identifier: Apache-2.0
"""Pages with threads, served with the headers that let them share memory, and without."""

import functools
import http.server
import os
import sys
import threading
import unittest

from test_page import EMPTY, PageTest, why_not
from page_driver import DRAG  # noqa: E402  (test_page tells where it is)

ISOLATED = {"Cross-Origin-Opener-Policy": "same-origin",
            "Cross-Origin-Embedder-Policy": "require-corp"}
MOST_THREADS = 16  # apps/web/CMakeLists.txt


class Handler(http.server.SimpleHTTPRequestHandler):
    def __init__(self, *arguments, headers, **options):
        self.own_headers = headers
        super().__init__(*arguments, **options)

    def end_headers(self):
        for name, value in self.own_headers.items():
            self.send_header(name, value)
        super().end_headers()

    def log_message(self, *unused):
        pass


class Served:
    """A page of a server, in the place of a program's."""

    def __init__(self, path, headers):
        handler = functools.partial(Handler, headers=headers, directory=os.path.dirname(path))
        self.server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler)
        self.address = f"http://127.0.0.1:{self.server.server_port}/{os.path.basename(path)}"
        threading.Thread(target=self.server.serve_forever, daemon=True).start()

    def close(self):
        self.server.shutdown()
        self.server.server_close()


class Threads(PageTest):
    def open_served(self, path, headers, **options):
        served = Served(path, headers)
        self.addCleanup(served.close)
        return self.open_page(served, window=(640, 480), **options)

    def threads(self, page):
        return int(page.run("return document.body.dataset.threads ?? 0"))

    def check_one_thread(self, page, isolated):
        self.assertIs(page.run("return crossOriginIsolated"), isolated)
        self.assertEqual(self.threads(page), 1)
        self.assertIn("on 1 thread", page.run("return document.getElementById('state-text').title"))

    def exported(self, *arguments):
        return self.export(*arguments, "--page-threads")

    def changed(self, path, old, new):
        """A copy of the page with another text in it."""
        with open(path, encoding="utf-8") as file:
            text = file.read()
        self.assertEqual(text.count(old), 1)
        with open(self.path("changed.html"), "w", encoding="utf-8") as file:
            file.write(text.replace(old, new))
        return self.path("changed.html")

    def test_pictures_are_the_same_to_the_bit(self):
        for arguments in (["builtin:shells:40"], ["builtin:sphere:32", "--shading", "on"],
                          ["builtin:sphere:32", "--projection", "maximum"]):
            with self.subTest(arguments):
                path = self.exported(*arguments)
                pictures = []
                for headers in (ISOLATED, {}):
                    page = self.open_served(path, headers)
                    if headers:
                        self.assertIs(page.run("return crossOriginIsolated"), True)
                        cores = page.run("return navigator.hardwareConcurrency")
                        self.assertEqual(self.threads(page), min(cores, MOST_THREADS))
                        self.assertIn(f"on {self.threads(page)} thread", page.run(
                            "return document.getElementById('state-text').title"))
                    else:
                        self.check_one_thread(page, False)
                    pictures.append(page.picture())
                    # The errors too, as a picture.
                    page.wait_exact(page.press("#error-map"))
                    errors = page.run("return document.getElementById(arguments[0]).toDataURL()",
                                      "errors")
                    self.assertGreater(len(errors), 1000)
                    pictures.append(errors)
                    self.assertEqual(page.complaints(), [])
                    page.browser.quit()
                # Without assertEqual(), which takes long to tell the difference.
                self.assertTrue(pictures[:2] == pictures[2:])

    def test_a_page_that_works_answers(self):
        """The pictures that are told of by other threads come, and those of a drag."""
        page = self.open_served(self.exported("builtin:marschner_lobb:64"), ISOLATED)
        self.assertGreaterEqual(self.threads(page), min(2, os.cpu_count()))
        page.show("#picture")
        x, y = page.center("#picture")
        for to in ((90, 40), (-60, 20)):
            page.wait_exact(page.drag((x, y), (x + to[0], y + to[1])))
        frames, _, _ = page.browser.execute_async_script(DRAG, "#picture", 2.0)
        self.assertGreater(frames, 1)
        page.wait_exact(-1)
        self.check_frame(page, 2)
        self.assertEqual(page.complaints(), [])

    def test_the_plain_renderer_takes_over(self):
        """Where there is no memory to share, or a thread does not begin."""
        path = self.exported("builtin:sphere:16")
        for old, new in (("const mostBytes = [2 ** 31, 2 ** 30, 2 ** 29];",
                          "const mostBytes = [2 ** 40];"),
                         ('<script type="text/plain" id="threads-worker">',
                          '<script type="text/plain" id="threads-worker">while (true) {}')):
            with self.subTest(new):
                page = self.open_served(self.changed(path, old, new), ISOLATED)
                self.check_one_thread(page, True)
                self.check_frame(page, 2)
                page.browser.quit()

    def test_less_memory_is_taken_where_there_is_less(self):
        page = self.open_served(self.changed(
            self.exported("builtin:sphere:16"), "[2 ** 31, 2 ** 30, 2 ** 29]",
            "[2 ** 40, 2 ** 29]"), ISOLATED)
        self.assertGreaterEqual(self.threads(page), min(2, os.cpu_count()))
        self.check_frame(page, 2)


if __name__ == "__main__":
    reason = why_not() or (
        None if os.path.exists(os.path.join(os.path.dirname(EMPTY), "pellucid_page_threads.html"))
        else "there is no page with threads; scripts/build-web --threads builds it")
    if reason:
        print("skipped:", reason)
        sys.exit(77)
    unittest.main()
