#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes the page of the viewer one file, without data: its style, its script, the worker and the
renderer. The program puts scenes where MARK stands; without one the page asks for a file.

  make_page.py --page FOLDER --web FOLDER --glue FILE.js --module FILE.wasm --output FILE.html
               [--threads FOLDER]

With --threads it also holds the renderer with threads, of that folder of a build, and takes it
where the browser lets a page have them.

The modules of the page become one script, each a function that returns what it exports. Nothing of
the page is fetched: its policy forbids every request.
"""
import argparse
import base64
import gzip
import hashlib
import pathlib
import re

MARK = "<!-- embedded -->"
IMPORT = re.compile(r"^import \{([^}]*)\}\s*from '\./(\w+)\.js';\n", re.MULTILINE)
EXPORT = re.compile(r"^export (?=(?:async )?(?:function|class|const)\s+(\w+))", re.MULTILINE)


def read(path):
    return path.read_text(encoding="utf-8")


def add_behind_imports(modules, name, done):
    """Appends a module to the list `done`, behind those that it imports."""
    for _, needed in IMPORT.findall(modules[name]):
        if needed not in done:
            add_behind_imports(modules, needed, done)
    done.append(name)


def bundle(modules):
    done = []
    add_behind_imports(modules, "main", done)
    if any(re.search(r"^(import|export)\b", EXPORT.sub("", IMPORT.sub("", text)), re.MULTILINE)
           for text in modules.values()):
        raise SystemExit("make_page.py: a module of the page imports or exports in another way")
    parts = ["'use strict';"]
    for name in done:
        text = modules[name]
        imports = "".join(
            f"const {{{' '.join(names.replace(' as ', ': ').split())}}} = {needed}_module;\n"
            for names, needed in IMPORT.findall(text))
        body = EXPORT.sub("", IMPORT.sub("", text))
        parts.append(f"const {name}_module = (() => {{\n{imports}{body}"
                     f"return {{{', '.join(EXPORT.findall(text))}}};\n}})();")
    return "\n".join(parts)


def inline(text):
    """A script must not end its element, nor begin a comment of HTML."""
    return re.sub(r"</(script)", r"<\\/\1", text, flags=re.IGNORECASE).replace("<!--", "<\\!--")


def element(name, text):
    return f'<script type="text/plain" id="{name}">{text}</script>'


def digest(text):
    return "'sha256-" + base64.b64encode(hashlib.sha256(text.encode()).digest()).decode() + "'"


def packed(path):
    return base64.b64encode(gzip.compress(path.read_bytes(), 9, mtime=0)).decode()


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    for name in ("page", "web", "glue", "module", "output"):
        parser.add_argument(f"--{name}", type=pathlib.Path, required=True)
    parser.add_argument("--threads", type=pathlib.Path)
    arguments = parser.parse_args()
    modules = {path.stem: read(path) for path in sorted(arguments.page.glob("*.js"))}
    modules["end"] = read(arguments.web / "end.js")
    script = inline(bundle(modules))
    style = read(arguments.page / "style.css")
    icon = base64.b64encode((arguments.page / "icon.svg").read_bytes()).decode()
    policy = (f"default-src 'none'; script-src {digest(script)} 'wasm-unsafe-eval' blob:; "
              f"worker-src blob:; style-src {digest(style)}; img-src data: blob:; "
              "base-uri 'none'; form-action 'none'")
    html = read(arguments.page / "index.html")
    head = "\n".join([
        f'<meta http-equiv="Content-Security-Policy" content="{policy}">',
        f"<style>{style}</style>",
        f'<script type="module">{script}</script>'])
    threads = []
    if arguments.threads:
        worker = arguments.threads / "pellucid_worker"
        threads = [element("threads-glue", inline(read(worker.with_suffix(".js")))),
                   element("threads-worker", inline(read(worker.with_suffix(".worker.js")))),
                   element("threads-module", packed(worker.with_suffix(".wasm")))]
    data = "\n".join([
        element("worker", inline(read(arguments.web / "worker.js"))),
        element("glue", inline(read(arguments.glue))),
        element("module", packed(arguments.module)),
        *threads,
        MARK,
        element("embedded-end", "")])
    for old, new in (('<link rel="icon" href="icon.svg">',
                      f'<link rel="icon" href="data:image/svg+xml;base64,{icon}">'),
                     ('<link rel="stylesheet" href="style.css">', ""),
                     ('<script type="module" src="main.js"></script>', head),
                     ("</body>", data + "\n</body>")):
        if html.count(old) != 1:
            raise SystemExit(f"make_page.py: index.html has not one {old}")
        html = html.replace(old, new)
    arguments.output.write_text(html, encoding="utf-8")


if __name__ == "__main__":
    main()
