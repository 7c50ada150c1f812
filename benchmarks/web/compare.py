#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Exact frames by the worker of pages, in Node, beside the program on one thread; a table.

  compare.py [NAME=ARGUMENTS]...      ARGUMENTS: as of `pellucid export`, without -o

Both render the same embedded scene at 400 × 400 to its own tolerance. PELLUCID_PROGRAM is the
program; the page is that of build/web. The camera turns four times between five frames, of which
the median is shown; the program makes the first one five times.
"""
import base64
import json
import os
import pathlib
import re
import shlex
import statistics
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
PROGRAM = os.environ.get("PELLUCID_PROGRAM", str(ROOT / "build/release/bin/pellucid"))
BRAIN = "/usr/share/mricron/templates/ch2.nii.gz"
SIZE, FRAMES = 400, 5
SCENES = {
    "shells 64": "builtin:shells:64",
    "marschner_lobb 128": "builtin:marschner_lobb:128",
    "sphere 128, lit": "builtin:sphere:128 --shading on",
    "brain, mr-t1-brain": f"{BRAIN} --preset mr-t1-brain",
    "brain, its look": BRAIN,
    "hydrogen, Gaussians": "builtin:hydrogen:64 --gaussian 'value=0.3~0.1, gradient_magnitude=1~1; "
                           "extinction 2; color #e0a060'",
}


def unpack(page, folder):
    """The files that a page holds."""
    text = page.read_text(encoding="utf-8")
    for name, data in re.findall(r'data-embedded="([^"]+)" data-size="\d+">([^<]*)<', text):
        (folder / name).write_bytes(base64.b64decode(data))
    return sum(path.stat().st_size for path in folder.iterdir())


def measure(arguments, folder):
    environment = dict(os.environ, PELLUCID_MODULES=str(ROOT / "build/web"))
    page = folder.parent / "page.html"
    subprocess.run([PROGRAM, "export", *arguments, "-o", page, "-q"], check=True, env=environment)
    size = unpack(page, folder)
    worker = subprocess.run(
        ["node", "--no-experimental-fetch", ROOT / "benchmarks/web/frame_in_node.js",
         ROOT / "build/web/apps/web", ROOT / "apps/web/page", folder, str(SIZE), str(FRAMES - 1)],
        check=True, capture_output=True, text=True)
    web = json.loads(worker.stdout)
    seconds = []
    for _ in range(FRAMES):
        native = subprocess.run(
            [PROGRAM, "render", folder / "scene.json", "-o", folder.parent / "out.png", "--json",
             "--threads", "1", "--size", f"{SIZE}x{SIZE}"], check=True, capture_output=True,
            text=True, cwd=folder)
        report = json.loads(native.stdout)
        seconds.append(report["seconds"])
    return page.stat().st_size, size, web, statistics.median(seconds)


def main():
    scenes = dict(one.split("=", 1) for one in sys.argv[1:]) or SCENES
    print("| scene | page, MB | first picture, s | exact, s | by the program, s | ratio |")
    print("|---|---|---|---|---|---|")
    for name, arguments in scenes.items():
        with tempfile.TemporaryDirectory() as folder:
            inside = pathlib.Path(folder) / "scene"
            inside.mkdir()
            page, _, web, native = measure(shlex.split(arguments), inside)
        exact = statistics.median(web["exact"])
        print(f"| {name} | {page / 1e6:.2f} | {web['first']:.2f} | {exact:.2f} | {native:.2f} | "
              f"{exact / native:.1f} |", flush=True)


if __name__ == "__main__":
    main()
