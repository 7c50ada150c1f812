# SPDX-License-Identifier: Apache-2.0
"""How fast the viewer's page is in a real browser."""

import os
import sys
import time
import unittest

from page_driver import why_not
from test_browser import BrowserTest

BRAIN = "/usr/share/mricron/templates/ch2.nii.gz"


class Speed(BrowserTest):
    """Prints how fast the page is. A busy machine makes it slower: only very slow is an error."""

    # Moves the pointer with each picture of the screen, and notes when frames are shown.
    DRAG = """
const [selector, seconds, done] = arguments;
const target = document.querySelector(selector);
const box = target.getBoundingClientRect();
const x = box.left + box.width / 2, y = box.top + box.height / 2;
const event = (type, i) => target.dispatchEvent(new PointerEvent(type, {bubbles: true,
  pointerId: 1, button: type === 'pointermove' ? -1 : 0, buttons: type === 'pointerup' ? 0 : 1,
  clientX: x + 60 * Math.sin(i / 12), clientY: y + 20 * Math.cos(i / 17), cancelable: true}));
target.setPointerCapture = () => {};
document.querySelectorAll('.plot svg').forEach((svg) => { svg.setPointerCapture = () => {}; });
let i = 0, shown = 0, strides = 0, last = document.body.dataset.frame;
const start = performance.now();
// The points are drawn anew while they move; their plot stays.
const mover = target.closest('.plot svg') ?? target;
event('pointerdown', 0);
const step = () => {
  if (document.body.dataset.frame !== last) {
    ++shown;
    last = document.body.dataset.frame;
    strides += Number(document.body.dataset.stride);
  }
  const now = performance.now();
  if (now - start < seconds * 1000) {
    mover.dispatchEvent(new PointerEvent('pointermove', {bubbles: true, pointerId: 1, button: -1,
      buttons: 1, clientX: x + 60 * Math.sin(++i / 12), clientY: y + 20 * Math.cos(i / 17)}));
    requestAnimationFrame(step);
    return;
  }
  mover.dispatchEvent(new PointerEvent('pointerup', {bubbles: true, pointerId: 1, button: 0}));
  const rest = performance.now();
  const wait = () => {
    if (document.body.dataset.state === 'exact') {
      done([shown / seconds, performance.now() - rest, strides / Math.max(shown, 1)]);
    } else {
      setTimeout(wait, 2);
    }
  };
  // The state is still that of a frame before the last move where it is exact at once.
  setTimeout(wait, 60);
};
requestAnimationFrame(step);
"""

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
                results.append(page.browser.execute_async_script(self.DRAG, selector, 3))
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
