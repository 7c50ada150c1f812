#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Pages of exported scenes in Chromium, opened from disk: when they show what, and how fast they
turn; a table.

  in_chromium.py [NAME=ARGUMENTS]...      ARGUMENTS: as of `pellucid export`, without -o

The picture has 400 x 400 pixels. Times count from the begin of the page's load. PELLUCID_PROGRAM is
the program; the page is that of build/web. Each scene is opened three times; the medians are shown.
"""
import os
import pathlib
import shlex
import statistics
import subprocess
import sys
import tempfile

from compare import BRAIN, PROGRAM, ROOT

sys.path.insert(0, str(ROOT / "tests/view"))
os.environ.setdefault("PELLUCID_PROGRAM", PROGRAM)
from page_driver import DRAG, Page  # noqa: E402

SIZE, TIMES = 400, 3
SCENES = {
    "marschner_lobb 128": "builtin:marschner_lobb:128",
    "sphere 128, lit": "builtin:sphere:128 --shading on",
    "brain, its look": BRAIN,
}
# Notes when the first frame is shown, and when the first exact one is.
WATCH = """
new MutationObserver(() => {
  const {frame, state} = document.body?.dataset ?? {};
  const isExact = state === 'exact' || state === 'over';
  if (frame !== undefined) window.firstShown ??= performance.now();
  if (frame !== undefined && isExact) window.exactShown ??= performance.now();
}).observe(document,
  {subtree: true, childList: true, attributeFilter: ['data-frame', 'data-state']});
"""


class File:
    """A page on disk, in the place of a program's."""

    def __init__(self, path):
        self.address = path.as_uri()


def measure(path, folder):
    """First picture and exact one in s, frames a second, their distance of pixels, s at rest."""
    with Page(File(pathlib.Path("/dev/null")), folder, window=(800, 700), waits=False) as page:
        page.browser.execute_cdp_cmd("Page.addScriptToEvaluateOnNewDocument", {"source": WATCH})
        page.browser.get(path.as_uri())
        page.wait_exact(-1)
        first, exact = page.run("return [firstShown, exactShown]")
        for _ in range(3):
            _, _, width, height = page.box("#stage")
            if (round(width), round(height)) == (SIZE, SIZE):
                break
            seen = page.run("return [innerWidth, innerHeight]")
            before = page.frame()
            page.resize(round(seen[0] + SIZE - width), round(seen[1] + SIZE - height))
            page.wait_exact(before)
        rate, rest, stride = page.browser.execute_async_script(DRAG, "#picture", 3)
    return first / 1000, exact / 1000, rate, stride, rest / 1000


def main():
    scenes = dict(one.split("=", 1) for one in sys.argv[1:]) or SCENES
    environment = dict(os.environ, PELLUCID_MODULES=str(ROOT / "build/web"))
    print("| scene | page, MB | first picture, s | exact, s | frames/s in a drag | "
          "of every nth pixel | exact at rest, s |\n|---|---|---|---|---|---|---|")
    for name, arguments in scenes.items():
        with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
            path = pathlib.Path(folder) / "page.html"
            subprocess.run([PROGRAM, "export", *shlex.split(arguments), "-o", path, "-q"],
                           check=True, env=environment)
            rows = [measure(path, folder) for _ in range(TIMES)]
            size = path.stat().st_size
        first, exact, rate, stride, rest = map(statistics.median, zip(*rows))
        print(f"| {name} | {size / 1e6:.2f} | {first:.2f} | {exact:.2f} | {rate:.1f} | "
              f"{stride:.1f} | {rest:.2f} |", flush=True)


if __name__ == "__main__":
    main()
