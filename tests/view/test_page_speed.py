# SPDX-License-Identifier: Apache-2.0
"""How fast the viewer's page is in a real browser."""

import os
import sys
import time
import unittest

from page_driver import DRAG, why_not
from test_browser import BrowserTest

BRAIN = "/usr/share/mricron/templates/ch2.nii.gz"


class Speed(BrowserTest):
    """Prints how fast the page is. A busy machine makes it slower: only very slow is an error."""

    def test_the_brain(self):
        if not os.path.exists(BRAIN):
            self.skipTest(f"{BRAIN} is not there")
        page = self.open(BRAIN)
        for _ in range(3):  # a stage of 640 x 640 pixels
            _, _, width, height = page.box("#stage")
            view = page.run("return [innerWidth, innerHeight]")
            before = page.frame()
            if (round(width), round(height)) == (640, 640):
                break
            page.resize(round(view[0] + 640 - width), round(view[1] + 640 - height))
            page.wait_exact(before)
        self.assertEqual(page.picture()[:2], (640, 640))
        for what, selector in (("camera", "#picture"), ("function", '[data-point="3"]')):
            results = []
            for _ in range(3):
                results.append(page.browser.execute_async_script(DRAG, selector, 3))
                time.sleep(0.5)
            rate, _, stride = max(results)
            rest = min(result[1] for result in results)
            print(f"brain, 640 x 640, drag of the {what}: {rate:.1f} frames/s of every "
                  f"{stride:.1f}th pixel, exact {rest:.0f} ms after the mouse rests", flush=True)
            self.assertGreater(rate, 2)
            self.assertLess(rest, 10000)


if __name__ == "__main__":
    reason = why_not()
    if reason:
        print(f"skipped: {reason} (scripts/install-packages browser)")
        sys.exit(77)
    unittest.main(verbosity=2)
