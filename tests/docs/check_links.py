#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Every link inside the repository, and every #anchor, of every page of Markdown leads somewhere,
and links lead from README.md to every page of docs/.

  check_links.py ROOT
"""
import pathlib
import posixpath
import re
import sys
import urllib.parse

from documents import Page, repository_files, run_check


def check(root):
    files = repository_files(root)
    names = {str(name) for name in files}
    folders = {str(parent) for name in files for parent in name.parents}
    pages = {str(name): Page((root / name).read_text(encoding="utf-8"))
             for name in files if name.suffix == ".md"}
    anchors = {name: page.anchors() for name, page in pages.items()}
    linked = {name: set() for name in pages}
    if not pages:
        yield "no page of Markdown was found"
    for name, page in pages.items():
        if page.open_fence:
            yield f"{name}:{page.open_fence}: this block of code is not closed"
        for line, link in page.links():
            if link is None:
                yield f"{name}:{line}: a link by a name that this page does not define"
                continue
            if re.match(r"[A-Za-z][A-Za-z0-9+.-]*:|//", link):
                continue
            path, _, anchor = urllib.parse.unquote(link).partition("#")
            folder = "" if path.startswith("/") else posixpath.dirname(name)
            target = posixpath.normpath(posixpath.join(folder, path.lstrip("/"))) if path else name
            linked[name].add(target)
            if target not in names and target not in folders:
                yield f"{name}:{line}: links to {link}, which does not exist"
            elif anchor and target in anchors and anchor not in anchors[target]:
                yield f"{name}:{line}: links to {link}, but {target} has no such heading"
            elif anchor and target not in anchors:
                yield f"{name}:{line}: links to {link}, an anchor in what is no page of Markdown"
    reached, following = set(), ["README.md"]
    while following:
        name = following.pop()
        if name in linked and name not in reached:
            reached.add(name)
            following += linked[name]
    for name in pages:
        if name.startswith("docs/") and name not in reached:
            yield f"{name}: no links lead here from README.md"


if __name__ == "__main__":
    sys.exit(run_check(check(pathlib.Path(sys.argv[1]).resolve()), "every link leads somewhere"))
