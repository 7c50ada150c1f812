#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Takes the screenshots of the viewer in docs/images/.

  tools/viewer_screenshots.py PROGRAM [FOLDER]

Needs Chromium and Selenium (scripts/install-packages browser) and the brain of mricron-data.
"""
import os
import pathlib
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
BRAIN = "/usr/share/mricron/templates/ch2.nii.gz"
WINDOW = (1180, 700)


def settle(page):
    time.sleep(1)
    page.wait_exact(-1)


def curve(page):
    """A brain that is cut open by a box, with the probe on it."""
    page.open_panel("clip-panel")
    page.wait_exact(page.press_button("Add a box"))
    left, top, width, height = page.box('[data-handle="z1"]')
    handle = (left + width / 2, top + height / 2)
    page.wait_exact(page.drag(handle, (handle[0], handle[1] + 75)))
    page.run("document.getElementById('clip-panel').open = false;"
             "document.querySelector('aside').scrollTop = 0")
    settle(page)
    x, y = page.center("#picture")
    page.mouse("mouseMoved", x + 20, y + 20, button="none", count=0)
    page.wait_for(lambda: page.text("#probe"), "the probe")


def gaussians(page):
    """Boundaries by value and gradient magnitude."""
    page.wait_exact(page.press_button("Gaussians of value and gradient"))
    page.wait_for(lambda: page.run("return Boolean(document.querySelector('[data-gaussian]'))"),
                  "the Gaussians")
    page.run("document.querySelector('aside').scrollTop = 0")
    settle(page)


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    os.environ["PELLUCID_PROGRAM"] = str(pathlib.Path(sys.argv[1]).resolve())
    folder = pathlib.Path(sys.argv[2]) if len(sys.argv) == 3 else ROOT / "docs" / "images"
    sys.path.insert(0, str(ROOT / "tests" / "view"))
    from page_driver import Page, why_not
    from viewer_process import Viewer
    if why_not():
        sys.exit(why_not())
    pictures = (("viewer_light.png", curve, False, WINDOW),
                ("viewer_dark.png", gaussians, True, WINDOW))
    for name, act, dark, window in pictures:
        with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as temporary, \
                Viewer(BRAIN) as viewer, Page(viewer, temporary, window, dark) as page:
            act(page)
            time.sleep(0.5)
            page.browser.save_screenshot(str(folder / name))


if __name__ == "__main__":
    main()
